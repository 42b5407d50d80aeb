// Two results against each other: a verdict for each point and metric.
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/run_results.h"
#include "compare/thresholds.h"

namespace penumbra::compare {

enum class Verdict {
  pass,
  improved,
  regressed,
  ambiguous,  // a time beyond its factor that may be chance, or the work of other programs
  missing,    // the baseline has it, the current run has not
  added,      // the current run has it, the baseline has not: reported only
  unjudged    // no rule, or none that holds between these machines: reported only
};
const char* to_string(Verdict verdict);

struct Finding {
  std::size_t point = 0;  // in Comparison::points
  std::string metric;     // "status", or a figure's name
  Verdict verdict = Verdict::unjudged;
  std::optional<double> baseline, current;  // medians of times
  std::optional<double> ratio;  // current / baseline; of times held against an anchor: of the ratios
  std::optional<double> p;      // of times and pixels: probability of such a difference by chance, corrected
  bool against_anchor = false;
  std::string message;  // why, in words; of every verdict that is neither pass nor unjudged by lack of a rule
  std::string rule;     // its place
};

struct ComparedPoint {
  std::string key, technique, scene;
  nlohmann::json frame, params;
  double current_ms = 0;  // median frame time, 0 when there is none
  // Its records in RunResults::points of either run.
  std::optional<std::size_t> baseline, current;
};

struct Comparison {
  std::string baseline, current;  // names
  std::vector<ComparedPoint> points;
  std::vector<Finding> findings;     // in points' order, status first
  std::vector<std::string> remarks;  // what a reader should know: machines differ, rules that matched nothing
  std::string error;                 // nothing was compared, and why; the findings may be empty
  std::size_t count(Verdict verdict) const;
  bool bad() const;  // anything regressed, ambiguous or missing
};

struct CompareOptions {
  bool any_machine = false;  // judge times between different machines by the rules for one
};

Comparison compare(const RunResults& baseline, const RunResults& current, const Thresholds& thresholds,
                   const CompareOptions& options = {});

}  // namespace penumbra::compare
