// What the last frame looked like from inside: wedges over the scene, and how many each view sample is in.
#pragma once
#include "technique/illustration.h"
#include "techniques/soft_shadow_volume/wedge_pass.h"

namespace penumbra::soft_shadow_volume {

// Extracts silhouettes and draws wedges anew, for each of `parts` in turn; lines are of the first.
std::vector<Illustration> illustrate(WedgePass& wedges, Silhouettes& silhouettes,
                                     const std::vector<Part>& parts, const RenderInput& in,
                                     gpu::PassRecorder& passes);

}  // namespace penumbra::soft_shadow_volume
