#include "techniques/depth_complexity_sampling/silhouettes.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "core/parallel.h"

namespace penumbra::depth_complexity {
namespace {

constexpr std::size_t grain = 8192;
constexpr float empty_lo = 1e30F, empty_hi = -1e30F;

// body(begin, end) in parallel. The body is one reference, so that std::function needs no memory of its own.
template <class F>
void each_chunk(std::size_t n, std::size_t size, const F& body) {
  parallel_for(n, size, [&body](std::size_t begin, std::size_t end) { body(begin, end); });
}

// Rounding of n.x * x + n.y * y + n.z * z - d in single precision, with |n| = 1: each of the seven operations
// is off by at most 2^-24 of a value below four times the largest coordinate; twice that, as it is compared
// with another.
float plane_rounding(const LightSpace& light) { return light.magnitude * 0x1p-18F; }

template <class T>
void fit(std::vector<T>& v, std::size_t n) {  // grows with room to spare, never shrinks
  if (v.capacity() < n) v.reserve(n + n / 4);
  v.resize(n);
}

}  // namespace

void NodeLevel::resize(std::size_t n) {
  count = n;
  const std::size_t padded = std::max<std::size_t>(1, (n + block_edges - 1) / block_edges) * block_edges;
  for (std::size_t f = 0; f < v.size(); ++f) {
    fit(v[f], padded);
    for (std::size_t i = n; i < padded; ++i) v[f][i] = f <= lo_z ? empty_lo : f <= hi_z ? empty_hi : 0;
  }
}

void Silhouettes::move_vertices(const EdgeTopology& t, const std::vector<Vec3f>& positions,
                                const LightSpace& light) {
  fit(positions_, t.mesh_vertex.size());
  std::atomic<bool> behind{false};
  each_chunk(positions_.size(), grain, [&](std::size_t begin, std::size_t end) {
    bool any = false;
    for (std::size_t v = begin; v < end; ++v) {
      positions_[v] = light.from_world(positions[t.mesh_vertex[v]]);
      any = any || !(positions_[v].z > 0);
    }
    if (any) behind = true;
  });
  behind_ = behind;
}

void Silhouettes::find_planes(const EdgeTopology& t, const LightSpace& light) {
  const std::size_t faces = t.corners.size() / 3;
  fit(planes_, faces);
  fit(side_, faces);
  const double pad = static_cast<double>(plane_rounding(light));
  const Vec3d lo(light.lo), hi(light.hi);
  each_chunk(faces, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Vec3d a(positions_[t.corners[3 * f]]), b(positions_[t.corners[3 * f + 1]]),
          c(positions_[t.corners[3 * f + 2]]);
      const Vec3d normal = cross(b - a, c - a);
      const double size = length(normal);
      // A face without area has no side: 0 everywhere, which counts as +.
      const Vec3f n(size > 0 ? normal / size : Vec3d{});
      const float d = static_cast<float>(dot(Vec3d(n), a));
      planes_[f] = {n.x, n.y, n.z, d};
      // Lowest and highest corner of the light's bounds.
      double least = -static_cast<double>(d), most = least;
      for (int i = 0; i < 3; ++i) {
        const double p = static_cast<double>(n[i]) * lo[i], q = static_cast<double>(n[i]) * hi[i];
        least += std::min(p, q), most += std::max(p, q);
      }
      side_[f] = static_cast<int8_t>(least > pad ? 1 : most < -pad ? -1 : 0);
    }
  });
  cuts_.clear();
  if (behind_) find_cuts(t);
}

// A face that straddles the light's plane ends there: it gets an edge of its own along the cut.
void Silhouettes::find_cuts(const EdgeTopology& t) {
  const auto before = [&](uint32_t v) { return positions_[v].z > 0; };
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    const uint32_t* c = &t.corners[3 * f];
    if (before(c[0]) == before(c[1]) && before(c[1]) == before(c[2])) continue;
    Cut cut{static_cast<uint32_t>(f), 0, 0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      const uint32_t from = c[k], to = c[(k + 1) % 3];
      if (before(from) && !before(to)) cut.leaves_a = from, cut.leaves_b = to;
      if (!before(from) && before(to)) cut.enters_a = from, cut.enters_b = to;
    }
    cuts_.push_back(cut);
  }
}

// Drops an edge whose two faces see the whole light from the same side, in the sense that they cancel. Where
// it hides the light from a point P, P is on the other side of both planes, so there it is no silhouette;
// where it is one, it lies beside the light and adds the same to all samples.
void Silhouettes::choose_edges(const EdgeTopology& t) {
  const std::size_t edges = t.edges.size(), chunks = (edges + grain - 1) / grain;
  fit(chosen_, edges);
  fit(chunk_, chunks);
  const auto choose = [&](std::size_t chunk, std::size_t) {
    const std::size_t begin = chunk * grain, end = std::min(edges, begin + grain);
    std::size_t at = begin;
    for (std::size_t i = begin; i < end; ++i) {
      const Edge& e = t.edges[i];
      const int first = side_[e.face],
                second = e.second_flipped() ? -side_[e.second_face()] : side_[e.second_face()];
      const bool cancels = first != 0 && first == second;
      chosen_[at] = static_cast<uint32_t>(i);
      at += cancels ? 0 : 1;
    }
    if (behind_) {
      const auto kept = std::remove_if(
          chosen_.begin() + static_cast<std::ptrdiff_t>(begin),
          chosen_.begin() + static_cast<std::ptrdiff_t>(at),
          [&](uint32_t i) { return !(positions_[t.edges[i].a].z > 0) && !(positions_[t.edges[i].b].z > 0); });
      at = static_cast<std::size_t>(kept - chosen_.begin());
    }
    chunk_[chunk] = static_cast<uint32_t>(at - begin);
  };
  each_chunk(chunks, 1, choose);
  std::size_t at = 0;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const auto from = chosen_.begin() + static_cast<std::ptrdiff_t>(chunk * grain);
    std::copy(from, from + chunk_[chunk], chosen_.begin() + static_cast<std::ptrdiff_t>(at));
    at += chunk_[chunk];
  }
  chosen_.resize(at);
  potential_ = at + cuts_.size();
}

// Where the edge a-b crosses the light's plane: the same for all faces there, whichever way they run.
Vec3f Silhouettes::on_light_plane(uint32_t a, uint32_t b) const {
  const Vec3d p(positions_[std::min(a, b)]), q(positions_[std::max(a, b)]);
  const Vec3f cut(p + (q - p) * (p.z / (p.z - q.z)));
  return {cut.x, cut.y, 0};
}

Silhouettes::Ends Silhouettes::ends(const EdgeTopology& t, std::size_t potential) const {
  if (potential >= chosen_.size()) {
    const Cut& c = cuts_[potential - chosen_.size()];
    return {on_light_plane(c.leaves_a, c.leaves_b), on_light_plane(c.enters_a, c.enters_b)};
  }
  const Edge& e = t.edges[chosen_[potential]];
  const Vec3f a = positions_[e.a], b = positions_[e.b];
  return {a.z > 0 ? a : on_light_plane(e.a, e.b), b.z > 0 ? b : on_light_plane(e.a, e.b)};
}

void Silhouettes::fill_block(const EdgeTopology& t, std::size_t block, float pad) {
  Block& out = blocks_[block];
  Vec3f lo{empty_lo, empty_lo, empty_lo}, hi = -lo, normal_lo = lo, normal_hi = hi;
  Vec3f normals[2 * block_edges];
  float offsets[2 * block_edges];
  for (std::size_t j = 0; j < block_edges; ++j) {
    const std::size_t i = std::min(block * block_edges + j, potential_ - 1);
    const bool padding = block * block_edges + j >= potential_;
    const bool is_cut = i >= chosen_.size();
    const Edge e = is_cut ? Edge{0, 0, cuts_[i - chosen_.size()].face,
                                 cuts_[i - chosen_.size()].face | Edge::flipped_bit}
                          : t.edges[chosen_[i]];
    const Ends at = ends(t, i);
    const Plane p = planes_[e.face], q = planes_[e.second_face()];
    // Padding: one face twice, which is never a silhouette.
    const bool flipped = e.second_flipped() && !padding;
    const Plane second = padding ? p : q;
    const float sign = flipped ? -1.0F : 1.0F;
    const float values[fields] = {at.a.x,
                                  at.a.y,
                                  at.a.z,
                                  at.b.x,
                                  at.b.y,
                                  at.b.z,
                                  p.x,
                                  p.y,
                                  p.z,
                                  p.d,
                                  second.x,
                                  second.y,
                                  second.z,
                                  second.d,
                                  std::bit_cast<float>(flipped ? 0x80000000U : 0U),
                                  std::bit_cast<float>(e.open() ? 1 : 2)};
    for (std::size_t f = 0; f < fields; ++f) out.v[f][j] = values[f];
    normals[2 * j] = {p.x, p.y, p.z}, offsets[2 * j] = p.d;
    normals[2 * j + 1] = Vec3f{second.x, second.y, second.z} * sign, offsets[2 * j + 1] = second.d * sign;
    lo = min(lo, min(at.a, at.b)), hi = max(hi, max(at.a, at.b));
    for (int s = 0; s < 2; ++s) {
      const Vec3f n = normals[2 * j + static_cast<std::size_t>(s)];
      normal_lo = min(normal_lo, n), normal_hi = max(normal_hi, n);
    }
  }
  const Vec3f center = (lo + hi) * 0.5F;
  float least = empty_lo, most = empty_hi;
  for (std::size_t k = 0; k < 2 * block_edges; ++k) {
    const float o = offsets[k] - dot(normals[k], center);
    least = std::min(least, o), most = std::max(most, o);
  }
  NodeLevel& level = levels_.front();
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    level.v[lo_x + axis][block] = lo[i];
    level.v[hi_x + axis][block] = hi[i];
    level.v[normal_x + axis][block] = (normal_lo[i] + normal_hi[i]) * 0.5F;
    level.v[spread_x + axis][block] = (normal_hi[i] - normal_lo[i]) * 0.5F + 1e-6F;
  }
  level.v[offset][block] = (least + most) * 0.5F;
  level.v[offset_spread][block] = (most - least) * 0.5F + pad;
}

void Silhouettes::fill_blocks(const EdgeTopology& t, const LightSpace& light) {
  const std::size_t count = (potential_ + block_edges - 1) / block_edges;
  fit(blocks_, count);
  levels_.front().resize(count);
  const float pad = plane_rounding(light);
  each_chunk(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) fill_block(t, b, pad);
  });
}

namespace {

void fill_parent(const NodeLevel& below, NodeLevel& level, std::size_t node, float pad) {
  const std::size_t first = node * block_edges, last = std::min(first + block_edges, below.count);
  float center[3];
  for (std::size_t i = 0; i < 3; ++i) {
    float lo = empty_lo, hi = empty_hi, normal_lo = empty_lo, normal_hi = empty_hi;
    for (std::size_t c = first; c < last; ++c) {
      lo = std::min(lo, below.v[lo_x + i][c]), hi = std::max(hi, below.v[hi_x + i][c]);
      normal_lo = std::min(normal_lo, below.v[normal_x + i][c] - below.v[spread_x + i][c]);
      normal_hi = std::max(normal_hi, below.v[normal_x + i][c] + below.v[spread_x + i][c]);
    }
    level.v[lo_x + i][node] = lo, level.v[hi_x + i][node] = hi;
    level.v[normal_x + i][node] = (normal_lo + normal_hi) * 0.5F;
    level.v[spread_x + i][node] = (normal_hi - normal_lo) * 0.5F + 1e-6F;
    center[i] = (lo + hi) * 0.5F;
  }
  // The offsets were taken at each child's own centre; moved to this one's they spread by the normals'
  // spread.
  float least = empty_lo, most = empty_hi;
  for (std::size_t c = first; c < last; ++c) {
    float o = below.v[offset][c], r = below.v[offset_spread][c];
    for (std::size_t i = 0; i < 3; ++i) {
      const float move = (below.v[lo_x + i][c] + below.v[hi_x + i][c]) * 0.5F - center[i];
      o += below.v[normal_x + i][c] * move;
      r += below.v[spread_x + i][c] * std::abs(move);
    }
    least = std::min(least, o - r), most = std::max(most, o + r);
  }
  level.v[offset][node] = (least + most) * 0.5F;
  level.v[offset_spread][node] = (most - least) * 0.5F + pad;
}

}  // namespace

void Silhouettes::build_tree(const LightSpace& light) {
  const float pad = plane_rounding(light);
  level_count_ = 1;
  for (std::size_t n = block_count(); n > block_edges; ++level_count_) {
    n = (n + block_edges - 1) / block_edges;
    if (levels_.size() == level_count_) levels_.emplace_back();
    const NodeLevel& below = levels_[level_count_ - 1];
    NodeLevel& level = levels_[level_count_];
    level.resize(n);
    each_chunk(n, 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) fill_parent(below, level, node, pad);
    });
  }
}

uint64_t Silhouettes::bytes() const {
  uint64_t b = positions_.capacity() * sizeof(Vec3f) + planes_.capacity() * sizeof(Plane) + side_.capacity() +
               (chosen_.capacity() + chunk_.capacity()) * sizeof(uint32_t) + cuts_.capacity() * sizeof(Cut) +
               blocks_.capacity() * sizeof(Block);
  for (const NodeLevel& level : levels_)
    for (const auto& v : level.v) b += v.capacity() * sizeof(float);
  return b;
}

}  // namespace penumbra::depth_complexity
