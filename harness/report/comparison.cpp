#include "report/comparison.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "report/files.h"
#include "report/page.h"
#include "report/pictures.h"

namespace penumbra {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// One run's pictures under out/<side>/, as write_pictures returns them, with paths relative to `out`.
json side_pictures(const json& images, const std::string& side, const fs::path& run, const fs::path& out,
                   ReportSummary& summary) {
  json points = json::array();
  for (const json& both : images)
    points.push_back({{"images", run.empty() ? json::object() : both.at(side)}});
  std::size_t files = 0;
  json pictures = write_pictures(run, out / side, points, files, summary.warnings, Reuse::nothing);
  summary.pictures += files;
  for (json& point : pictures)
    for (json& path : point) path = side + '/' + path.get<std::string>();
  return pictures;
}

json without_findings(json data) {
  data.erase("points"), data.erase("images");
  return data;
}

}  // namespace

ReportSummary write_comparison_report(json data, const fs::path& baseline, const fs::path& current,
                                      const fs::path& out) {
  report::make_folder(out);
  ReportSummary summary;
  summary.index = out / "index.html";
  summary.points = data.at("points").size();
  json pictures = json::array();
  try {
    const json before = side_pictures(data.at("images"), "baseline", baseline, out, summary);
    const json now = side_pictures(data.at("images"), "current", current, out, summary);
    const json differences =
        write_differences(data.at("images"), baseline, current, out, summary.pictures, summary.warnings);
    for (std::size_t i = 0; i < before.size(); ++i)
      pictures.push_back({{"baseline", before[i]}, {"current", now[i]}, {"difference", differences[i]}});
  } catch (const fs::filesystem_error& e) {
    throw WriteError(e.what());
  }
  const std::string name = fmt::format("{} against {}", data.at("current").get<std::string>(),
                                       data.at("baseline").get<std::string>());
  report::write_text(out / "assets" / "data.js", data_script({{"name", name},
                                                              {"comparison", without_findings(data)},
                                                              {"points", std::move(data.at("points"))},
                                                              {"pictures", std::move(pictures)},
                                                              {"warnings", summary.warnings}}));
  report::write_text(out / "assets" / "report.js", comparison_script());
  report::write_text(out / "assets" / "report.css", report_style());
  report::write_text(summary.index, comparison_html(name));
  return summary;
}

}  // namespace penumbra
