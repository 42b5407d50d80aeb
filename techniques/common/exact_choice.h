// Which of the exact techniques on the host is expected to be the fastest, by one figure of a scene: the
// share of its edges that can be silhouettes for some point of the light (`potential_silhouette_share` among
// the counters of depth_complexity_sampling).
#pragma once
#include <string>
#include <vector>

namespace penumbra {

// Above this share depth_complexity_sampling's lists of edges are longer than lists of triangles would be.
inline constexpr double most_silhouettes = 0.6;

// A technique's name. `share` in [0, 1].
std::string expected_fastest(double share);

// The same in words, for `penumbra describe`.
std::vector<std::string> exact_choice_in_words();

}  // namespace penumbra
