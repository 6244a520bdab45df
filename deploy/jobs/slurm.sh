#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# One shard of long work for each task of a Slurm array, on folders that all machines share; without
# an array it puts the shards together (docs/jobs.md):
#   id=$(OUT=/shared/room sbatch --parsable --array=1-8 deploy/jobs/slurm.sh bake content/ID --passes 64)
#   OUT=/shared/room sbatch --dependency=afterok:$id deploy/jobs/slurm.sh bake content/ID --passes 64
# Others: import picture FILE..., clip FIGURE STORY, lamps --picture FILE, with their options.
#SBATCH --job-name=wellspring
#SBATCH --requeue
set -eu
BIN="${BIN:-build/release/bin}"
OUT="${OUT:?is the folder for shards and results}"
command="$1"
shift
mkdir -p "$OUT"
i="${SLURM_ARRAY_TASK_ID:-}"
if [ -n "$i" ]; then
  shard="--shard $i/${SLURM_ARRAY_TASK_COUNT:?}"
  # shellcheck disable=SC2086
  case "$command" in
    bake) set -- "$@" $shard --resume --out "$OUT/$i.bake" ;;
    import) set -- "$@" $shard --overwrite --out "$OUT" ;;
    clip) set -- "$@" $shard --out "$OUT" ;;
    lamps) set -- "$@" $shard --out "$OUT/$i.places" ;;
  esac
else
  case "$command" in
    bake) set -- "$@" --merge "$OUT"/*.bake ;;
    import) set -- "$@" --out "$OUT" --merge ;;
    clip) set -- "$@" --out "$OUT" --merge "$OUT" ;;
    lamps) set -- "$@" --merge "$OUT"/*.places ;;
  esac
fi
case "$command" in
  bake | import | clip | lamps) exec "$BIN/wellspring_$command" "$@" ;;
  *)
    echo "slurm.sh: bake, import, clip or lamps is expected, not '$command'" >&2
    exit 2 ;;
esac
