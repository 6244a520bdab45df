#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# secrets.sh FOLDER: makes what a museum's machines keep from others, once for all of them:
#   secrets.env  NATS's token, the key of the workers' messages, and the technicians' token
#   seal.key     seals visits, so that every server takes them over
# What is there already stays. Whoever runs the services must be able to read both, nobody else.
set -eu
folder="${1:?usage: secrets.sh FOLDER}"
umask 077
mkdir -p "$folder"
secret() { head -c 24 /dev/urandom | od -An -v -tx1 | tr -d ' \n'; }
[ -s "$folder/secrets.env" ] || {
  # NATS takes what begins with a digit for a number.
  printf 'WELLSPRING_NATS_TOKEN=n%s\n' "$(secret)"
  printf 'WELLSPRING_WORKERS_KEY=w%s\n' "$(secret)"
  printf 'WELLSPRING_ADMIN_TOKEN=a%s\n' "$(secret)"
} >"$folder/secrets.env"
[ -s "$folder/seal.key" ] || head -c 32 /dev/urandom >"$folder/seal.key"
