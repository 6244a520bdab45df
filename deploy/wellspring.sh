#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The installed programs by the words of their documents: wellspring check FOLDER, ...
set -eu
root="$(dirname "$(dirname "$(realpath "$0")")")"
programs="$root/libexec/wellspring"
export WELLSPRING_WEIGHTS="${WELLSPRING_WEIGHTS:-$root/share/wellspring/weights}"
export GLIBC_TUNABLES="${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1}"

command="${1:-}"
[ $# -eq 0 ] || shift
case "$command" in
  run) command=server ;;
  kiosk | station | render | avatar | speak | clip | bake | new | import | nebula | compare | lamps | check | worker | jobs | plan) ;;
  *)
    echo "usage: wellspring run | kiosk | station | render | avatar | speak | clip | new | import | nebula | compare | lamps | check | bake | worker | jobs | plan [options]
COMMAND --help tells the options. The service is wellspring-server; its settings are in
/etc/wellspring/server.conf." >&2
    exit 2 ;;
esac
[ -x "$programs/wellspring_$command" ] || {
  [ "$command" != station ] || command=kiosk
  echo "wellspring: '$command' is in a package that is not installed: wellspring-$command" >&2
  exit 1
}
exec "$programs/wellspring_$command" "$@"
