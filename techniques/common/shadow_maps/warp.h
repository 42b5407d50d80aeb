// Warps: projective maps of the light's view that give near receivers more texels. Light rays stay parallel
// to z, so a warp is a homography of the map's plane; what casts from anywhere along a ray stays on its
// texel, and the depth test and depth clamp work as without one.
#pragma once
#include <optional>

#include "scene/camera.h"
#include "techniques/common/shadow_maps/light_space.h"

namespace penumbra::shadow_map {

// What a warp knows: light space with the view direction along +y, and what the map must cover there.
struct WarpInput {
  Mat4d light_from_world;
  LightPoint light;
  Extent extent;  // of the view samples, with their view depths
  Camera camera;
  int width = 0, height = 0;  // of the picture
  double room = 0;            // scene units kept before the nearest view sample
};

// The frame about the light's axis whose +y is the image of the view direction. Nothing where that image is a
// point: view and light are aligned, and there is nothing to warp.
std::optional<LightFrame> view_aligned(const LightPoint& light, Vec3d forward, const Camera& camera,
                                       double view_lo, double view_hi);

// Distance of the centre of projection before the near edge of a body of depth d.
// [Wimmer2004]: n = (z0 + sqrt(z0 z1)) / sin, z0 and z1 the view depths of the edges; d sin = z1 -
// z0.
double lispsm_distance(double z0, double z1, double d);
// [Martin2004]: the focus, `focus` behind the near edge, falls on the line xi in [-1, 1] (near edge
// 1, far edge -1; the paper's 80 % line is xi = -0.6).
double tsm_distance(double focus, double d, double xi);
// [Lloyd2008]: the eye's own perspective along the body, which the logarithm then evens out.
double log_distance(double z0, double z1, double d);

// Light space after the warp, from light space before it. `factor` scales LiSPSM's n (1: the paper's
// optimum); `focus_share` is the share of the view depths that TSM's focus region takes. Nothing when the
// warp is not possible here: receivers behind its centre, a light among them, or view and light aligned.
std::optional<Mat4d> warp(Warp kind, const WarpInput& in, double factor, double focus_share);

}  // namespace penumbra::shadow_map
