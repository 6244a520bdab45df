#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the book's pictures and its film in FOLDER: make_pictures.sh FOLDER. Needs Python 3 with numpy and PIL, and for the film
# ffmpeg with libvpx (Debian: apt install python3-numpy python3-pil fonts-dejavu-core ffmpeg).
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
film="$(mktemp -d)"
trap 'rm -rf "$film"' EXIT

python3 "$here/make_drawings.py" "$1"
python3 "$here/make_drawings.py" --film "$film"
ffmpeg -y -loglevel error -framerate 12 -i "$film/%04d.png" -c:v libvpx-vp9 -crf 30 -b:v 0 \
  -pix_fmt yuv420p -fflags +bitexact -flags:v +bitexact -deadline good -cpu-used 4 "$1/well.webm"
