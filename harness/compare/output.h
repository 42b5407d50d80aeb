// A comparison for people, for programs and for CI servers.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "compare/comparison.h"

namespace penumbra::compare {

// One line for each point, the findings that are neither pass nor unjudged below it, and the sum.
std::string table(const Comparison& comparison);
// Every finding, also the unjudged ones.
nlohmann::json to_json(const Comparison& comparison);
// JUnit XML: a test suite for each technique, a test case for each judged metric of a point; what regressed,
// is ambiguous or missing is a failure of that type; a comparison of nothing is an error.
std::string junit_xml(const Comparison& comparison);

}  // namespace penumbra::compare
