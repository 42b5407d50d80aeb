#include "run/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "run/processors.h"

namespace penumbra::run {
namespace {

using nlohmann::json;

std::string short_text(const json& value) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_array() && value.size() == 2) return short_text(value[0]) + "x" + short_text(value[1]);
  return value.dump();
}

std::string number(const json& object, const char* name, const char* format) {
  if (!object.is_object() || !object.contains(name) || !object[name].is_number()) return "-";
  return fmt::format(fmt::runtime(format), object[name].get<double>());
}

// Names of parameters that take more than one value among the points of one technique.
std::map<std::string, std::set<std::string>> varying_params(const RecordSource& source) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> values;
  source([&](const json& point) {
    for (const auto& [name, value] : point.at("params").items())
      values[point.at("technique")][name].insert(value.dump());
  });
  std::map<std::string, std::set<std::string>> varying;
  for (const auto& [technique, params] : values)
    for (const auto& [name, seen] : params)
      if (seen.size() > 1) varying[technique].insert(name);
  return varying;
}

std::string outcome(const json& point) {
  if (point.at("status") != "ok") {
    std::string message = point.value("message", "");
    message = message.substr(0, message.find('\n'));
    if (message.size() > 72) message = message.substr(0, 69) + "...";
    return fmt::format("{}: {}", point.at("status").get<std::string>(), message);
  }
  const json& frame = point.at("timing").at("frame_ms");
  const json build = point.at("timing").value("build_ms", json());
  const json metrics = point.value("metrics", json()), matched = point.value("metrics_matched", json());
  return fmt::format("{:>9.3f} [{:.3f}, {:.3f}]  build {:>8}  rmse {:>8}  flip {:>7}  mask bits off {}",
                     frame.at("median").get<double>(), frame.at("ci95")[0].get<double>(),
                     frame.at("ci95")[1].get<double>(), number(build, "median", "{:.2f}"),
                     number(metrics, "rmse", "{:.5f}"), number(metrics, "flip", "{:.4f}"),
                     number(matched, "mask_bit_mismatch", "{:.2g}"));
}

// What speaks against the times: points whose times drifted or were not repeatable, other programs beside
// them.
class Doubts {
 public:
  void look_at(const json& point, const std::string& name) {
    if (point.at("status") != "ok" || point.at("frame").is_null()) return;
    const json& timing = point.at("timing");
    if (timing.value("drifts", false)) add(drifting_, name, timing.value("drift", 0.0));
    if (!timing.value("repeatable", true)) add(changing_, name, 0);
    if (const json share = point.value("other_programs", json()); share.is_number())
      busiest_ = std::max(busiest_, share.get<double>());
  }
  std::string text() const {
    std::string text;
    if (drifting_.count > 0)
      text += fmt::format("note: times drifted while they were taken, in {} points; most in {}: {:+.0f} %\n",
                          drifting_.count, drifting_.name, 100 * drifting_.most);
    if (changing_.count > 0)
      text += fmt::format("note: the output changes from frame to frame in {} points, first in {}\n",
                          changing_.count, changing_.name);
    if (busiest_ > busy_share)
      text += fmt::format("note: other programs used up to {:.0f} % of the processors meanwhile\n",
                          100 * busiest_);
    return text;
  }

 private:
  struct Worst {
    int count = 0;
    std::string name;
    double most = 0;
  };
  static void add(Worst& worst, const std::string& name, double size) {
    if (worst.count++ == 0 || std::abs(size) > std::abs(worst.most)) worst.name = name, worst.most = size;
  }
  Worst drifting_, changing_;
  double busiest_ = 0;
};

}  // namespace

std::string table(const RecordSource& source) {
  const auto varying = varying_params(source);
  struct Line {
    std::string name, outcome;
  };
  std::vector<Line> lines;
  Doubts doubts;
  source([&](const json& point) {
    std::string name = point.at("technique").get<std::string>() + "  " + point.at("scene").get<std::string>();
    if (point.at("frame").is_null())
      name += "  all frames";
    else if (point.at("frame") != 0)
      name += fmt::format("  frame {}", point.at("frame").get<int>());
    if (const auto it = varying.find(point.at("technique")); it != varying.end())
      for (const std::string& param : it->second)
        if (point.at("params").contains(param))
          name += "  " + param + "=" + short_text(point["params"][param]);
    doubts.look_at(point, name);
    lines.push_back({name, outcome(point)});
  });
  std::size_t width = 0;
  for (const Line& l : lines) width = std::max(width, l.name.size());
  std::string text = fmt::format("{:<{}}  {}\n", "point", width, "frame ms, median [95 % interval]");
  for (const Line& l : lines) text += fmt::format("{:<{}}  {}\n", l.name, width, l.outcome);
  return text + doubts.text();
}

}  // namespace penumbra::run
