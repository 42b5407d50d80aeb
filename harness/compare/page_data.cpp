#include <algorithm>

#include "compare/output.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;

// Beyond this number only judged findings go into the page: a browser has to hold them all.
constexpr std::size_t most_findings = 100000;

json images_of(const RunResults& results, std::optional<std::size_t> point) {
  if (!point || results.folder.empty()) return json::object();
  return results.points[*point].value("images", json::object());
}

json header(const RunResults& results) {
  json out = {{"name", results.name}};
  for (const char* key : {"started", "cpu", "vulkan", "os", "program", "complete", "machines"})
    if (results.run.contains(key)) out[key] = results.run.at(key);
  return out;
}

std::string status_of(const RunResults& results, std::optional<std::size_t> point) {
  return point ? results.points[*point].at("status").get<std::string>() : "missing";
}

}  // namespace

json page_data(const Comparison& c, const RunResults& baseline, const RunResults& current) {
  json data = to_json(c);
  data["runs"] = {{"baseline", header(baseline)}, {"current", header(current)}};
  data["all_findings"] = c.findings.size() <= most_findings;
  data["images"] = json::array();
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const ComparedPoint& p = c.points[i];
    json& out = data["points"][i];
    out["params"] = p.params;
    out["status"] = status_of(current, p.current);
    out["baseline_status"] = status_of(baseline, p.baseline);
    data["images"].push_back(
        {{"baseline", images_of(baseline, p.baseline)}, {"current", images_of(current, p.current)}});
    if (data["all_findings"]) continue;
    json judged = json::array();
    for (json& f : out["findings"])
      if (f.at("verdict") != "unjudged") judged.push_back(std::move(f));
    out["findings"] = std::move(judged);
  }
  return data;
}

}  // namespace penumbra::compare
