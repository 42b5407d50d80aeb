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
// What a page about the comparison shows: to_json with each point's parameters, its status in both runs, and
// "images": for each point what the records of "baseline" and "current" name, relative to their runs; "runs"
// has their headers.
nlohmann::json page_data(const Comparison& comparison, const RunResults& baseline, const RunResults& current);
// JUnit XML: a test suite for each technique, a test case for each judged metric of a point; what regressed,
// is ambiguous or missing is a failure of that type; a comparison of nothing is an error.
std::string junit_xml(const Comparison& comparison);

}  // namespace penumbra::compare
