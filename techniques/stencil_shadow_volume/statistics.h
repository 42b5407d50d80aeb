// Statistics of the last frame, as README.md lists them: drawn again into counts that cannot wrap.
#pragma once
#include "technique/illustration.h"
#include "techniques/stencil_shadow_volume/stencil_pass.h"

namespace penumbra::shadow_volume {

// What the last frame was drawn with: with an average over light samples, for the last of them.
struct LastFrame {
  RenderInput in;
  Variant variant = Variant::z_fail;  // zp_plus becomes z_fail where it falls back
  uint32_t fell_back = 0;             // light samples for which it did
  bool wide = false;                  // counted in floats
  uint32_t layers = 0;                // at most so many volumes lie over each other (see layers.h)
  std::optional<Mat4d> near_plane;
};

// Extracts the volumes anew where ZP+ is held against z-fail; the next frame does so anyway.
Counters count(const Params& params, Volumes& volumes, const StencilPass& stencil, const LastFrame& last);

// Fragments of volumes in each pixel, and silhouettes with a part of their sides.
std::vector<Illustration> illustrate(const Volumes& volumes, const StencilPass& stencil,
                                     const LastFrame& last);

}  // namespace penumbra::shadow_volume
