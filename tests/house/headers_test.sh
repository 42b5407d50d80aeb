#!/usr/bin/env bash
# Every header of harness/ and techniques/ compiles on its own. Where a source of the same name includes its header first, the
# build has shown that already.
set -euo pipefail
compiler=$1 root=$2 build=$3
includes=(-I"$root/harness" -I"$root")
for generated in "$build"/harness/*/generated "$build"/techniques/*/generated; do
  [ -d "$generated" ] && includes+=(-I"$generated")
done
version=3
[ -e /usr/include/embree4/rtcore.h ] && version=4
mapfile -t headers < <(cd "$root" && git ls-files 'harness/*.h' 'techniques/*.h')
[ ${#headers[@]} -gt 20 ] || { echo "only ${#headers[@]} headers found: measuring nothing"; exit 1; }
check() {
  printf '#include "%s"\n' "$1" | "$compiler" -std=c++20 -fsyntax-only -Wall -Wextra -Wno-missing-field-initializers \
    -DPENUMBRA_EMBREE_VERSION=$version "${includes[@]}" -x c++ - || { echo "not self-contained: $1"; return 1; }
}
shown_by_build() {
  local source="$root/${1%.h}.cpp" first
  [ -f "$source" ] || return 1
  first=$(grep -m 1 '^#include' "$source")
  [ "$first" = "#include \"$1\"" ] || [ "$first" = "#include \"${1#harness/}\"" ]
}
failed=0 running=0
for header in "${headers[@]}"; do
  shown_by_build "$header" && continue
  check "$header" &
  running=$((running + 1))
  if [ $running -ge "$(nproc)" ]; then wait -n || failed=1; running=$((running - 1)); fi
done
while [ $running -gt 0 ]; do wait -n || failed=1; running=$((running - 1)); done
exit $failed
