// Statistics of the last frame, as README.md lists them.
#pragma once
#include "technique/illustration.h"
#include "technique/technique.h"
#include "techniques/common/shadow_maps/fitter.h"

namespace penumbra::shadow_map {

// Side of a texel in pixels at a view sample: the square root of the area that one texel covers on the
// receiver's plane, seen from the camera, in pixels. Above 1 the map is coarser than the picture there.
double texel_in_pixels(const FittedLayer& layer, double map_size, const Camera& camera, int width, int height,
                       double pixel_x, double pixel_y, Vec3d position, Vec3d normal);

Counters count(const Params& params, const Fitted& fitted, uint64_t map_bytes, const RenderInput& last);

// Texels' sizes; where there are several maps, which of them each view sample looks into, and what they
// cover.
std::vector<Illustration> illustrate(const Params& params, const Fitted& fitted, const RenderInput& last);

}  // namespace penumbra::shadow_map
