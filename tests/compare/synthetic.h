// Runs made up for comparisons: points with given times and errors.
#pragma once
#include <string>
#include <vector>

#include "compare/run_results.h"
#include "compare/thresholds.h"

namespace penumbra::test {

nlohmann::json stat(const std::vector<double>& samples);
// An ok point of 8 x 8 light samples.
nlohmann::json point(const std::string& technique, const std::vector<double>& frame_ms, double rmse = 0.01,
                     double mask_bits_off = 0, const std::string& scene = "bunny");
nlohmann::json failed(nlohmann::json point, const std::string& status, const std::string& message);
compare::RunResults run_of(const std::vector<nlohmann::json>& points, const std::string& cpu = "A");
compare::Thresholds thresholds(const std::string& json, const compare::KnownNames& known = {});
// `count` times about `ms`, spread by 1 %.
std::vector<double> times(double ms, int count = 12, int seed = 1);

}  // namespace penumbra::test
