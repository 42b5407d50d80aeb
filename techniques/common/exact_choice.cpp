#include "techniques/common/exact_choice.h"

#include <fmt/format.h>

namespace penumbra {

std::string expected_fastest(double share) {
  return share <= most_silhouettes ? "depth_complexity_sampling" : "gears";
}

std::vector<std::string> exact_choice_in_words() {
  return {
      "ray_tracing, gears and depth_complexity_sampling give the same masks; which one is the fastest on the "
      "host is told by the share of a mesh's edges that can be silhouettes, counter "
      "potential_silhouette_share of depth_complexity_sampling (one frame is enough).",
      fmt::format(
          "Share up to {}: depth_complexity_sampling. Closed meshes have 0.15 to 0.45, whatever their "
          "number of triangles.",
          most_silhouettes),
      fmt::format("Share above {} (soups, where every edge is open: 1): gears with backend=cpu and "
                  "assignment=clusters.",
                  most_silhouettes),
      "One light sample per view sample: ray_tracing. Directional lights: ray_tracing or gears."};
}

}  // namespace penumbra
