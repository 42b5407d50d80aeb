#include "techniques/registry.h"

#include "techniques/alias_free_shadow_map/alias_free_shadow_map.h"
#include "techniques/depth_complexity_sampling/depth_complexity_sampling.h"
#include "techniques/gears/gears.h"
#include "techniques/line_space/line_space.h"
#include "techniques/planar_shadow/planar_shadow.h"
#include "techniques/ray_tracing/ray_tracing.h"
#include "techniques/sample_based_soft/sample_based_soft.h"
#include "techniques/shadow_map/shadow_map.h"
#include "techniques/shadow_map_per_sample/shadow_map_per_sample.h"
#include "techniques/soft_shadow_volume/soft_shadow_volume.h"
#include "techniques/stencil_shadow_volume/stencil_shadow_volume.h"

namespace penumbra {

// One line per technique, in the order in which they are listed and reported.
Registry all_techniques() {
  return {
      ray_tracing_technique(),
      shadow_map_technique(),
      shadow_map_per_sample_technique(),
      planar_shadow_technique(),
      stencil_shadow_volume_technique(),
      stencil_shadow_volume_per_sample_technique(),
      alias_free_shadow_map_technique(),
      sample_based_soft_technique(),
      soft_shadow_volume_technique(),
      gears_technique(),
      depth_complexity_sampling_technique(),
      line_space_technique(),
  };
}

}  // namespace penumbra
