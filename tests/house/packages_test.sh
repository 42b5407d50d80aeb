#!/usr/bin/env bash
# Each library that CMake looks for has its package in the list, and shell scripts parse.
set -euo pipefail
root=$1
list=$root/scripts/packages.list
for package in libvulkan-dev libembree-dev libopenexr-dev libpng-dev zlib1g-dev libassimp-dev nlohmann-json3-dev libcli11-dev \
  libtbb-dev libhwy-dev libfmt-dev libbenchmark-dev libgtest-dev libxxhash-dev glslang-tools; do
  grep -qw -- "$package" "$list" || { echo "$package is not in scripts/packages.list"; exit 1; }
done
found=$(grep -c '^find_package\|^pkg_check_modules\|^find_program\|^find_path\|^  find_package(GTest' "$root/CMakeLists.txt")
[ "$found" -eq 17 ] || { echo "CMakeLists.txt looks for $found things; name the new one's package in this test"; exit 1; }
for script in "$root"/scripts/* "$root"/scripts/*/* "$root/.ci/run"; do
  [ -f "$script" ] || continue
  if head -n 1 "$script" | grep -q bash; then bash -n "$script"; fi
done
# A word that setup does not know changes nothing and is refused.
code=0
"$root/scripts/setup" nonsense 2>/dev/null || code=$?
[ "$code" -eq 2 ] || { echo "scripts/setup nonsense: exit code $code, expected 2"; exit 1; }
