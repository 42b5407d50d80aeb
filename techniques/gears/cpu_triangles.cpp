#include "techniques/gears/cpu_triangles.h"

#include <algorithm>

#include "core/parallel.h"
#include "samples/view_samples.h"

namespace penumbra::gears::cpu {
namespace {

constexpr std::size_t grain = 4096;

// body(begin, end) in parallel. The body is one reference, so that std::function needs no memory of its own.
template <class F>
void each_chunk(std::size_t n, std::size_t size, const F& body) {
  parallel_for(n, size, [&body](std::size_t begin, std::size_t end) { body(begin, end); });
}

}  // namespace

void put(Block& block, std::size_t lane, const Vec3f* corners) {
  for (std::size_t f = 0; f < corner_fields; ++f) {
    const int axis = static_cast<int>(f % 3);
    block.v[f][lane] = corners ? corners[f / 3][axis] : nowhere[axis];
  }
}

void Triangles::order(const Geometry& geometry, bool tree, SpatialOrder kind) {
  working_.resize(geometry.positions.size());
  list_slots_.resize(geometry.triangle_count());
  listed_.reserve(geometry.triangle_count());
  if (!tree) {
    cells_.resize(geometry.triangle_count());
    return;
  }
  order_ = order_triangles(geometry, block_size, kind);
  blocks_.resize(order_.leaf_count);
  for (auto& v : boxes_) v.resize(order_.node_count + block_size);
}

void Triangles::move_vertices(const Geometry& geometry, const FrameConstants& f) {
  grid_ = f.light.front_only != 0;
  const LightBasis& b = f.light;
  each_chunk(working_.size(), grain, [&](std::size_t begin, std::size_t end) {
    const Vec3f origin = b.origin.xyz(), x = b.row_x.xyz(), y = b.row_y.xyz(), z = b.row_z.xyz();
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3f d = geometry.positions[v] - origin;
      working_[v] = {dot(x, d), dot(y, d), dot(z, d)};
    }
  });
}

// Before a grid of light samples: listed are those that reach its plane, as their shadow needs a fourth
// half-space, and left out those wholly behind it.
void Triangles::fill_leaf(const Geometry& geometry, std::size_t leaf) {
  Vec3f lo{1e30F, 1e30F, 1e30F}, hi = -lo;
  for (std::size_t j = 0; j < block_size; ++j) {
    const uint32_t t = order_.slots[leaf * block_size + j];
    Vec3f c[3];
    bool in_tree = t != no_triangle;
    if (in_tree) {
      corners(geometry, t, c);
      const Vec3f least = min(c[0], min(c[1], c[2])), most = max(c[0], max(c[1], c[2]));
      if (grid_ && !(least.z > 0)) {
        in_tree = false;
        if (most.z > 0) add_to_list(t);
      }
      if (in_tree) lo = min(lo, least), hi = max(hi, most);
    }
    put(blocks_[leaf], j, in_tree ? c : nullptr);
  }
  const std::size_t node = order_.first_leaf + leaf;
  for (std::size_t k = 0; k < 3; ++k)
    boxes_[lo_x + k][node] = lo[static_cast<int>(k)], boxes_[hi_x + k][node] = hi[static_cast<int>(k)];
}

void Triangles::fill_blocks(const Geometry& geometry) {
  list_used_ = 0;
  each_chunk(order_.leaf_count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) fill_leaf(geometry, leaf);
  });
  for (std::size_t s = order_.tree_slots; s < order_.slots.size(); ++s) {
    Vec3f c[3];
    corners(geometry, order_.slots[s], c);
    if (!grid_ || c[0].z > 0 || c[1].z > 0 || c[2].z > 0) add_to_list(order_.slots[s]);
  }
  fill_list(geometry);
}

void Triangles::fill_list(const Geometry& geometry) {
  listed_.assign(list_slots_.begin(), list_slots_.begin() + list_used_);
  std::sort(listed_.begin(), listed_.end());
  const std::size_t blocks = (listed_.size() + block_size - 1) / block_size;
  if (list_blocks_.size() < blocks) list_blocks_.resize(blocks + blocks / 4);
  for (std::size_t i = 0; i < blocks * block_size; ++i) {
    Vec3f c[3];
    if (i < listed_.size()) corners(geometry, listed_[i], c);
    put(list_blocks_[i / block_size], i % block_size, i < listed_.size() ? c : nullptr);
  }
}

// Level by level from the leaves' parents to the root: nodes [first, past).
void Triangles::refit() {
  for (uint32_t past = order_.first_leaf; past > 0;) {
    const uint32_t first = (past - 1) / block_size;
    each_chunk(past - first, 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = first + begin; node < first + end; ++node) {
        const std::size_t child = node * block_size + 1,
                          last = std::min<std::size_t>(child + block_size, order_.node_count);
        for (std::size_t f = 0; f < box_fields; ++f) {
          float v = f <= lo_z ? 1e30F : -1e30F;
          for (std::size_t c = child; c < last; ++c)
            v = f <= lo_z ? std::min(v, boxes_[f][c]) : std::max(v, boxes_[f][c]);
          boxes_[f][node] = v;
        }
      }
    });
    past = first;
  }
}

void Triangles::find_cells(const Geometry& geometry, const FrameConstants& f, const Grid& grid) {
  list_used_ = 0;
  each_chunk(cells_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      Vec3f c[3];
      corners(geometry, static_cast<uint32_t>(t), c);
      const float least_z = std::min({c[0].z, c[1].z, c[2].z}), most_z = std::max({c[0].z, c[1].z, c[2].z});
      CellRange range{1, 1, 0, 0};
      const bool before = !grid_ || most_z > 0;
      if (before && ((grid_ && !(least_z > 0)) || !grid.cells_of(f, c, range))) {
        range = {1, 1, 0, 0};
        add_to_list(static_cast<uint32_t>(t));
      }
      cells_[t] = range;
    }
  });
  fill_list(geometry);
}

uint64_t Triangles::bytes() const {
  uint64_t b = working_.capacity() * sizeof(Vec3f) + order_.slots.capacity() * sizeof(uint32_t) +
               (blocks_.capacity() + list_blocks_.capacity()) * sizeof(Block) +
               cells_.capacity() * sizeof(CellRange) +
               (list_slots_.capacity() + listed_.capacity()) * sizeof(uint32_t);
  for (const auto& v : boxes_) b += v.capacity() * sizeof(float);
  return b;
}

}  // namespace penumbra::gears::cpu
