#!/usr/bin/env bash
# One task of the array: runs its shard, or goes on with it.
set -uo pipefail
folder=$PENUMBRA_OUT/shard-$SLURM_ARRAY_TASK_ID
resume=()
[ -s "$folder/points.jsonl" ] && resume=(--resume)
# In the background, so that the scheduler's SIGTERM reaches the program, which keeps what is finished.
"$PENUMBRA_PROGRAM" run "$PENUMBRA_CONFIG" --out "$folder" --shard "$SLURM_ARRAY_TASK_ID/$PENUMBRA_SHARDS" --quiet --no-report \
  "${resume[@]}" &
program=$!
trap 'kill -TERM $program' TERM
wait $program
code=$?
# The signal ends the first wait before the program has ended.
while kill -0 $program 2>/dev/null; do
  wait $program
  code=$?
done
# Points that failed are results too; the merge tells of them. Everything else keeps the merge from starting.
[ $code -eq 1 ] && code=0
exit $code
