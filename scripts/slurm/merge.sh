#!/usr/bin/env bash
# After all shards: joins them. An earlier join of the same sweep is replaced.
set -euo pipefail
rm -rf "$PENUMBRA_OUT/merged"
shards=()
for ((i = 1; i <= PENUMBRA_SHARDS; ++i)); do shards+=("$PENUMBRA_OUT/shard-$i"); done
exec "$PENUMBRA_PROGRAM" merge "${shards[@]}" --out "$PENUMBRA_OUT/merged"
