// Baselines: results that are committed, and that later runs are held against.
#pragma once
#include <filesystem>
#include <string>

#include "compare/run_results.h"

namespace penumbra::compare {

// The text of a baseline: results.json's format, with what comparisons need and no more. Throws InputError
// when the run is unfinished, a shard, or has points that failed: a baseline with holes would call them
// missing forever.
std::string baseline_text(const RunResults& results);

}  // namespace penumbra::compare
