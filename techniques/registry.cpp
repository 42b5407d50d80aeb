#include "techniques/registry.h"

#include "techniques/gears/gears.h"
#include "techniques/ray_tracing/ray_tracing.h"
#include "techniques/shadow_map/shadow_map.h"

namespace penumbra {

// One line per technique, in the order in which they are listed and reported.
Registry all_techniques() {
  return {
      ray_tracing_technique(),
      shadow_map_technique(),
      gears_technique(),
  };
}

}  // namespace penumbra
