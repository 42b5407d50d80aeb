// The thresholds file: which metric of which points is judged, and by what.
#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/json_text.h"

namespace penumbra::compare {

struct Rule {
  std::string technique = "*", scene = "*", metric;  // * and ? stand for any characters, any one character
  std::map<std::string, nlohmann::json> params;      // each must be the point's
  std::optional<double> max, min;                    // of the current value
  std::optional<double> max_increase, max_decrease;  // from the baseline's
  std::optional<double> max_ratio;                   // current / baseline; of times: of ratios to the anchor
  std::optional<double> max_ratio_elsewhere;         // the same between different machines; times only
  std::string place;                                 // file:line:column, for messages
};

struct Thresholds {
  std::string anchor;                                   // technique; empty: times are judged as they are
  std::map<std::string, nlohmann::json> anchor_params;  // of that technique, where the run has several
  double significance = 0.002;  // probability of any false "regressed" or "improved" time in a comparison
  std::vector<Rule> rules;
};

// What names a rule may use; an empty list allows any.
struct KnownNames {
  std::vector<std::string> techniques, scenes, params;
};

// Throws InputError: place, what was found, what was expected, the nearest name.
Thresholds read_thresholds(const JsonDocument& document, const KnownNames& known);
// When there is no file: frame times by 10 % as they are, rmse by 0.001, mask bits by 1e-6, no pixel farther.
Thresholds default_thresholds();

// The rule for one metric of one point: the most specific of those that match, by params, then scene, then
// technique, then metric; of equally specific ones the later in the file. Null when there is none.
const Rule* rule_for(const Thresholds& thresholds, const nlohmann::json& point, const std::string& metric);

bool is_time(const std::string& metric);  // timing.*
bool matches_wildcard(const std::string& pattern, const std::string& text);

nlohmann::json thresholds_schema();

}  // namespace penumbra::compare
