// Several runs of one config as one result, whose unit of chance is the run.
#pragma once
#include <vector>

#include "compare/run_results.h"

namespace penumbra::compare {

// Each time's samples become the runs' medians, in the runs' order, so that what differs from run to run is
// what a test sees, and the share of other programs is the runs' median; errors and counters are the first
// run's. A point that is not ok in some run is that run's. Throws InputError when configs or machines differ,
// or a point is not in all runs.
RunResults pool(const std::vector<RunResults>& runs);

}  // namespace penumbra::compare
