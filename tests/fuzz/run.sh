#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BUILD SECONDS NAME...: runs each target for that long, as many at a time as there are
# cores, and prints a table. The corpus grows in BUILD/corpus/NAME from one run to the next; what
# breaks a target is kept in BUILD/found. Exit status 1: something was found.
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
    browser_message | observation | eye_order | visit | kept_visit | kiosk_recording) echo message ;;
    gltf_*) echo gltf ;;
    x3d_*) echo x3d ;;
    story) echo story ;;
    exhibit | house_file | kiosk_config) echo exhibit ;;
  esac
}

export LSAN_OPTIONS="suppressions=$here/lsan.supp:print_suppressions=0"
number() { sed -nE "s/.*$1:? *([0-9]+).*/\1/p" "$2" | tail -n 1; }  # WORD LOG
run() {  # NAME: prints its row; 1: something was found
  local name="$1" words status=0 dictionary=()
  local corpus="$build/corpus/$name" found="$build/found/$name" log="$build/$name.log" broken=""
  words="$here/words/$(words_of "$name").dict"
  [ ! -f "$words" ] || dictionary=("-dict=$words")
  mkdir -p "$corpus" "$found"
  # shellcheck disable=SC2046
  link_real_files "$build/seeds/$name" $(endings_of "$name")
  "$build/bin/fuzz_$name" "$corpus" "$here/corpus/$name" "$build/seeds/$name" -max_total_time="$seconds" \
    -timeout=60 -rss_limit_mb=2048 -malloc_limit_mb=1024 -print_final_stats=1 -use_value_profile=1 \
    -max_len=65536 -artifact_prefix="$found/" "${dictionary[@]}" >"$log" 2>&1 ||
    { broken="$(grep -m 1 -oE 'SUMMARY: .*' "$log" || tail -n 1 "$log")"; status=1; }
  printf '%-18s %12s %9s %8s %7s  %s\n' "$name" "$(number stat::number_of_executed_units "$log")" \
    "$(number stat::average_exec_per_sec "$log")" "$(number ' cov' "$log")" "$(number ' corp' "$log")" "$broken"
  return $status
}

at_once="$(nproc)" left=$# running=0 broken=0 whole=0
ended() {
  if wait -n; then whole=$((whole + 1)); else broken=$((broken + 1)); fi
  running=$((running - 1))
}
minutes=$(((left * seconds / at_once + 59) / 60))
echo "wellspring: $left targets, $seconds s each, $at_once at a time: about $minutes minutes" >&2
printf '%-18s %12s %9s %8s %7s  %s\n' target runs runs/s edges corpus found
for name in "$@"; do
  [ "$running" -lt "$at_once" ] || ended
  run "$name" &
  running=$((running + 1))
done
while [ "$running" -gt 0 ]; do ended; done
echo "wellspring: $whole targets found nothing, $broken found something$([ "$broken" = 0 ] || echo ": $build/found")" >&2
[ "$broken" = 0 ]
