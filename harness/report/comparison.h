// The report of two runs side by side: verdicts, and both runs' pictures flicked in one place.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "report/report.h"

namespace penumbra {

// `data`: "baseline", "current" (names), "counts", "remarks", "error", "runs", and "points", each with
// "technique", "scene", "params", "status", "verdict" and "findings" [{ "metric", "verdict", ... }];
// "images": for each point { "baseline", "current" }, paths relative to the folders of the two runs. A folder
// that is empty has no pictures. Writes `out`, as write_report does: index.html, assets/, and the pictures of
// both runs and their differences.
ReportSummary write_comparison_report(nlohmann::json data, const std::filesystem::path& baseline,
                                      const std::filesystem::path& current, const std::filesystem::path& out);

}  // namespace penumbra
