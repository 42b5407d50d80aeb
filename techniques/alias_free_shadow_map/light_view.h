// The light's view: where lists lie. Host side, double precision, no device.
#pragma once
#include <optional>

#include "core/vec.h"
#include "techniques/alias_free_shadow_map/shaders/shared.h"
#include "techniques/common/light_frame.h"

namespace penumbra::alias_free {

// A constant of the pipelines: a case keeps its kind of light.
inline bool at_infinity(const Light& light) { return light.kind == LightKind::directional; }

// Box of q, or bounds (u, v, depth) in a face.
struct Extent {
  Vec3d lo{INFINITY, INFINITY, INFINITY}, hi{-INFINITY, -INFINITY, -INFINITY};
  bool whole = true;  // false: a view sample was beyond the limit
  bool empty() const { return !(lo.x <= hi.x); }
  void extend(Vec3d p) { lo = min(lo, p), hi = max(hi, p); }
};
Extent decode(const SampleBounds& bounds);

// Light, emission and centre; no faces yet. `scene`: the scene's bounds.
LightView begin_view(const LightPoint& light, const Box& scene);

// One face: directional lights and narrow spots look along their axis, others along `towards` (relative to
// the centre). `hint` becomes the face's v axis as far as it can.
void aim(LightView& view, const LightPoint& light, Vec3d towards, Vec3d hint);
// Six: the sides of a cube.
void aim_cube(LightView& view);

// What the corners of a box (relative to LightView::center) cover of face 0; nothing when they do not all lie
// before the light within the limit.
std::optional<Extent> extent_of(const LightView& view, Vec3d lo, Vec3d hi);

// The window of a face: `extent`, padded by what rounding may add.
void set_window(LightView& view, uint32_t face, const Extent& extent, double scene_diagonal);

}  // namespace penumbra::alias_free
