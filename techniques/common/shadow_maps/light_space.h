// The light's view in double precision: no device, no buffers. A light space is a projective map in which
// light rays are parallel to z: x/w and y/w say where in the map, z/w how deep, growing away from the light.
#pragma once
#include <optional>
#include <vector>

#include "core/vec.h"
#include "scene/light.h"
#include "techniques/common/light_frame.h"
#include "techniques/common/shadow_maps/params.h"
#include "techniques/common/shadow_maps/shaders/shared.h"

namespace penumbra::shadow_map {

// World to light space. Directional: rigid, z = distance along the light, w = 1. Else w = distance along the
// axis and z/w = -1/w, which any crop in z turns into the depth of a near and a far plane.
Mat4d light_from_world(const LightPoint& light, const LightFrame& frame);

// Smallest and largest x/w, y/w and z/w (and view depth) of what a map must cover.
struct Extent {
  Vec3d lo{INFINITY, INFINITY, INFINITY}, hi{-INFINITY, -INFINITY, -INFINITY};
  double view_lo = INFINITY, view_hi = -INFINITY;
  bool whole = true;  // false: some view samples were outside what was asked for
  bool empty() const { return !(lo.x <= hi.x); }
  void extend(Vec3d p) { lo = min(lo, p), hi = max(hi, p); }
};
Extent decode(const SampleBounds& bounds);

// The extent of a box's corners in a light space; nothing when a corner is not in front of the light, or so
// far from the axis (|x/w| or |y/w| > limit) that one map would be mostly waste.
std::optional<Extent> extent_of(const Box& box, const Mat4d& light_from_world, double limit);

// Share of the map's width inside the border, which takes at most half of it.
double inner_share(double map_size, double border);

// Scale and offset so that `e` fills the map but for `border` texels on each side, and depth [0, 1]. Depths
// closer together than `least_depth` are given that much room.
Mat4d crop(const Extent& e, double map_size, double border, double least_depth);

// To a power of 2^(1/4): what is rounded so seldom changes.
double rounded_up(double size);

// The extent with sizes in x and y rounded up to powers of 2^(1/4) (of the unit of light space) and its
// corner moved to a whole texel of that size: texels keep their places while what they cover moves [Valient
// 2008; Engel 2006].
Extent snapped(const Extent& e, double map_size, double border);

// y' = scale log(-1 / y) + offset replaces the map's y where scale is not 0: logarithmic maps.
struct LogWarp {
  double scale = 0, offset = 0;
};

// One depth map: the whole map, a cascade or a face.
struct FittedLayer {
  LightFrame frame;
  Mat4d space_from_world;               // light space, after a warp, before cropping
  Extent extent;                        // what the map covers there
  double linear_lo = 0, linear_hi = 1;  // and in distance along the frame's axis
  Mat4d clip_from_world;
  LogWarp log;
  double view_lo = -1e30, view_hi = 1e30;
  bool warped = false;
  bool used = true;  // false: no view sample looks into it, it need not be drawn
};

// Map coordinates of a point in [-1, 1], and its depth.
Vec3d map_point(const FittedLayer& layer, Vec3d p);

// What the device needs of a layer. `edge_u`, `edge_v`: an area light's extents (0: none).
MapLayer make_layer(const FittedLayer& layer, const LightPoint& light, double map_size, Vec3d edge_u,
                    Vec3d edge_v);

// Ends of `count` ranges of view depth from `lo` to `hi`: count + 1 values [Zhang2006].
std::vector<double> split_depths(Split split, double lambda, int count, double lo, double hi);

}  // namespace penumbra::shadow_map
