#include "compare/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compare/synthetic.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;
using test::failed;
using test::point;
using test::run_of;
using test::thresholds;
using test::times;

const Finding& finding(const Comparison& c, const std::string& technique, const std::string& metric) {
  for (const Finding& f : c.findings)
    if (f.metric == metric && c.points[f.point].technique == technique) return f;
  static const Finding none;
  ADD_FAILURE() << "no finding for " << metric << " of " << technique;
  return none;
}

Verdict time_verdict(const Comparison& c, const std::string& technique = "gears") {
  return finding(c, technique, "timing.frame_ms").verdict;
}

Verdict quality_verdict(double before, double now, const std::string& condition) {
  const auto t = thresholds(R"({"thresholds": [{"metric": "metrics.rmse", )" + condition + "}]}");
  return finding(compare(run_of({point("gears", times(10), before)}),
                         run_of({point("gears", times(10), now)}), t),
                 "gears", "metrics.rmse")
      .verdict;
}

TEST(Quality, IsJudgedByEachOfItsLimits) {
  EXPECT_EQ(quality_verdict(0.01, 0.02, R"("max": 0.02)"), Verdict::pass);
  EXPECT_EQ(quality_verdict(0.01, 0.0201, R"("max": 0.02)"), Verdict::regressed);
  EXPECT_EQ(quality_verdict(0.01, 0.0109, R"("max_increase": 0.001)"), Verdict::pass);
  EXPECT_EQ(quality_verdict(0.01, 0.0111, R"("max_increase": 0.001)"), Verdict::regressed);
  EXPECT_EQ(quality_verdict(0.01, 0.0089, R"("max_increase": 0.001)"), Verdict::improved);
  EXPECT_EQ(quality_verdict(30, 29, R"("max_decrease": 0.5)"), Verdict::regressed);
  EXPECT_EQ(quality_verdict(30, 31, R"("max_decrease": 0.5)"), Verdict::improved);
  EXPECT_EQ(quality_verdict(30, 29, R"("min": 29.5)"), Verdict::regressed);
  EXPECT_EQ(quality_verdict(100, 111, R"("max_ratio": 1.1)"), Verdict::regressed);
  EXPECT_EQ(quality_verdict(0, 0, R"("max_ratio": 1.1)"), Verdict::pass);  // zero is a value
  EXPECT_EQ(quality_verdict(0, 1e-9, R"("max_ratio": 1.1)"), Verdict::regressed);
}

TEST(Quality, WithoutARuleIsReportedOnly) {
  const auto t = thresholds(R"({"thresholds": [{"metric": "metrics.mae", "max": 1}]})");
  const Comparison c =
      compare(run_of({point("gears", times(10), 0.1)}), run_of({point("gears", times(10), 0.9)}), t);
  EXPECT_EQ(finding(c, "gears", "metrics.rmse").verdict, Verdict::unjudged);
  EXPECT_FALSE(c.bad());
}

TEST(Quality, ThatHasNoValueAnyMoreIsMissing) {
  json now = point("gears", times(10));
  now["metrics"]["rmse"] = nullptr;
  const auto t = thresholds(R"({"thresholds": [{"metric": "metrics.rmse", "max": 1}]})");
  const Comparison c = compare(run_of({point("gears", times(10))}), run_of({now}), t);
  EXPECT_EQ(finding(c, "gears", "metrics.rmse").verdict, Verdict::missing);
  EXPECT_TRUE(c.bad());
}

TEST(Quality, EqualImagesHaveTheBestPsnr) {
  json before = point("gears", times(10)), now = point("gears", times(10), 0);
  before["metrics"]["psnr"] = 40, now["metrics"]["psnr"] = nullptr;
  const auto t = thresholds(R"({"thresholds": [{"metric": "metrics.psnr", "min": 30, "max_decrease": 1}]})");
  EXPECT_EQ(finding(compare(run_of({before}), run_of({now}), t), "gears", "metrics.psnr").verdict,
            Verdict::improved);
  EXPECT_EQ(finding(compare(run_of({now}), run_of({before}), t), "gears", "metrics.psnr").verdict,
            Verdict::regressed);
}

// One light sample of 256 flipped in 1 % of the pixels, and 0.002 of rmse, by the built-in rules.
TEST(Quality, TheBuiltInRulesFindSmallErrors) {
  const json before = point("gears", times(10), 0.02, 0);
  for (const json& now : {point("gears", times(10), 0.02, 0.01 / 256), point("gears", times(10), 0.022, 0)})
    EXPECT_EQ(compare(run_of({before}), run_of({now}), default_thresholds()).count(Verdict::regressed), 1U);
}

const char* raw_rule = R"({"thresholds": [{"metric": "timing.frame_ms", "max_ratio": 1.05}]})";
const char* anchored_rule =
    R"({"anchor": "ray_tracing", "thresholds": [{"metric": "timing.frame_ms", "max_ratio": 1.05}]})";

Comparison times_compared(const std::vector<double>& before, const std::vector<double>& now,
                          const char* rule = raw_rule) {
  return compare(run_of({point("gears", before)}), run_of({point("gears", now)}), thresholds(rule));
}

TEST(Time, NeedsTheFactorAndTheSignificance) {
  EXPECT_EQ(time_verdict(times_compared(times(10), times(10, 12, 2))), Verdict::pass);
  EXPECT_EQ(time_verdict(times_compared(times(10), times(11, 12, 2))), Verdict::regressed);
  EXPECT_EQ(time_verdict(times_compared(times(11), times(10, 12, 2))), Verdict::improved);
  // Certain, but by less than the factor.
  const Comparison small = times_compared(times(10), times(10.3, 12, 2));
  EXPECT_EQ(time_verdict(small), Verdict::pass);
  EXPECT_LT(*finding(small, "gears", "timing.frame_ms").p, 0.002);
  // Beyond the factor, but three repetitions prove nothing; the message says how many would.
  const Comparison few = times_compared(times(10, 3), times(11, 3, 2));
  EXPECT_EQ(time_verdict(few), Verdict::ambiguous);
  EXPECT_TRUE(few.bad());
  EXPECT_NE(finding(few, "gears", "timing.frame_ms").message.find("6 each would"), std::string::npos)
      << finding(few, "gears", "timing.frame_ms").message;
}

TEST(Time, BesideOtherProgramsIsNeverCalledRegressedOrImproved) {
  const auto verdict = [](double before, double now, double others_before, double others_now) {
    json a = point("gears", times(before)), b = point("gears", times(now, 12, 2));
    a["other_programs"] = others_before, b["other_programs"] = others_now;
    return compare(run_of({a}), run_of({b}), thresholds(raw_rule));
  };
  EXPECT_EQ(time_verdict(verdict(10, 11, 0.05, 0.05)), Verdict::regressed);
  const Comparison disturbed = verdict(10, 11, 0.05, 0.47);
  EXPECT_EQ(time_verdict(disturbed), Verdict::ambiguous);
  EXPECT_NE(finding(disturbed, "gears", "timing.frame_ms").message.find("other programs had 47 %"),
            std::string::npos)
      << finding(disturbed, "gears", "timing.frame_ms").message;
  EXPECT_EQ(time_verdict(verdict(10, 11, 0.47, 0.05)), Verdict::ambiguous);
  EXPECT_EQ(time_verdict(verdict(11, 10, 0.47, 0.05)), Verdict::pass);
  EXPECT_EQ(time_verdict(verdict(10, 10, 0.47, 0.05)), Verdict::pass);
}

TEST(Time, IsCorrectedForTheNumberOfPoints) {
  const auto verdict = [](int others) {
    std::vector<json> before = {point("gears", times(10, 7))}, now = {point("gears", times(11, 7, 2))};
    for (int i = 0; i < others; ++i)
      for (auto* run : {&before, &now})
        run->push_back(point("gears", times(10, 7, 5), 0, 0, "s" + std::to_string(i)));
    return time_verdict(compare(run_of(before), run_of(now), thresholds(raw_rule)));
  };
  EXPECT_EQ(verdict(0), Verdict::regressed);   // p = 1 / 3432
  EXPECT_EQ(verdict(50), Verdict::ambiguous);  // 51 / 3432 is above 0.002
}

TEST(Time, AnchorRatiosForgiveASlowerMachineAndNotASlowerTechnique) {
  const auto run = [](double machine, double gears, int seed) {
    return run_of({point("ray_tracing", times(20 * machine, 12, seed)),
                   point("gears", times(10 * machine * gears, 12, seed + 1))});
  };
  const auto t = thresholds(anchored_rule);
  EXPECT_EQ(time_verdict(compare(run(1, 1, 1), run(1.5, 1, 3), t)), Verdict::pass);
  const Comparison slower = compare(run(1, 1, 1), run(0.8, 1.1, 3), t);
  EXPECT_EQ(time_verdict(slower), Verdict::regressed);
  EXPECT_NEAR(*finding(slower, "gears", "timing.frame_ms").ratio, 1.1, 0.01);
  EXPECT_EQ(time_verdict(slower, "ray_tracing"), Verdict::unjudged);  // is the anchor
}

TEST(Time, WithoutItsAnchorIsMissing) {
  EXPECT_EQ(time_verdict(times_compared(times(10), times(10), anchored_rule)), Verdict::missing);
}

TEST(Time, TheAnchorHasTheSameLightSamples) {
  json coarse = point("ray_tracing", times(5)), fine = point("ray_tracing", times(20));
  coarse["params"]["mask_size"] = 4;
  const auto run = [&](double fine_ms) {
    json f = point("ray_tracing", times(fine_ms));
    return run_of({coarse, f, point("gears", times(10))});
  };
  const Comparison c = compare(run(20), run(10), thresholds(anchored_rule));
  EXPECT_NEAR(*finding(c, "gears", "timing.frame_ms").ratio, 2, 0.02);
}

TEST(Time, IsJudgedBetweenMachinesOnlyWhenAsked) {
  const auto before = run_of({point("gears", times(10))}, "A"),
             now = run_of({point("gears", times(20))}, "B");
  const Comparison c = compare(before, now, thresholds(raw_rule));
  EXPECT_EQ(time_verdict(c), Verdict::unjudged);
  EXPECT_FALSE(c.bad());
  ASSERT_EQ(c.remarks.size(), 1U);
  EXPECT_NE(c.remarks[0].find("\"A\" against \"B\""), std::string::npos) << c.remarks[0];
  EXPECT_EQ(time_verdict(compare(before, now, thresholds(raw_rule), {true})), Verdict::regressed);
}

TEST(Time, AnchorRatiosHaveALimitOfTheirOwnBetweenMachines) {
  const auto run = [](double gears, const char* cpu) {
    return run_of({point("ray_tracing", times(20)), point("gears", times(gears))}, cpu);
  };
  const auto t = thresholds(R"({"anchor": "ray_tracing", "thresholds": [
    {"metric": "timing.frame_ms", "max_ratio": 1.05, "max_ratio_elsewhere": 2}]})");
  EXPECT_EQ(time_verdict(compare(run(10, "A"), run(18, "B"), t)), Verdict::pass);
  EXPECT_EQ(time_verdict(compare(run(10, "A"), run(22, "B"), t)), Verdict::regressed);
  EXPECT_EQ(time_verdict(compare(run(10, "A"), run(18, "A"), t)), Verdict::regressed);
}

TEST(Time, OfASequenceSummaryIsNotJudged) {
  json p = point("gears", times(10)), q = point("gears", times(20));
  p["frame"] = q["frame"] = nullptr;
  EXPECT_EQ(time_verdict(compare(run_of({p}), run_of({q}), thresholds(raw_rule))), Verdict::unjudged);
}

TEST(Points, ThatFailNowAreRegressedAndThatAreGoneAreMissing) {
  const json a = point("gears", times(10)), b = point("shadow_map", times(10)),
             d = point("line_space", times(10));
  const Comparison c = compare(run_of({a, b, failed(d, "failed", "was")}),
                               run_of({failed(a, "timeout", "too slow"), d}), thresholds(raw_rule));
  EXPECT_EQ(finding(c, "gears", "status").verdict, Verdict::regressed);
  EXPECT_NE(finding(c, "gears", "status").message.find("too slow"), std::string::npos);
  EXPECT_EQ(finding(c, "shadow_map", "status").verdict, Verdict::missing);
  EXPECT_EQ(finding(c, "line_space", "status").verdict, Verdict::improved);
  EXPECT_TRUE(c.bad());
}

TEST(Points, ThatAreNewOrUnsupportedInBothAreNoFailure) {
  const json a = point("gears", times(10)), b = point("shadow_map", times(10));
  const json u = failed(point("planar_shadow", {}), "unsupported", "no plane");
  const Comparison c = compare(run_of({a, u}), run_of({a, u, b}), thresholds(raw_rule));
  EXPECT_EQ(finding(c, "shadow_map", "status").verdict, Verdict::added);
  EXPECT_EQ(finding(c, "planar_shadow", "status").verdict, Verdict::pass);
  EXPECT_FALSE(c.bad());
}

TEST(Points, KeepTheirBaselineWhenTheTechniqueGetsANewParameter) {
  json now = point("gears", times(10)), other = now;
  now["params"]["new_one"] = 1;
  EXPECT_FALSE(compare(run_of({point("gears", times(10))}), run_of({now}), thresholds(raw_rule)).bad());
  // Two that would fit are none.
  other["params"]["new_one"] = 2;
  EXPECT_NE(compare(run_of({point("gears", times(10))}), run_of({now, other}), thresholds(raw_rule)).error,
            "");
  // Another value of a parameter is another point.
  json changed = point("gears", times(10));
  changed["params"]["mask_size"] = 16;
  EXPECT_NE(compare(run_of({point("gears", times(10))}), run_of({changed}), thresholds(raw_rule)).error, "");
}

TEST(Comparison, OfNothingIsAnError) {
  const json a = point("gears", times(10)), b = point("shadow_map", times(10));
  EXPECT_NE(compare(run_of({a}), run_of({b}), thresholds(raw_rule)).error.find("none of the points"),
            std::string::npos);
  for (const auto& nothing : {run_of({}), run_of({failed(a, "failed", "why")})})
    EXPECT_NE(compare(run_of({a}), nothing, thresholds(raw_rule)).error.find("measured nothing"),
              std::string::npos);
}

}  // namespace
}  // namespace penumbra::compare
