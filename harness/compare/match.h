// Which point of one run is which of the other, and which points times are held against.
#pragma once
#include <vector>

#include "compare/run_results.h"
#include "compare/thresholds.h"

namespace penumbra::compare {

struct Pair {
  const nlohmann::json* baseline = nullptr;  // null: the point is new
  const nlohmann::json* current = nullptr;   // null: the point is missing
  std::string note;                          // how they were matched, where not by equality
};

// Points are the same when technique, scene, frame and parameters are. Those left over are matched when all
// parameters that both have agree and there is only one such on either side: a technique that was given a new
// parameter keeps its baseline. In the baseline's order, new points last.
std::vector<Pair> match(const RunResults& baseline, const RunResults& current);

// The anchor of each pair (null where there is none): a pair of the anchor's technique, ok in both runs, same
// scene and frame, and the same value of each shared parameter (resolution, light, camera, light size, light
// samples, seed) that both have; of several the one that was fastest in the baseline.
std::vector<const Pair*> anchors(const std::vector<Pair>& pairs, const Thresholds& thresholds);

}  // namespace penumbra::compare
