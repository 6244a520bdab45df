#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A kiosk: server, camera program and screen (docs/kiosk.md, "Installing a kiosk").
# kiosk.sh: keeps all three running until it is told to end.
# kiosk.sh server|eye|screen: becomes one of them; wellspring-screen.service is kiosk.sh screen.
set -euo pipefail
self="$(realpath "${BASH_SOURCE[0]}")"
here="$(dirname "$(dirname "$self")")"

# What a house sets, in the environment or in this file of shell variables.
config="${WELLSPRING_CONFIG:-${XDG_CONFIG_HOME:-$HOME/.config}/wellspring/kiosk.env}"
# shellcheck disable=SC1090
[ ! -f "$config" ] || . "$config"
port="${WELLSPRING_PORT:-8080}"
host="${WELLSPRING_HOST:-127.0.0.1}"
page="${WELLSPRING_PAGE:-http://$host:$port/kiosk}"
token_file="${WELLSPRING_TOKEN_FILE:-}"
state="${XDG_STATE_HOME:-$HOME/.local/state}/wellspring"
programs="${WELLSPRING_BIN:-$here/build/release/bin}"

serves() {
  [[ $host == 127.* || $host == localhost ]]
}

become_server() {
  # As ./wellspring run.
  export GLIBC_TUNABLES="${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1}"
  export WELLSPRING_WEIGHTS="${WELLSPRING_WEIGHTS:-$here/build/weights}"
  # shellcheck disable=SC2086
  exec "$programs/wellspring_server" --content "$here/content" --web "$here/web" --port "$port" \
    --cache "${WELLSPRING_CACHE:-$here/build/cache}" --bench "$here/build/bench/last.json" \
    --sums "${WELLSPRING_SUMS:-$here/build/sums/sums.sqlite}" ${WELLSPRING_SERVER_OPTIONS:-}
}

become_eye() {
  export WELLSPRING_WEIGHTS="${WELLSPRING_WEIGHTS:-$here/build/weights}"
  # shellcheck disable=SC2086
  exec "$programs/wellspring_kiosk" --server "${WELLSPRING_EYE_SERVER:-ws://$host:$port/api/v1/eye}" \
    ${token_file:+--token-file "$token_file"} ${WELLSPRING_EYE_OPTIONS:---camera 0}
}

# As an address has it: letters, digits and a few more, the rest by their numbers.
encode() {
  local LC_ALL=C text="$1" i letter
  for ((i = 0; i < ${#text}; i++)); do
    letter="${text:i:1}"
    if [[ $letter == [A-Za-z0-9._~-] ]]; then printf %s "$letter"; else printf '%%%02X' "'$letter"; fi
  done
}

# Every user of a machine can read command lines: the browser gets the token by a page of a file
# that is its user's alone.
write_page() {
  local token
  token="$(awk '!/^[[:space:]]*(#|$)/ { print $NF; exit }' "$token_file")"
  [ -n "$token" ] || { echo "kiosk: $token_file holds no token" >&2; exit 1; }
  mkdir -p "$state"
  rm -f "$state/screen.html"
  (umask 077; printf '<!doctype html>\n<script>location.replace("%s#token=%s")</script>\n' \
    "$page" "$(encode "$token")" >"$state/screen.html")
  page="file://$state/screen.html"
}

# A browser that finds no server shows its own page, and stays there.
become_screen() {
  until (exec 3<>"/dev/tcp/$host/$port") 2>/dev/null; do sleep 0.5; done
  [ -z "$token_file" ] || write_page
  [ -z "${WELLSPRING_SCREEN:-}" ] || exec "$WELLSPRING_SCREEN" "$page"
  exec chromium --kiosk --autoplay-policy=no-user-gesture-required --noerrdialogs --no-first-run \
    --disable-session-crashed-bubble --disable-infobars --disable-pinch \
    --overscroll-history-navigation=0 --check-for-update-interval=31536000 \
    --user-data-dir="$state/screen" "$page"
}

# Ends what this shell has started, by force where ten seconds are not enough.
end_all() {
  trap '' TERM INT HUP
  local pids try
  pids="$(jobs -p)"
  # shellcheck disable=SC2086
  [ -z "$pids" ] || kill $pids 2>/dev/null || true
  for ((try = 0; try < 10 * $1; try++)); do
    [ -n "$(jobs -pr)" ] || exit 0
    sleep 0.1
  done
  # shellcheck disable=SC2086
  kill -KILL $pids 2>/dev/null || true
  exit 0
}

# Runs a part again whenever it ends; the pause before doubles, up to a minute, until one has run
# for as long.
keep() {
  local part="$1" pause=1 longest=60 began status
  trap 'end_all 10' TERM
  while :; do
    began=$SECONDS
    "$self" "$part" 9>&- &
    echo "kiosk: $part is process $!"
    status=0
    wait $! || status=$?
    [ $((SECONDS - began)) -lt $longest ] || pause=1
    echo "kiosk: $part ended with $status; again in $pause s"
    sleep $pause 9>&- &
    wait $! || true
    pause=$((2 * pause < longest ? 2 * pause : longest))
  done
}

case "${1:-}" in
  server) become_server ;;
  eye) become_eye ;;
  screen) become_screen ;;
  "") ;;
  *) echo "usage: kiosk.sh [server | eye | screen]" >&2; exit 2 ;;
esac

exec 9>"${XDG_RUNTIME_DIR:-/tmp}/wellspring-kiosk.lock"
flock -n 9 || { echo "kiosk: is running already" >&2; exit 1; }
trap 'end_all 15' TERM INT HUP
for part in $(! serves || echo server) eye screen; do keep "$part" & done
wait
