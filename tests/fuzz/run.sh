#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BUILD SECONDS NAME...: runs each target for that long, and prints a table. The corpus grows
# in BUILD/corpus/NAME from one run to the next; what breaks a target is kept in BUILD/found.
# Exit status 1: something was found.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
data="$here/../../../shared/data"
build="$1"
seconds="$2"
shift 2

# Real files of at most 64 KiB, where there are any: the first hundred of each ending.
link_real_files() {  # FOLDER ENDING...
  local folder="$1" ending file
  shift
  mkdir -p "$folder"
  [ -d "$data" ] || return 0
  for ending in "$@"; do
    find "$(realpath "$data")" -name "*.$ending" -size -64k | sort | head -n 100 | while read -r file; do
      ln -sf "$file" "$folder/$(echo "$file" | md5sum | cut -c1-16)"
    done
  done
}
endings_of() {
  case "$1" in
    bvh) echo bvh ;;
    x3d_xml) echo x3d ;;
    x3d_classic) echo x3dv wrl ;;
    x3d_json) echo x3dj json ;;
    gltf_*) echo gltf glb vrm ;;
    picture) echo png jpg hdr pfm exr ;;
    recording) echo wav flac ogg mp3 ;;
  esac
}
words_of() {
  case "$1" in
    browser_message | observation | eye_order) echo message ;;
    gltf_*) echo gltf ;;
    x3d_*) echo x3d ;;
    story) echo story ;;
    exhibit | house_file | kiosk_config) echo exhibit ;;
  esac
}

export LSAN_OPTIONS="suppressions=$here/lsan.supp:print_suppressions=0"
status=0
printf '%-18s %12s %9s %8s %7s  %s\n' target runs runs/s edges corpus found
for name in "$@"; do
  corpus="$build/corpus/$name" found="$build/found/$name" log="$build/$name.log"
  mkdir -p "$corpus" "$found"
  # shellcheck disable=SC2046
  link_real_files "$build/seeds/$name" $(endings_of "$name")
  words="$here/words/$(words_of "$name").dict"
  broken=""
  "$build/bin/fuzz_$name" "$corpus" "$here/corpus/$name" "$build/seeds/$name" -max_total_time="$seconds" \
    -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 -print_final_stats=1 -use_value_profile=1 \
    -max_len=65536 -artifact_prefix="$found/" $([ -f "$words" ] && echo "-dict=$words") >"$log" 2>&1 ||
    { broken=" $(grep -m 1 -oE 'SUMMARY: .*' "$log" || tail -n 1 "$log")"; status=1; }
  last="$(grep -E ' cov: [0-9]+' "$log" | tail -n 1 || true)"
  number() { sed -nE "s/.*$1:? *([0-9]+).*/\1/p" <<<"$2" | tail -n 1; }
  printf '%-18s %12s %9s %8s %7s %s\n' "$name" \
    "$(number stat::number_of_executed_units "$(grep executed_units "$log" || true)")" \
    "$(number stat::average_exec_per_sec "$(grep exec_per_sec "$log" || true)")" \
    "$(number 'cov' "$last")" "$(number 'corp' "$last")" "$broken"
done
exit $status
