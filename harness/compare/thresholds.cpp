#include "compare/thresholds.h"

#include <algorithm>
#include <tuple>

namespace penumbra::compare {
namespace {

using nlohmann::json;

const std::vector<std::string> conditions = {"max",          "min",       "max_increase",
                                             "max_decrease", "max_ratio", "max_ratio_elsewhere"};

// Groups of metrics whose members techniques name themselves end in a dot.
const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {
        "timing.frame_ms",        "timing.build_ms",     "timing.setup_ms",        "timing.wall_ms",
        "timing.cpu_ms",          "memory.device_bytes", "memory.host_peak_bytes", "timing.passes.",
        "memory.structure_bytes", "counters.",           "pixels.farther"};
    for (const char* name : {"mae", "rmse", "max", "psnr", "ssim", "flip", "bias", "acne", "leak", "flicker",
                             "evaluated_pixels", "reference_standard_error"})
      all.push_back(std::string("metrics.") + name);
    for (const char* zone : {"umbra", "penumbra", "lit"})
      for (const char* name : {"pixels", "mae", "bias"})
        all.push_back(std::string("metrics.zones.") + zone + '.' + name);
    for (const char* name : {"mae", "max", "pixels_off", "mask_bit_mismatch"})
      all.push_back(std::string("metrics_matched.") + name);
    return all;
  }();
  return names;
}

bool has_wildcard(const std::string& pattern) { return pattern.find_first_of("*?") != std::string::npos; }

void check_metric(const JsonNode& node) {
  const std::string metric = node.string();
  if (metric.empty()) node.fail("a metric");
  for (const std::string& name : metric_names()) {
    const bool group = name.back() == '.';
    if (group ? metric.starts_with(name) && metric.size() > name.size() : metric == name) return;
    if (has_wildcard(metric) && !group && matches_wildcard(metric, name)) return;
  }
  node.fail("a metric of a point's record", suggestion(metric, metric_names()));
}

std::string known_name(const JsonNode& node, const std::vector<std::string>& known, const std::string& what) {
  const std::string name = node.string();
  if (name.empty()) node.fail(what);
  if (known.empty()) return name;
  if (has_wildcard(name)) {
    if (std::ranges::none_of(known, [&](const auto& k) { return matches_wildcard(name, k); }))
      node.fail(what + " (the pattern matches none)", suggestion(name, known));
  } else if (std::ranges::find(known, name) == known.end()) {
    node.fail(what, suggestion(name, known));
  }
  return name;
}

std::map<std::string, json> read_params(const JsonNode& node, const KnownNames& known) {
  std::map<std::string, json> params;
  if (!node.is_object()) node.fail("an object of parameters");
  if (!known.params.empty()) node.allow_only(known.params, "the params of a rule");
  for (const auto& [name, value] : node.members()) params[name] = value.json();
  return params;
}

void read_conditions(const JsonNode& node, Rule& rule) {
  const auto value = [&](const char* key, double lo) -> std::optional<double> {
    const auto found = node.find(key);
    return found ? std::optional(found->number(lo)) : std::nullopt;
  };
  constexpr double any = -std::numeric_limits<double>::max();
  rule.max = value("max", any), rule.min = value("min", any);
  rule.max_increase = value("max_increase", 0), rule.max_decrease = value("max_decrease", 0);
  rule.max_ratio = value("max_ratio", 1), rule.max_ratio_elsewhere = value("max_ratio_elsewhere", 1);
  const bool other = rule.max || rule.min || rule.max_increase || rule.max_decrease;
  const bool ratio = rule.max_ratio || rule.max_ratio_elsewhere;
  if (!other && !ratio)
    node.complain("a rule without a condition judges nothing." + suggestion("", conditions));
  if (is_time(rule.metric) && other)
    node.complain(
        "times take max_ratio and max_ratio_elsewhere only: a limit in milliseconds holds on one machine.");
  if (rule.metric == "pixels.farther" &&
      (!rule.max || rule.min || ratio || rule.max_increase || rule.max_decrease))
    node.complain("pixels.farther takes max alone: the share of pixels that may be farther from the truth.");
  if (!is_time(rule.metric) && rule.max_ratio_elsewhere)
    node.complain("max_ratio_elsewhere is for times (timing.*); '" + rule.metric + "' takes max_ratio.");
}

Rule read_rule(const JsonNode& node, const KnownNames& known) {
  std::vector<std::string> keys = conditions;
  keys.insert(keys.end(), {"technique", "scene", "metric", "params", "reason"});
  node.allow_only(keys, "a threshold");
  Rule rule;
  rule.place = node.location();
  if (const auto n = node.find("technique")) rule.technique = known_name(*n, known.techniques, "a technique");
  if (const auto n = node.find("scene")) rule.scene = known_name(*n, known.scenes, "a scene");
  if (const auto n = node.find("params")) rule.params = read_params(*n, known);
  if (const auto n = node.find("reason")) n->string();
  const JsonNode metric = node.require("metric", "a threshold");
  check_metric(metric);
  rule.metric = metric.string();
  read_conditions(node, rule);
  return rule;
}

void read_anchor(const JsonNode& node, const KnownNames& known, Thresholds& out) {
  if (!node.is_object()) {
    out.anchor = known_name(node, known.techniques, "a technique");
    return;
  }
  node.allow_only({"technique", "params"}, "the anchor");
  out.anchor = known_name(node.require("technique", "the anchor"), known.techniques, "a technique");
  if (const auto params = node.find("params")) out.anchor_params = read_params(*params, known);
}

// 0: any, 1: a pattern, 2: one name.
int specificity(const std::string& pattern) { return pattern == "*" ? 0 : has_wildcard(pattern) ? 1 : 2; }

bool applies(const Rule& rule, const json& point, const std::string& metric) {
  if (!matches_wildcard(rule.metric, metric) ||
      !matches_wildcard(rule.technique, point.at("technique").get_ref<const std::string&>()) ||
      !matches_wildcard(rule.scene, point.at("scene").get_ref<const std::string&>()))
    return false;
  const json& params = point.at("params");
  return std::ranges::all_of(
      rule.params, [&](const auto& p) { return params.contains(p.first) && params.at(p.first) == p.second; });
}

}  // namespace

bool is_time(const std::string& metric) { return metric.starts_with("timing."); }

bool matches_wildcard(const std::string& pattern, const std::string& text) {
  std::size_t p = 0, t = 0, star = std::string::npos, after_star = 0;
  while (t < text.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p, ++t;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++, after_star = t;
    } else if (star != std::string::npos) {  // let the last star take one character more
      p = star + 1, t = ++after_star;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

Thresholds read_thresholds(const JsonDocument& document, const KnownNames& known) {
  const JsonNode root = document.root();
  root.allow_only({"$schema", "description", "anchor", "significance", "thresholds"}, "a thresholds file");
  Thresholds out;
  if (const auto n = root.find("anchor")) read_anchor(*n, known, out);
  if (const auto n = root.find("significance")) out.significance = n->number(1e-9, 0.5);
  for (const JsonNode& rule : root.require("thresholds", "a thresholds file").items())
    out.rules.push_back(read_rule(rule, known));
  if (out.rules.empty()) root.complain("no thresholds: nothing would be judged.");
  return out;
}

Thresholds default_thresholds() {
  Thresholds out;
  const auto rule = [&](const char* metric) -> Rule& {
    out.rules.emplace_back().metric = metric;
    out.rules.back().place = "built in";
    return out.rules.back();
  };
  rule("timing.frame_ms").max_ratio = 1.1;
  rule("metrics.rmse").max_increase = 0.001;
  rule("metrics_matched.mask_bit_mismatch").max_increase = 1e-6;
  rule("pixels.farther").max = 0;
  return out;
}

const Rule* rule_for(const Thresholds& thresholds, const json& point, const std::string& metric) {
  const Rule* best = nullptr;
  using Key = std::tuple<std::size_t, int, int, int>;
  Key best_key{};
  for (const Rule& rule : thresholds.rules) {
    if (!applies(rule, point, metric)) continue;
    const Key key{rule.params.size(), specificity(rule.scene), specificity(rule.technique),
                  specificity(rule.metric)};
    if (!best || key >= best_key) best = &rule, best_key = key;
  }
  return best;
}

json thresholds_schema() {
  const auto number = [](double lo) { return json{{"type", "number"}, {"minimum", lo}}; };
  const json name = {{"type", "string"}, {"minLength", 1}}, params = {{"type", "object"}};
  json any = json::array();
  for (const std::string& condition : conditions) any.push_back(json{{"required", json::array({condition})}});
  const json rule = {{"type", "object"},
                     {"properties",
                      {{"technique", name},
                       {"scene", name},
                       {"metric",
                        {{"type", "string"},
                         {"pattern", "^[a-z*?]"},
                         {"description", "As in a point's record, with dots; * and ? are wildcards."}}},
                       {"params", params},
                       {"reason", {{"type", "string"}}},
                       {"max", {{"type", "number"}}},
                       {"min", {{"type", "number"}}},
                       {"max_increase", number(0)},
                       {"max_decrease", number(0)},
                       {"max_ratio", number(1)},
                       {"max_ratio_elsewhere", number(1)}}},
                     {"additionalProperties", false},
                     {"required", json::array({"metric"})},
                     {"anyOf", any}};
  const json anchor = {{"anyOf", json::array({name,
                                              {{"type", "object"},
                                               {"properties", {{"technique", name}, {"params", params}}},
                                               {"required", json::array({"technique"})},
                                               {"additionalProperties", false}}})}};
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "Penumbra thresholds"},
          {"type", "object"},
          {"properties",
           {{"$schema", {{"type", "string"}}},
            {"description", {{"type", "string"}}},
            {"anchor", anchor},
            {"significance", {{"type", "number"}, {"minimum", 1e-9}, {"maximum", 0.5}}},
            {"thresholds", {{"type", "array"}, {"items", rule}, {"minItems", 1}}}}},
          {"additionalProperties", false},
          {"required", json::array({"thresholds"})}};
}

}  // namespace penumbra::compare
