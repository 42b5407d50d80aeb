// What goes into the tree, and where the tree lies.
#pragma once
#include <cstdint>
#include <vector>

#include "samples/light_samples.h"
#include "scene/scene.h"
#include "techniques/line_space/params.h"

namespace penumbra::line_space {

// Bit f: face f of the scene's bounding box (2 axis + (upper ? 1 : 0)) has all light samples strictly on its
// inner side. A triangle in such a face cannot block: a segment from a point of the scene to a light sample
// meets the face's plane in its first point at most.
uint32_t faces_before_light(const Box& scene, const LightSamples& light);

// Triangles that are in none of those faces, nor within rounding of one.
std::vector<uint32_t> select_casters(const Geometry& geometry, uint32_t faces);

// The root node, and how far rounding may displace anything: `slack`, in world units.
struct Grid {
  Vec3f lo, size;  // of the root node
  float slack = 0;
  uint32_t branching = 2, depth = 1;
  uint32_t leaves() const;      // N^d: subnodes of the finest nodes, a side
  uint32_t fine_cells() const;  // N^(d-1): finest subdivided nodes, a side
  // Per world unit.
  Vec3f leaf_scale() const { return scale(leaves()); }
  Vec3f fine_scale() const { return scale(fine_cells()); }
  // Added to every side of a subnode when triangles are tested against it, in leaves.
  Vec3f padding() const;

 private:
  Vec3f scale(uint32_t cells) const;
};

Grid make_grid(const Geometry& geometry, const std::vector<uint32_t>& casters, const Params& params);

}  // namespace penumbra::line_space
