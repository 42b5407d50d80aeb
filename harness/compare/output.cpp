#include "compare/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace penumbra::compare {
namespace {

using nlohmann::json;

bool is_bad(Verdict v) { return v == Verdict::regressed || v == Verdict::ambiguous || v == Verdict::missing; }
bool is_judged(Verdict v) { return v != Verdict::unjudged && v != Verdict::added; }

// What a point is called by the worst of its findings.
Verdict worst(const std::vector<const Finding*>& findings) {
  for (const Verdict v : {Verdict::missing, Verdict::regressed, Verdict::ambiguous, Verdict::improved,
                          Verdict::added, Verdict::pass})
    if (std::ranges::any_of(findings, [v](const Finding* f) { return f->verdict == v; })) return v;
  return Verdict::unjudged;
}

std::vector<std::vector<const Finding*>> by_point(const Comparison& c) {
  std::vector<std::vector<const Finding*>> out(c.points.size());
  for (const Finding& f : c.findings) out[f.point].push_back(&f);
  return out;
}

// Short names: technique, scene, frame, and the parameters that take several values in one technique.
std::vector<std::string> labels(const std::vector<ComparedPoint>& points) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> values;
  for (const ComparedPoint& p : points)
    for (const auto& [name, value] : p.params.items()) values[p.technique][name].insert(value.dump());
  std::vector<std::string> out;
  for (const ComparedPoint& p : points) {
    std::string label = p.technique + "  " + p.scene;
    if (p.frame.is_null())
      label += "  all frames";
    else if (p.frame != 0)
      label += "  frame " + p.frame.dump();
    // A scene's own light size differs from scene to scene: that names no point.
    for (const auto& [name, value] : p.params.items())
      if (values[p.technique][name].size() > 1 && name != "light_size")
        label += "  " + name + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
    out.push_back(label);
  }
  return out;
}

std::string time_text(const std::vector<const Finding*>& findings) {
  for (const Finding* f : findings)
    if (f->metric == "timing.frame_ms" && f->ratio)
      return fmt::format("{:.3f} -> {:.3f} ms, {} {:.3f}", *f->baseline, *f->current,
                         f->against_anchor ? "as multiple of the anchor's: times" : "times", *f->ratio);
  return "";
}

std::string sum_text(const Comparison& c) {
  std::string text;
  for (const Verdict v :
       {Verdict::pass, Verdict::improved, Verdict::regressed, Verdict::ambiguous, Verdict::missing})
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", c.count(v), to_string(v));
  return text + fmt::format("; {} figures reported without a rule, {} new points", c.count(Verdict::unjudged),
                            c.count(Verdict::added));
}

json optional_json(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json();
}

// Text of an attribute or element: what XML forbids is shown as a question mark.
std::string xml(const std::string& text) {
  // Foreign bytes that are no UTF-8 are replaced as in result files.
  const std::string quoted = json(text).dump(-1, ' ', false, json::error_handler_t::replace);
  std::string out;
  for (const char c : json::parse(quoted).get<std::string>()) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\n')
      out += "&#10;";
    else
      out += static_cast<unsigned char>(c) < 0x20 && c != '\t' ? '?' : c;
  }
  return out;
}

std::string test_case(const ComparedPoint& point, const Finding& f) {
  std::string out = fmt::format("    <testcase classname=\"{}.{}\" name=\"{} {}\" time=\"{:.6f}\"",
                                xml(point.technique), xml(point.scene), xml(point.key), xml(f.metric),
                                f.metric == "timing.frame_ms" ? point.current_ms * 1e-3 : 0.0);
  if (!is_bad(f.verdict)) return out + "/>\n";
  return out + fmt::format(">\n      <failure type=\"{}\" message=\"{}\">{}</failure>\n    </testcase>\n",
                           to_string(f.verdict), xml(f.message),
                           xml("rule: " + (f.rule.empty() ? "status" : f.rule)));
}

}  // namespace

std::string table(const Comparison& c) {
  std::string text = fmt::format("baseline {}\ncurrent  {}\n", c.baseline, c.current);
  const auto findings = by_point(c);
  const std::vector<std::string> names = labels(c.points);
  std::size_t width = 0;
  for (const std::string& name : names) width = std::max(width, name.size());
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    text += fmt::format("{:<9}  {:<{}}  {}\n", to_string(worst(findings[i])), names[i], width,
                        time_text(findings[i]));
    for (const Finding* f : findings[i])
      if (is_bad(f->verdict) || f->verdict == Verdict::improved)
        text += fmt::format("{:11}{}: {}: {}{}\n", "", to_string(f->verdict), f->metric, f->message,
                            f->rule.empty() ? "" : " [" + f->rule + "]");
  }
  for (const std::string& remark : c.remarks) text += fmt::format("note: {}\n", remark);
  if (!c.error.empty()) text += fmt::format("error: {}\n", c.error);
  return text + sum_text(c) + "\n";
}

json to_json(const Comparison& c) {
  json points = json::array();
  for (const ComparedPoint& p : c.points)
    points.push_back({{"key", p.key},
                      {"technique", p.technique},
                      {"scene", p.scene},
                      {"frame", p.frame},
                      {"findings", json::array()}});
  for (const Finding& f : c.findings) {
    json out = {{"metric", f.metric},
                {"verdict", to_string(f.verdict)},
                {"baseline", optional_json(f.baseline)},
                {"current", optional_json(f.current)}};
    if (f.ratio) out["ratio"] = optional_json(f.ratio);
    if (f.p) out["p"] = optional_json(f.p);
    if (f.against_anchor) out["against_anchor"] = true;
    if (!f.message.empty()) out["message"] = f.message;
    if (!f.rule.empty()) out["rule"] = f.rule;
    points[f.point]["findings"].push_back(out);
  }
  const auto findings = by_point(c);
  for (std::size_t i = 0; i < c.points.size(); ++i) points[i]["verdict"] = to_string(worst(findings[i]));
  json counts = json::object();
  for (const Verdict v : {Verdict::pass, Verdict::improved, Verdict::regressed, Verdict::ambiguous,
                          Verdict::missing, Verdict::added, Verdict::unjudged})
    counts[to_string(v)] = c.count(v);
  return {{"schema_version", 1},
          {"baseline", c.baseline},
          {"current", c.current},
          {"bad", c.bad()},
          {"counts", counts},
          {"remarks", c.remarks},
          {"error", c.error.empty() ? json() : json(c.error)},
          {"points", points}};
}

std::string junit_xml(const Comparison& c) {
  struct Suite {
    std::string cases;
    std::size_t tests = 0, failures = 0;
  };
  std::map<std::string, Suite> suites;
  std::size_t tests = 0, failures = 0;
  for (const Finding& f : c.findings) {
    if (!is_judged(f.verdict)) continue;
    Suite& suite = suites[c.points[f.point].technique];
    suite.cases += test_case(c.points[f.point], f);
    ++suite.tests, ++tests;
    suite.failures += is_bad(f.verdict), failures += is_bad(f.verdict);
  }
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"penumbra compare\" tests=\"{}\" "
      "failures=\"{}\" "
      "errors=\"{}\">\n",
      tests + !c.error.empty(), failures, c.error.empty() ? 0 : 1);
  if (!c.error.empty())
    text += fmt::format(
        "  <testsuite name=\"compare\" tests=\"1\" failures=\"0\" errors=\"1\">\n    <testcase "
        "classname=\"compare\" "
        "name=\"compare\">\n      <error type=\"error\" message=\"{}\"/>\n    </testcase>\n  </testsuite>\n",
        xml(c.error));
  for (const auto& [name, suite] : suites)
    text +=
        fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\">\n{}  </testsuite>\n",
                    xml(name), suite.tests, suite.failures, suite.cases);
  return text + "</testsuites>\n";
}

}  // namespace penumbra::compare
