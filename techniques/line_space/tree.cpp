#include "techniques/line_space/tree.h"

#include <fmt/format.h>

#include <cstring>

#include "core/error.h"

namespace penumbra::line_space {

bool Pools::operator==(const Pools& other) const {
  return tree == other.tree && line_space == other.line_space && level_begin == other.level_begin &&
         nodes.size() == other.nodes.size() &&
         std::memcmp(nodes.data(), other.nodes.data(), nodes.size() * sizeof(Node)) == 0;
}

PoolBytes pool_bytes(uint32_t n, uint64_t nodes) {
  const uint64_t subnodes = uint64_t{n} * n * n;
  return {nodes * subnodes * 4, nodes * sizeof(Node), nodes * ((15 * subnodes * n + 31) / 32 * 4)};
}

void check_memory(uint32_t n, uint64_t nodes, uint64_t pairs, int limit_mib) {
  constexpr uint64_t mib = 1 << 20, places = uint64_t{1} << 31;
  const PoolBytes bytes = pool_bytes(n, nodes);
  const uint64_t pair_bytes = pairs * 3 * sizeof(uint32_t);
  const uint64_t needed = bytes.total() + pair_bytes;
  if (needed > static_cast<uint64_t>(limit_mib) * mib)
    throw PointError(fmt::format(
        "line_space needs {} MiB for {} nodes and {} pairs of a triangle and a node; memory_limit_mib is {}.",
        needed / mib, nodes, pairs, limit_mib));
  if (bytes.tree / 4 >= places || bytes.line_space / 4 >= places || 2 * pairs >= places)
    throw PointError(fmt::format("line_space has no 32-bit places for {} nodes and {} pairs.", nodes, pairs));
}

}  // namespace penumbra::line_space
