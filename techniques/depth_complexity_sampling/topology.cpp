#include "techniques/depth_complexity_sampling/topology.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <tuple>

#include "core/parallel.h"
#include "techniques/depth_complexity_sampling/morton.h"

namespace penumbra::depth_complexity {
namespace {

constexpr std::size_t grain = 8192;

std::size_t chunks_of(std::size_t n) { return (n + grain - 1) / grain; }

// body(chunk, begin, end) in parallel.
template <class F>
void each_chunk(std::size_t n, const F& body) {
  parallel_for(chunks_of(n), 1, [&](std::size_t chunk, std::size_t) {
    body(chunk, chunk * grain, std::min(n, (chunk + 1) * grain));
  });
}

// Vertices sorted along a Morton curve, equal positions side by side.
std::vector<Keyed> sorted_vertices(const std::vector<Vec3f>& positions) {
  std::vector<Box> boxes(chunks_of(positions.size()));
  each_chunk(positions.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) boxes[chunk].extend(positions[v]);
  });
  Box box;
  for (const Box& b : boxes) box.extend(b.lo), box.extend(b.hi);
  const MortonCode code(box);
  std::vector<Keyed> keys(positions.size()), spare(positions.size());
  each_chunk(positions.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) keys[v] = {code(positions[v]), static_cast<uint32_t>(v)};
  });
  sort_by_code(keys, spare);
  return keys;
}

// A position's bits, the same for all zeros, in an order of their own.
std::tuple<uint32_t, uint32_t, uint32_t> exact(Vec3f p) {
  return {std::bit_cast<uint32_t>(p.x + 0.0F), std::bit_cast<uint32_t>(p.y + 0.0F),
          std::bit_cast<uint32_t>(p.z + 0.0F)};
}

// Chunks of sorted keys that begin where a code does; one past the last chunk too.
std::vector<std::size_t> chunks_of_runs(const std::vector<Keyed>& keys) {
  std::vector<std::size_t> start(chunks_of(keys.size()) + 1, keys.size());
  for (std::size_t chunk = 0; chunk + 1 < start.size(); ++chunk) {
    std::size_t& begin = start[chunk] = chunk * grain;
    while (begin > 0 && begin < keys.size() && keys[begin].code == keys[begin - 1].code) ++begin;
  }
  return start;
}

// Numbers the distinct positions along the curve; gives each mesh vertex its number.
Array<uint32_t> weld(const std::vector<Vec3f>& positions, EdgeTopology& out) {
  std::vector<Keyed> keys = sorted_vertices(positions);
  const std::vector<std::size_t> start = chunks_of_runs(keys);
  const std::size_t chunks = start.size() - 1;
  const auto is_new = [&](std::size_t i) {
    return i == 0 || keys[i].code != keys[i - 1].code ||
           exact(positions[keys[i].index]) != exact(positions[keys[i - 1].index]);
  };
  std::vector<uint32_t> first(chunks + 1, 0);  // number of the first position of a chunk
  parallel_for(chunks, 1, [&](std::size_t chunk, std::size_t) {
    for (std::size_t a = start[chunk], b = a; a < start[chunk + 1]; a = b) {
      while (b < start[chunk + 1] && keys[b].code == keys[a].code) ++b;
      std::sort(keys.begin() + static_cast<std::ptrdiff_t>(a), keys.begin() + static_cast<std::ptrdiff_t>(b),
                [&](const Keyed& x, const Keyed& y) {
                  const auto p = exact(positions[x.index]), q = exact(positions[y.index]);
                  return p != q ? p < q : x.index < y.index;
                });
    }
    for (std::size_t i = start[chunk]; i < start[chunk + 1]; ++i)
      first[chunk + 1] += i == start[chunk] || is_new(i);
  });
  std::inclusive_scan(first.begin(), first.end(), first.begin());
  Array<uint32_t> welded(keys.size());
  out.mesh_vertex.resize(first.back());
  parallel_for(chunks, 1, [&](std::size_t chunk, std::size_t) {
    uint32_t number = first[chunk];
    for (std::size_t i = start[chunk]; i < start[chunk + 1]; ++i) {
      if (i == start[chunk] || is_new(i)) out.mesh_vertex[number++] = keys[i].index;
      welded[keys[i].index] = number - 1;
    }
  });
  return welded;
}

// A half-edge, filed under its lower vertex: the other vertex, the face, and 1 where it runs towards the
// lower one.
uint64_t half_edge(uint32_t other, std::size_t face, bool towards_lower) {
  return static_cast<uint64_t>(other) << 32 | static_cast<uint64_t>(face) << 1 | (towards_lower ? 1U : 0U);
}
uint32_t other_vertex(uint64_t h) { return static_cast<uint32_t>(h >> 32); }
uint32_t face_of(uint64_t h) { return static_cast<uint32_t>(h) >> 1; }
bool towards_lower(uint64_t h) { return (h & 1) != 0; }

struct HalfEdges {
  std::vector<uint32_t> start;  // of a vertex's half-edges in `all`; one past the last vertex too
  Array<uint64_t> all;
};

HalfEdges file_half_edges(EdgeTopology& out) {
  const std::size_t vertices = out.mesh_vertex.size(), faces = out.corners.size() / 3;
  HalfEdges h;
  h.start.assign(vertices + 2, 0);  // one more, so that filling in moves `start` to its place
  const auto each_half_edge = [&](std::size_t begin, std::size_t end, const auto& body) {
    std::size_t dropped = 0;
    for (std::size_t f = begin; f < end; ++f) {
      const uint32_t* c = &out.corners[3 * f];
      // Two corners at one place: the edges cancel one another.
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
        ++dropped;
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        const uint32_t from = c[k], to = c[(k + 1) % 3];
        body(std::min(from, to), half_edge(std::max(from, to), f, to < from));
      }
    }
    return dropped;
  };
  std::atomic<std::size_t> dropped_faces{0};
  each_chunk(faces, [&](std::size_t, std::size_t begin, std::size_t end) {
    dropped_faces += each_half_edge(begin, end, [&](uint32_t lower, uint64_t) {
      std::atomic_ref(h.start[lower + 2]).fetch_add(1, std::memory_order_relaxed);
    });
  });
  out.dropped_faces = dropped_faces;
  std::inclusive_scan(h.start.begin(), h.start.end(), h.start.begin());
  h.all.resize(h.start.back());
  each_chunk(faces, [&](std::size_t, std::size_t begin, std::size_t end) {
    each_half_edge(begin, end, [&](uint32_t lower, uint64_t half) {
      h.all[std::atomic_ref(h.start[lower + 1]).fetch_add(1, std::memory_order_relaxed)] = half;
    });
  });
  return h;
}

// A few half-edges of one vertex, in whatever order the threads filed them.
void sort_few(uint64_t* begin, uint64_t* end) {
  if (end - begin > 32) return std::sort(begin, end);
  for (uint64_t* i = begin + 1; i < end; ++i)
    for (uint64_t* j = i; j > begin && j[0] < j[-1]; --j) std::swap(j[0], j[-1]);
}

struct Tally {
  std::size_t edges = 0, open = 0, inconsistent = 0, non_manifold = 0;
};

// The records of one edge from its sorted half-edges: pairs of opposite direction first, then pairs of the
// same direction, then one that is left.
template <class Emit>
void pair_up(uint32_t lower, const uint64_t* begin, const uint64_t* end, Tally& tally, const Emit& emit) {
  const uint32_t other = other_vertex(*begin);
  if (end - begin > 2) ++tally.non_manifold;
  const uint64_t *away = begin, *towards = begin;
  const auto next = [end](const uint64_t*& h, bool direction) {
    while (h < end && towards_lower(*h) != direction) ++h;
    return h < end;
  };
  while (next(away, false) && next(towards, true))
    emit(Edge{lower, other, face_of(*away++), face_of(*towards++)});
  const bool direction = !next(away, false);
  const uint64_t*& rest = direction ? towards : away;
  const uint32_t a = direction ? other : lower, b = direction ? lower : other;
  while (next(rest, direction)) {
    const uint32_t face = face_of(*rest++);
    if (next(rest, direction)) {
      ++tally.inconsistent;
      emit(Edge{a, b, face, face_of(*rest++) | Edge::flipped_bit});
    } else {
      ++tally.open;
      emit(Edge{a, b, face, face | Edge::flipped_bit});
    }
  }
}

template <class Emit>
void each_edge(const HalfEdges& h, std::size_t begin, std::size_t end, Tally& tally, const Emit& emit) {
  for (std::size_t v = begin; v < end; ++v) {
    const uint64_t *first = h.all.data() + h.start[v], *last = h.all.data() + h.start[v + 1];
    while (first < last) {
      const uint64_t* next = first + 1;
      while (next < last && other_vertex(*next) == other_vertex(*first)) ++next;
      pair_up(static_cast<uint32_t>(v), first, next, tally, emit);
      first = next;
    }
  }
}

// Long edges (a ground's) would blow up the boxes of their neighbours in the list.
float long_edge_squared(const EdgeTopology& t, const std::vector<Vec3f>& positions) {
  constexpr double times_mean = 8;
  const std::size_t faces = t.corners.size() / 3, step = std::max<std::size_t>(1, faces / 4096);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t f = 0; f < faces; f += step, ++count)
    sum += static_cast<double>(
        length(positions[t.mesh_vertex[t.corners[3 * f]]] - positions[t.mesh_vertex[t.corners[3 * f + 1]]]));
  const double limit = times_mean * sum / static_cast<double>(std::max<std::size_t>(1, count));
  return static_cast<float>(limit * limit);
}

void list_edges(HalfEdges& h, const std::vector<Vec3f>& positions, EdgeTopology& out) {
  const std::size_t vertices = out.mesh_vertex.size();
  const float limit = long_edge_squared(out, positions);
  const auto is_long = [&](const Edge& e) {
    const Vec3f d = positions[out.mesh_vertex[e.a]] - positions[out.mesh_vertex[e.b]];
    return dot(d, d) > limit;
  };
  // First count, then write: per chunk the short edges, and per chunk the long ones behind all short ones.
  const std::size_t chunks = chunks_of(vertices);
  std::vector<std::size_t> start(2 * chunks + 1, 0);
  std::vector<Tally> tallies(chunks);
  each_chunk(vertices, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t count[2] = {0, 0};
    for (std::size_t v = begin; v < end; ++v)
      sort_few(h.all.data() + h.start[v], h.all.data() + h.start[v + 1]);
    each_edge(h, begin, end, tallies[chunk], [&](const Edge& e) { ++count[is_long(e)]; });
    start[chunk + 1] = count[0];
    start[chunks + chunk + 1] = count[1];
  });
  std::inclusive_scan(start.begin(), start.end(), start.begin());
  out.edges.resize(start.back());
  each_chunk(vertices, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t at[2] = {start[chunk], start[chunks + chunk]};
    Tally again;
    each_edge(h, begin, end, again, [&](const Edge& e) { out.edges[at[is_long(e)]++] = e; });
  });
  for (const Tally& t : tallies)
    out.open += t.open, out.inconsistent += t.inconsistent, out.non_manifold += t.non_manifold;
}

}  // namespace

EdgeTopology find_edges(const Geometry& geometry) {
  EdgeTopology out;
  const Array<uint32_t> welded = weld(geometry.positions, out);
  out.corners.resize(geometry.indices.size());
  each_chunk(geometry.indices.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out.corners[i] = welded[geometry.indices[i]];
  });
  HalfEdges half_edges = file_half_edges(out);
  list_edges(half_edges, geometry.positions, out);
  return out;
}

bool still_welded(const EdgeTopology& topology, const Geometry& geometry) {
  std::atomic<bool> same{topology.corners.size() == geometry.indices.size()};
  if (!same) return false;
  each_chunk(geometry.indices.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const uint32_t vertex = geometry.indices[i], as = topology.mesh_vertex[topology.corners[i]];
      if (vertex != as && exact(geometry.positions[vertex]) != exact(geometry.positions[as])) same = false;
    }
  });
  return same;
}

}  // namespace penumbra::depth_complexity
