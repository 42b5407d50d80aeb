#include "compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "compare/match.h"
#include "compare/pixels.h"
#include "compare/significance.h"
#include "core/machine.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;
using Figures = std::map<std::string, json>;

// Beyond it times tell of the neighbours; the table and the report of a run warn of the same share.
constexpr double disturbing_share = 0.1;

std::vector<double> samples_of(const json& stat) { return stat.at("samples").get<std::vector<double>>(); }

// PSNR of equal images has no value in JSON; here it is the best there is.
std::optional<double> quality_value(const Figures& figures, const std::string& metric) {
  if (const auto value = number_at(figures, metric)) return value;
  if (metric == "metrics.psnr" && number_at(figures, "metrics.rmse") == 0.0) return INFINITY;
  return std::nullopt;
}

class Judge {
 public:
  Judge(const RunResults& baseline, const RunResults& current, const Thresholds& thresholds,
        const CompareOptions& options)
      : baseline_(baseline), current_(current), thresholds_(thresholds), options_(options) {
    out_.baseline = baseline.name, out_.current = current.name;
  }

  Comparison judge() {
    const std::vector<Pair> pairs = match(baseline_, current_);
    const std::vector<const Pair*> anchor_of = anchors(pairs, thresholds_);
    for (std::size_t i = 0; i < pairs.size(); ++i) judge_pair(pairs[i], anchor_of[i]);
    judge_times();
    judge_pixel_checks(pixel_checks_, thresholds_.significance, out_.findings);
    remark(pairs);
    out_.error = error(pairs);
    return std::move(out_);
  }

 private:
  // A time whose verdict waits for the correction by the number of all.
  struct TimeTest {
    std::size_t finding;
    double limit, slower, faster;
    std::size_t n, m;
    double others;  // the largest share of the processors that other programs had in one of the measurements
  };

  static std::optional<std::size_t> place(const RunResults& results, const json* point) {
    if (!point) return std::nullopt;
    return static_cast<std::size_t>(point - results.points.data());
  }

  Finding& add(const std::string& metric, Verdict verdict, const std::string& message = "") {
    Finding& f = out_.findings.emplace_back();
    f.point = out_.points.size() - 1;
    f.metric = metric, f.verdict = verdict, f.message = message;
    return f;
  }

  void judge_pair(const Pair& pair, const Pair* anchor) {
    const json& any = pair.current ? *pair.current : *pair.baseline;
    out_.points.push_back({any.value("key", any.at("id").get<std::string>()), any.at("technique"),
                           any.at("scene"), any.at("frame"), any.at("params"), 0,
                           place(baseline_, pair.baseline), place(current_, pair.current)});
    if (!pair.baseline) {
      add("status", Verdict::added, "the baseline has no such point");
      return;
    }
    if (!pair.current) {
      add("status", Verdict::missing, "the current run has no such point");
      return;
    }
    if (!judge_status(pair)) return;
    const Figures before = figures(*pair.baseline), now = figures(*pair.current);
    if (const auto time = now.find("timing.frame_ms"); time != now.end() && !samples_of(time->second).empty())
      out_.points.back().current_ms = median(samples_of(time->second));
    std::set<std::string> names;
    for (const auto* side : {&before, &now})
      for (const auto& [name, value] : *side) names.insert(name);
    for (const std::string& name : names) {
      if (is_time(name))
        judge_time(pair, anchor, name, before, now);
      else
        judge_quality(pair, name, quality_value(before, name), quality_value(now, name));
    }
    prepare_pixels(pair);
  }

  // True when both have figures that can be compared.
  bool judge_status(const Pair& pair) {
    const std::string before = pair.baseline->at("status"), now = pair.current->at("status");
    const std::string why = pair.current->value("message", "");
    if (before == "ok" && now == "ok") {
      add("status", Verdict::pass, pair.note);
      return true;
    }
    if (now == "ok") {
      add("status", Verdict::improved, fmt::format("was {}, is ok", before));
    } else if (before == "ok") {
      add("status", Verdict::regressed, fmt::format("was ok, is {}: {}", now, why));
    } else if (now == "unsupported" && before == "unsupported") {
      add("status", Verdict::pass, "unsupported in both");
    } else {
      add("status", Verdict::missing, fmt::format("nothing to compare: was {}, is {}: {}", before, now, why));
    }
    return false;
  }

  const Rule* rule(const Pair& pair, const std::string& metric) {
    const Rule* r = rule_for(thresholds_, *pair.current, metric);
    if (r) used_.insert(r);
    return r;
  }

  void judge_quality(const Pair& pair, const std::string& metric, std::optional<double> before,
                     std::optional<double> now) {
    const Rule* r = rule(pair, metric);
    Finding& f = add(metric, Verdict::unjudged);
    f.baseline = before, f.current = now;
    if (before && now && *before > 0) f.ratio = *now / *before;
    if (!r) return;
    f.rule = r->place;
    if (!now) {
      f.verdict = before ? Verdict::missing : Verdict::pass;
      f.message = before ? "has no value any more" : "has no value in either";
      return;
    }
    f.message = limits_broken(*r, before, *now);
    f.verdict = !f.message.empty()         ? Verdict::regressed
                : better(*r, before, *now) ? Verdict::improved
                                           : Verdict::pass;
    if (f.verdict == Verdict::improved) f.message = fmt::format("{:.6g}, was {:.6g}", *now, *before);
  }

  static std::string limits_broken(const Rule& r, std::optional<double> before, double now) {
    std::string text;
    const auto broken = [&](bool is, const std::string& what) {
      if (is) text += (text.empty() ? "" : "; ") + what;
    };
    broken(r.max && now > *r.max, fmt::format("{:.6g} is above {:.6g}", now, r.max.value_or(0)));
    broken(r.min && now < *r.min, fmt::format("{:.6g} is below {:.6g}", now, r.min.value_or(0)));
    if (!before) return text;
    broken(r.max_increase && now > *before + *r.max_increase,
           fmt::format("{:.6g} is more than {:.3g} above {:.6g}", now, r.max_increase.value_or(0), *before));
    broken(r.max_decrease && now < *before - *r.max_decrease,
           fmt::format("{:.6g} is more than {:.3g} below {:.6g}", now, r.max_decrease.value_or(0), *before));
    broken(r.max_ratio && now > *before * *r.max_ratio,
           fmt::format("{:.6g} is more than {:.3g} times {:.6g}", now, r.max_ratio.value_or(0), *before));
    return text;
  }

  // As far beyond the baseline on the good side as would have been a regression on the other.
  static bool better(const Rule& r, std::optional<double> before, double now) {
    if (!before) return false;
    return (r.max_increase && now < *before - *r.max_increase) ||
           (r.max_decrease && now > *before + *r.max_decrease) ||
           (r.max_ratio && now * *r.max_ratio < *before);
  }

  void judge_time(const Pair& pair, const Pair* anchor, const std::string& metric, const Figures& before,
                  const Figures& now) {
    // A sequence's summary has frames' medians as samples: they tell of the animation, not of the clock.
    const Rule* r = pair.current->at("frame").is_null() ? nullptr : rule(pair, metric);
    Finding& f = add(metric, Verdict::unjudged);
    if (r) f.rule = r->place;
    const auto b = before.find(metric), c = now.find(metric);
    if (b != before.end() && !samples_of(b->second).empty()) f.baseline = median(samples_of(b->second));
    if (c != now.end() && !samples_of(c->second).empty()) f.current = median(samples_of(c->second));
    if (!f.baseline || !f.current) {
      if (r) f.verdict = f.baseline ? Verdict::missing : Verdict::added;
      f.message = f.baseline ? "was not measured any more" : "the baseline has no such time";
      return;
    }
    if (*f.baseline > 0) f.ratio = *f.current / *f.baseline;
    if (r) prepare_test(pair, anchor, *r, samples_of(b->second), samples_of(c->second), f);
  }

  void prepare_test(const Pair& pair, const Pair* anchor, const Rule& r, std::vector<double> before,
                    std::vector<double> now, Finding& f) {
    if (!thresholds_.anchor.empty() && !hold_against(pair, anchor, before, now, f)) return;
    const std::optional<double> limit = limit_between(pair, r, f);
    if (!limit) return;
    double others = std::max(others_beside(*pair.baseline), others_beside(*pair.current));
    if (f.against_anchor)
      others = std::max({others, others_beside(*anchor->baseline), others_beside(*anchor->current)});
    tests_.push_back({static_cast<std::size_t>(&f - out_.findings.data()), *limit,
                      mann_whitney_greater(before, now), mann_whitney_greater(now, before), before.size(),
                      now.size(), others});
  }

  static double others_beside(const json& point) {
    const auto share = point.find("other_programs");
    return share != point.end() && share->is_number() ? share->get<double>() : 0;
  }

  // Turns both times into multiples of the anchor's; false when there is nothing to be judged.
  bool hold_against(const Pair& pair, const Pair* anchor, std::vector<double>& before,
                    std::vector<double>& now, Finding& f) {
    if (!anchor) {
      f.verdict = Verdict::missing;
      f.message =
          fmt::format("no point of the anchor {} in both runs with the same scene, frame and light samples",
                      thresholds_.anchor);
      return false;
    }
    if (anchor->current == pair.current) {
      f.message = "is the anchor";
      return false;
    }
    // Processor time is a multiple of processor time, every other time of the frame's.
    const auto anchor_samples = [&f](const json& point) {
      const json& timing = point.at("timing");
      return f.metric == "timing.cpu_ms" && timing.contains("cpu_ms") ? samples_of(timing.at("cpu_ms"))
                                                                      : samples_of(timing.at("frame_ms"));
    };
    before = ratio_samples(before, anchor_samples(*anchor->baseline));
    now = ratio_samples(now, anchor_samples(*anchor->current));
    f.against_anchor = true;
    f.ratio.reset();
    if (before.empty() || now.empty()) {
      f.verdict = Verdict::missing;
      f.message = "the anchor has no time to divide by";
      return false;
    }
    if (const double m = median(before); m > 0) f.ratio = median(now) / m;
    return true;
  }

  std::optional<double> limit_between(const Pair& pair, const Rule& r, Finding& f) {
    const json a = baseline_.machine(*pair.baseline), b = current_.machine(*pair.current);
    if (options_.any_machine || machine_fingerprint(a) == machine_fingerprint(b)) {
      if (!r.max_ratio) f.message = "the rule has no max_ratio for one machine";
      return r.max_ratio;
    }
    differing_.insert(machine_difference(a, b));
    if (f.against_anchor && r.max_ratio_elsewhere) return r.max_ratio_elsewhere;
    f.message = "measured on another machine than the baseline";
    return std::nullopt;
  }

  // Significance *and* factor, each test corrected for the number of all.
  void judge_times() {
    std::vector<double> slower, faster;
    for (const TimeTest& t : tests_) slower.push_back(t.slower), faster.push_back(t.faster);
    slower = holm(slower), faster = holm(faster);
    for (std::size_t i = 0; i < tests_.size(); ++i)
      judge_time_test(tests_[i], slower[i], faster[i], out_.findings[tests_[i].finding]);
  }

  void judge_time_test(const TimeTest& t, double slower, double faster, Finding& f) {
    // A time of 0 that stays 0 has no ratio.
    const double ratio = f.ratio.value_or(*f.current > 0 ? INFINITY : 1);
    const double alpha = thresholds_.significance;
    f.p = std::min(slower, faster);
    f.verdict = Verdict::pass;
    const std::string of =
        f.against_anchor ? fmt::format(" of its ratio to {}", thresholds_.anchor) : std::string();
    const bool disturbed = t.others > disturbing_share;
    const std::string meanwhile =
        fmt::format("; meanwhile other programs had {:.0f} % of the processors", 100 * t.others);
    if (disturbed && ((ratio > t.limit && slower <= alpha) || (ratio < 1 / t.limit && faster <= alpha))) {
      // Techniques lose unlike parts of their speed to a neighbour, of processor time too: no ratio forgives
      // it.
      f.verdict = ratio > 1 ? Verdict::ambiguous : Verdict::pass;
      f.message = fmt::format("{:.3f} times the baseline{} (p = {:.2g}){}", ratio, of,
                              std::min(slower, faster), meanwhile);
    } else if (ratio > t.limit && slower <= alpha) {
      f.verdict = Verdict::regressed;
      f.message = fmt::format("{:.3f} times the baseline{}, more than {:.3f} (p = {:.2g})", ratio, of,
                              t.limit, slower);
    } else if (ratio > t.limit) {
      f.verdict = Verdict::ambiguous;
      f.message =
          fmt::format("{:.3f} times the baseline{}, more than {:.3f}, but this may be chance (p = {:.2g}){}",
                      ratio, of, t.limit, slower, too_few(t));
    } else if (ratio < 1 / t.limit && faster <= alpha) {
      f.verdict = Verdict::improved;
      f.message = fmt::format("{:.3f} times the baseline{} (p = {:.2g})", ratio, of, faster);
    }
  }

  void prepare_pixels(const Pair& pair) {
    if (!has_pixels(baseline_, *pair.baseline, current_, *pair.current)) return;
    const Rule* r = rule(pair, "pixels.farther");
    Finding& f = add("pixels.farther", Verdict::unjudged);
    if (!r || !r->max) return;
    f.rule = r->place;
    PixelOutcome outcome = judge_pixels(baseline_, *pair.baseline, current_, *pair.current);
    f.message = outcome.why_not;
    if (outcome.why_not.empty())
      pixel_checks_.push_back({out_.findings.size() - 1, std::move(outcome), *r->max});
  }

  std::string too_few(const TimeTest& t) const {
    const double wanted = thresholds_.significance / double(tests_.size());
    if (smallest_p(t.n, t.m) <= wanted) return "";
    std::size_t n = std::max(t.n, t.m);
    while (smallest_p(n, n) > wanted) ++n;
    return fmt::format("; {} and {} repetitions can show no more, {} each would", t.n, t.m, n);
  }

  void remark(const std::vector<Pair>& pairs) {
    for (const std::string& difference : differing_)
      out_.remarks.push_back(fmt::format("the machines differ, {}: {}.",
                                         thresholds_.anchor.empty()
                                             ? "times are reported, not judged"
                                             : "times are compared by anchor ratios only",
                                         difference));
    if (baseline_.run.value("complete", true) == false) out_.remarks.push_back("the baseline is unfinished.");
    if (current_.run.value("complete", true) == false)
      out_.remarks.push_back("the current run is unfinished.");
    remark_scenes();
    if (std::ranges::none_of(pairs, [](const Pair& p) { return p.baseline && p.current; })) return;
    for (const Rule& rule : thresholds_.rules)
      if (!used_.contains(&rule) && rule.place != "built in")
        out_.remarks.push_back(
            fmt::format("{}: the rule for {} judged nothing here.", rule.place, rule.metric));
  }

  void remark_scenes() {
    std::map<std::string, std::string> hashes;
    const auto scenes = [](const RunResults& r) { return r.run.value("scenes", json::array()); };
    for (const json& s : scenes(baseline_)) hashes[s.value("name", "")] = s.value("content_hash", "");
    for (const json& s : scenes(current_))
      if (const auto it = hashes.find(s.value("name", ""));
          it != hashes.end() && it->second != s.value("content_hash", ""))
        out_.remarks.push_back(fmt::format("the content of scene {} has changed.", it->first));
  }

  std::string error(const std::vector<Pair>& pairs) const {
    const auto is_ok = [](const json& p) { return p.at("status") == "ok"; };
    if (std::ranges::none_of(current_.points, is_ok))
      return fmt::format("{}: measured nothing: {} points, none of them ok.", current_.name,
                         current_.points.size());
    if (std::ranges::none_of(pairs, [](const Pair& p) { return p.baseline && p.current; }))
      return fmt::format("{}: the baseline has none of the points of {}.", baseline_.name, current_.name);
    return "";
  }

  const RunResults &baseline_, &current_;
  const Thresholds& thresholds_;
  const CompareOptions& options_;
  Comparison out_;
  std::vector<TimeTest> tests_;
  std::vector<PixelCheck> pixel_checks_;
  std::set<const Rule*> used_;
  std::set<std::string> differing_;
};

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::improved:
      return "improved";
    case Verdict::regressed:
      return "regressed";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::missing:
      return "missing";
    case Verdict::added:
      return "added";
    case Verdict::unjudged:
      return "unjudged";
  }
  return "";
}

std::size_t Comparison::count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(findings, [verdict](const Finding& f) { return f.verdict == verdict; }));
}

bool Comparison::bad() const {
  return count(Verdict::regressed) + count(Verdict::ambiguous) + count(Verdict::missing) > 0;
}

Comparison compare(const RunResults& baseline, const RunResults& current, const Thresholds& thresholds,
                   const CompareOptions& options) {
  return Judge(baseline, current, thresholds, options).judge();
}

}  // namespace penumbra::compare
