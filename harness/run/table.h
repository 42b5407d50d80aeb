// The table that ends a run.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "run/results.h"

namespace penumbra::run {

// One line per point: technique, scene, the parameters that differ between points, status or time with its
// interval, and the errors.
std::string table(const RecordSource& source);

}  // namespace penumbra::run
