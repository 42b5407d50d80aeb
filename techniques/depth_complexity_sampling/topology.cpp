#include "techniques/depth_complexity_sampling/topology.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>
#include <numeric>
#include <tuple>
#include <utility>

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

struct Welded {
  Array<uint32_t> of_vertex;  // of a mesh vertex: its position's number
  Array<Vec3f> positions;     // by number
};

// Numbers the distinct positions along the curve.
Welded weld(const std::vector<Vec3f>& positions, EdgeTopology& out) {
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
      if (b - a == 1) continue;
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
  Welded welded{Array<uint32_t>(keys.size()), Array<Vec3f>(first.back())};
  out.mesh_vertex.resize(first.back());
  parallel_for(chunks, 1, [&](std::size_t chunk, std::size_t) {
    uint32_t number = first[chunk];
    for (std::size_t i = start[chunk]; i < start[chunk + 1]; ++i) {
      if (i == start[chunk] || is_new(i)) {
        out.mesh_vertex[number] = keys[i].index;
        welded.positions[number++] = positions[keys[i].index];
      }
      welded.of_vertex[keys[i].index] = number - 1;
    }
  });
  return welded;
}

// A half-edge as it lies in its bucket; `face` also tells whether it runs towards the lower vertex.
struct HalfEdge {
  uint32_t lower, other, face;
};
// The same, filed under its lower vertex: the other vertex, the face, and 1 where it runs towards the lower
// one.
uint64_t filed(const HalfEdge& h) { return static_cast<uint64_t>(h.other) << 32 | h.face; }
uint32_t other_vertex(uint64_t h) { return static_cast<uint32_t>(h >> 32); }
uint32_t face_of(uint64_t h) { return static_cast<uint32_t>(h) >> 1; }
bool towards_lower(uint64_t h) { return (h & 1) != 0; }

// Half-edges in buckets of vertices that follow each other: one bucket at a time fits into a cache, and
// belongs to one thread.
struct Buckets {
  int shift = 0;                   // a vertex's bucket is its number >> shift
  std::vector<std::size_t> start;  // of a bucket's half-edges; one past the last bucket too
  Array<HalfEdge> all;             // then, 8 bytes each from a bucket's start on, filed and sorted
  Array<uint32_t> used;            // of a vertex: half-edges filed under it
  std::size_t count() const { return start.size() - 1; }
  std::size_t half_edges(std::size_t bucket) const { return start[bucket + 1] - start[bucket]; }
};

constexpr std::size_t bucket_vertices = 1024, most_buckets = 4096;

// Faces in few chunks, as each has a place in each bucket.
struct FaceChunks {
  std::size_t faces, size, count;
  explicit FaceChunks(std::size_t n)
      : faces(n), size(std::max(grain, (n + 63) / 64)), count((n + size - 1) / size) {}
  // body(chunk, begin, end) in parallel.
  template <class F>
  void each(const F& body) const {
    parallel_for(count, 1, [&](std::size_t chunk, std::size_t) {
      body(chunk, chunk * size, std::min(faces, (chunk + 1) * size));
    });
  }
};

// body(half-edge) for all of the faces; returns how many have two corners at one place: their edges cancel
// one another.
template <class F>
std::size_t each_half_edge(const EdgeTopology& t, std::size_t begin, std::size_t end, const F& body) {
  std::size_t dropped = 0;
  for (std::size_t f = begin; f < end; ++f) {
    const uint32_t* c = &t.corners[3 * f];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
      ++dropped;
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const uint32_t from = c[k], to = c[(k + 1) % 3];
      body(HalfEdge{std::min(from, to), std::max(from, to),
                    static_cast<uint32_t>(f) << 1 | (to < from ? 1U : 0U)});
    }
  }
  return dropped;
}

// Corners by welded number, and their half-edges into buckets: counted first, so that each chunk of faces has
// a place of its own in each bucket.
Buckets fill_buckets(const std::vector<uint32_t>& indices, const Welded& welded, EdgeTopology& out) {
  const std::size_t vertices = out.mesh_vertex.size();
  const FaceChunks chunks(indices.size() / 3);
  Buckets b;
  b.shift = static_cast<int>(std::bit_width(std::max(bucket_vertices, vertices / most_buckets) - 1));
  const std::size_t buckets = (vertices >> b.shift) + 1;
  std::vector<std::vector<std::size_t>> place(chunks.count, std::vector<std::size_t>(buckets, 0));
  std::atomic<std::size_t> dropped{0};
  chunks.each([&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = 3 * begin; i < 3 * end; ++i) out.corners[i] = welded.of_vertex[indices[i]];
    dropped +=
        each_half_edge(out, begin, end, [&](const HalfEdge& h) { ++place[chunk][h.lower >> b.shift]; });
  });
  out.dropped_faces = dropped;
  std::size_t sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    b.start.push_back(sum);
    for (auto& p : place) sum += std::exchange(p[bucket], sum);
  }
  b.start.push_back(sum);
  b.all.resize(sum);
  b.used.resize(vertices);
  chunks.each([&](std::size_t chunk, std::size_t begin, std::size_t end) {
    each_half_edge(out, begin, end,
                   [&](const HalfEdge& h) { b.all[place[chunk][h.lower >> b.shift]++] = h; });
  });
  return b;
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

// The vertices of a bucket, and its half-edges in their order.
struct OpenBucket {
  std::size_t first_vertex, last_vertex;
  Array<uint64_t> half_edges;

  OpenBucket(const Buckets& b, std::size_t bucket)
      : first_vertex(bucket << b.shift),
        last_vertex(std::min((bucket + 1) << b.shift, b.used.size())),
        half_edges(b.half_edges(bucket)) {}

  // Files the bucket's half-edges under their vertices, and leaves them filed.
  void sort(Buckets& b, std::size_t bucket) {
    const HalfEdge* loose = b.all.data() + b.start[bucket];
    uint32_t* used = b.used.data() + first_vertex;
    std::fill(used, used + (last_vertex - first_vertex), 0U);
    for (std::size_t i = 0; i < half_edges.size(); ++i) ++used[loose[i].lower - first_vertex];
    std::vector<uint32_t> at(last_vertex - first_vertex + 1, 0);
    std::inclusive_scan(used, used + (last_vertex - first_vertex), at.begin() + 1);
    for (std::size_t i = 0; i < half_edges.size(); ++i)
      half_edges[at[loose[i].lower - first_vertex]++] = filed(loose[i]);
    uint64_t* h = half_edges.data();
    for (std::size_t v = first_vertex; v < last_vertex; h += b.used[v++]) sort_few(h, h + b.used[v]);
    std::memcpy(b.all.data() + b.start[bucket], half_edges.data(), half_edges.size() * sizeof(uint64_t));
  }
  void reopen(const Buckets& b, std::size_t bucket) {
    std::memcpy(half_edges.data(), b.all.data() + b.start[bucket], half_edges.size() * sizeof(uint64_t));
  }
  template <class Emit>
  void each_edge(const Buckets& b, Tally& tally, const Emit& emit) const {
    const uint64_t* first = half_edges.data();
    for (std::size_t v = first_vertex; v < last_vertex; ++v)
      for (const uint64_t* last = first + b.used[v]; first < last;) {
        const uint64_t* next = first + 1;
        while (next < last && other_vertex(*next) == other_vertex(*first)) ++next;
        pair_up(static_cast<uint32_t>(v), first, next, tally, emit);
        first = next;
      }
  }
};

// Long edges (a ground's) would blow up the boxes of their neighbours in the list.
float long_edge_squared(const EdgeTopology& t, const Array<Vec3f>& positions) {
  constexpr double times_mean = 8;
  const std::size_t faces = t.corners.size() / 3, step = std::max<std::size_t>(1, faces / 4096);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t f = 0; f < faces; f += step, ++count)
    sum += static_cast<double>(length(positions[t.corners[3 * f]] - positions[t.corners[3 * f + 1]]));
  const double limit = times_mean * sum / static_cast<double>(std::max<std::size_t>(1, count));
  return static_cast<float>(limit * limit);
}

// First counts, then writes: per bucket the short edges, and per bucket the long ones behind all short ones.
void list_edges(Buckets& b, const Array<Vec3f>& positions, EdgeTopology& out) {
  const float limit = long_edge_squared(out, positions);
  const auto is_long = [&](const Edge& e) {
    const Vec3f d = positions[e.a] - positions[e.b];
    return dot(d, d) > limit;
  };
  const std::size_t buckets = b.count();
  std::vector<std::size_t> start(2 * buckets + 1, 0);
  std::vector<Tally> tallies(buckets);
  parallel_for(buckets, 1, [&](std::size_t bucket, std::size_t) {
    OpenBucket open(b, bucket);
    open.sort(b, bucket);
    std::size_t count[2] = {0, 0};
    open.each_edge(b, tallies[bucket], [&](const Edge& e) { ++count[is_long(e)]; });
    start[bucket + 1] = count[0];
    start[buckets + bucket + 1] = count[1];
  });
  std::inclusive_scan(start.begin(), start.end(), start.begin());
  out.edges.resize(start.back());
  parallel_for(buckets, 1, [&](std::size_t bucket, std::size_t) {
    OpenBucket open(b, bucket);
    open.reopen(b, bucket);
    std::size_t at[2] = {start[bucket], start[buckets + bucket]};
    Tally again;
    open.each_edge(b, again, [&](const Edge& e) { out.edges[at[is_long(e)]++] = e; });
  });
  for (const Tally& t : tallies)
    out.open += t.open, out.inconsistent += t.inconsistent, out.non_manifold += t.non_manifold;
}

}  // namespace

void* allocate_array(std::size_t bytes) {
  constexpr std::size_t large_page = std::size_t{2} << 20;
  void* p = nullptr;
  if (bytes < 2 * large_page) {
    p = std::malloc(bytes);
  } else if (posix_memalign(&p, large_page, bytes) == 0) {
    madvise(p, bytes / large_page * large_page, MADV_HUGEPAGE);  // a wish: without it pages are small
  }
  if (!p) throw std::bad_alloc();
  return p;
}

void free_array(void* p) { std::free(p); }

EdgeTopology find_edges(const Geometry& geometry) {
  EdgeTopology out;
  const Welded welded = weld(geometry.positions, out);
  out.corners.resize(geometry.indices.size());
  Buckets buckets = fill_buckets(geometry.indices, welded, out);
  list_edges(buckets, welded.positions, out);
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
