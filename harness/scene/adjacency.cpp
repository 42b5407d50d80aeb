// Half-edge pairing by a counting sort: half-edges are grouped by their smaller welded vertex, each small
// group is sorted by the larger one. Everything but the two linear counting passes runs in parallel.
#include <tbb/parallel_sort.h>

#include <bit>
#include <numeric>

#include "core/parallel.h"
#include "scene/mesh.h"

namespace penumbra {
namespace {

constexpr std::size_t grain = 16384;

struct PositionKey {
  uint32_t x, y, z, vertex;
  bool operator<(const PositionKey& o) const {
    if (x != o.x) return x < o.x;
    if (y != o.y) return y < o.y;
    if (z != o.z) return z < o.z;
    return vertex < o.vertex;
  }
  bool same_position(const PositionKey& o) const { return x == o.x && y == o.y && z == o.z; }
};

// Adding +0 turns -0 into +0, so that the two compare equal by their bits as they do by value.
uint32_t key_bits(float v) { return std::bit_cast<uint32_t>(v + 0.0f); }

void weld(const std::vector<Vec3f>& positions, Adjacency& out) {
  const std::size_t n = positions.size();
  std::vector<PositionKey> keys(n);
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f p = positions[i];
      keys[i] = {key_bits(p.x), key_bits(p.y), key_bits(p.z), static_cast<uint32_t>(i)};
    }
  });
  tbb::parallel_sort(keys.begin(), keys.end());
  // First of each group of equal positions = lowest vertex; then number the groups in vertex order, which
  // keeps whatever locality the mesh had.
  std::vector<uint32_t> first(n);
  for (std::size_t i = 0; i < n; ++i)
    first[keys[i].vertex] =
        i > 0 && keys[i].same_position(keys[i - 1]) ? first[keys[i - 1].vertex] : keys[i].vertex;
  out.welded.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    if (first[v] == v) {
      out.welded[v] = static_cast<uint32_t>(out.representative.size());
      out.representative.push_back(static_cast<uint32_t>(v));
    } else {
      out.welded[v] = out.welded[first[v]];
    }
  }
}

struct HalfEdge {
  uint32_t other;  // the larger welded vertex
  uint32_t triangle;
  int8_t sign;
  bool operator<(const HalfEdge& o) const {
    if (other != o.other) return other < o.other;
    if (triangle != o.triangle) return triangle < o.triangle;
    return sign < o.sign;
  }
};

// Calls f(lower, half_edge) for the three half-edges of each triangle; edges between equal positions are no
// edges.
template <class F>
void for_each_half_edge(const std::vector<uint32_t>& indices, const std::vector<uint32_t>& welded, F f) {
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const uint32_t v[3] = {welded[indices[i]], welded[indices[i + 1]], welded[indices[i + 2]]};
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = v[k], b = v[(k + 1) % 3];
      if (a == b) continue;
      const auto triangle = static_cast<uint32_t>(i / 3);
      if (a < b)
        f(a, HalfEdge{b, triangle, 1});
      else
        f(b, HalfEdge{a, triangle, -1});
    }
  }
}

}  // namespace

Adjacency build_adjacency(const std::vector<Vec3f>& positions, const std::vector<uint32_t>& indices) {
  Adjacency out;
  weld(positions, out);
  const std::size_t vertices = out.representative.size();

  std::vector<uint32_t> start(vertices + 1, 0);
  for_each_half_edge(indices, out.welded, [&](uint32_t lower, const HalfEdge&) { ++start[lower + 1]; });
  std::inclusive_scan(start.begin(), start.end(), start.begin());
  std::vector<HalfEdge> half_edges(start.back());
  std::vector<uint32_t> cursor(start.begin(), start.end() - 1);
  for_each_half_edge(indices, out.welded,
                     [&](uint32_t lower, const HalfEdge& h) { half_edges[cursor[lower]++] = h; });

  std::vector<uint32_t> first_edge(vertices + 1, 0);
  parallel_for(vertices, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::sort(half_edges.begin() + start[v], half_edges.begin() + start[v + 1]);
      uint32_t edges = 0;
      for (uint32_t h = start[v]; h < start[v + 1]; ++h)
        edges += h == start[v] || half_edges[h].other != half_edges[h - 1].other;
      first_edge[v + 1] = edges;
    }
  });
  std::inclusive_scan(first_edge.begin(), first_edge.end(), first_edge.begin());

  out.edges.resize(first_edge.back());
  out.faces.resize(half_edges.size());
  parallel_for(vertices, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      uint32_t edge = first_edge[v];
      for (uint32_t h = start[v]; h < start[v + 1]; ++h) {
        if (h == start[v] || half_edges[h].other != half_edges[h - 1].other)
          out.edges[edge++] = {{static_cast<uint32_t>(v), half_edges[h].other}, h, 0};
        ++out.edges[edge - 1].face_count;
        out.faces[h] = {half_edges[h].triangle, half_edges[h].sign};
      }
    }
  });
  return out;
}

}  // namespace penumbra
