// The report: one folder that shows a finished (or interrupted) run in a browser, from disk, without a
// network.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

struct ReportSummary {
  std::filesystem::path index;  // DIR/index.html
  std::size_t points = 0;
  std::size_t pictures = 0;           // picture files in the folder
  std::vector<std::string> warnings;  // pictures that are named in the results but cannot be shown
};

// Reads run/results.json - or, while it is not there yet, run/run.json and run/points.jsonl - and writes
// `out` (empty: run/report): index.html, assets/, images/. Pictures are copied or hard-linked, EXR ones
// converted to PNG, so the folder can be moved; ones that are up to date already are kept. Throws InputError
// when the results cannot be read, and when `out` holds an index.html that is not a report's; WriteError when
// the folder cannot be written.
ReportSummary write_report(const std::filesystem::path& run, const std::filesystem::path& out);

}  // namespace penumbra
