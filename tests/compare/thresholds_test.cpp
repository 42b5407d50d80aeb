#include "compare/thresholds.h"

#include <gtest/gtest.h>

#include "tests/compare/synthetic.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::compare {
namespace {

using test::point;
using test::thresholds;

TEST(Thresholds, TheMostSpecificRuleWins) {
  const Thresholds t = thresholds(R"({"thresholds": [
    {"params": {"mask_size": 8}, "metric": "metrics.rmse", "max": 4},
    {"scene": "bunny", "metric": "metrics.rmse", "max": 3},
    {"technique": "gears", "scene": "b*", "metric": "metrics.rmse", "max": 2.5},
    {"technique": "gears", "metric": "metrics.rmse", "max": 2},
    {"technique": "*", "scene": "*", "metric": "metrics.rmse", "max": 1}]})");
  nlohmann::json p = point("gears", {1});
  EXPECT_EQ(rule_for(t, p, "metrics.rmse")->max, 4.0);  // params before all
  p["params"]["mask_size"] = 4;
  EXPECT_EQ(rule_for(t, p, "metrics.rmse")->max, 3.0);  // then the scene's name
  p["scene"] = "box";
  EXPECT_EQ(rule_for(t, p, "metrics.rmse")->max, 2.5);  // then its pattern
  p["scene"] = "dragon";
  EXPECT_EQ(rule_for(t, p, "metrics.rmse")->max, 2.0);  // then the technique
  p["technique"] = "shadow_map";
  EXPECT_EQ(rule_for(t, p, "metrics.rmse")->max, 1.0);
  EXPECT_EQ(rule_for(t, p, "metrics.mae"), nullptr);
}

TEST(Thresholds, OfEquallySpecificRulesTheLaterWins) {
  const Thresholds t = thresholds(R"({"thresholds": [
    {"metric": "metrics.*", "max": 1}, {"metric": "metrics.rmse", "max": 2}, {"metric": "metrics.rmse", "max": 3},
    {"metric": "metrics.*", "max": 4}]})");
  EXPECT_EQ(rule_for(t, point("gears", {1}), "metrics.rmse")->max, 3.0);
  EXPECT_EQ(rule_for(t, point("gears", {1}), "metrics.mae")->max, 4.0);
}

TEST(Thresholds, WildcardsMatchWholeNames) {
  EXPECT_TRUE(matches_wildcard("*", ""));
  EXPECT_TRUE(matches_wildcard("a*b*c", "aXXbYbZc"));
  EXPECT_FALSE(matches_wildcard("a*b", "abc"));
  EXPECT_TRUE(matches_wildcard("sh?dow", "shadow"));
  EXPECT_FALSE(matches_wildcard("shadow", "shadow_map"));
}

std::string refusal(const std::string& text) {
  const KnownNames known{{"gears", "ray_tracing"}, {"bunny"}, {"mask_size", "dynamic"}};
  return test::message_of<InputError>([&] { thresholds(text, known); });
}

TEST(Thresholds, ErrorsNameThePlaceAndTheNearestName) {
  const auto says = [](const std::string& rule, const std::vector<std::string>& texts) {
    const std::string message = refusal(R"({"thresholds": [)" + rule + "]}");
    EXPECT_EQ(message.rfind("t.json:1:", 0), 0U) << message;
    for (const std::string& text : texts) EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  says(R"({"technique": "gear", "metric": "metrics.rmse", "max": 1})",
       {"/thresholds/0/technique", "'gears'"});
  says(R"({"technique": "x*", "metric": "metrics.rmse", "max": 1})", {"matches none"});
  says(R"({"scene": "buny", "metric": "metrics.rmse", "max": 1})", {"'bunny'"});
  says(R"({"metric": "metrics.rsme", "max": 1})", {"/thresholds/0/metric", "'metrics.rmse'"});
  says(R"({"metric": "metrics.rmse", "params": {"mask_sise": 8}, "max": 1})", {"'mask_size'"});
  says(R"({"metric": "metrics.rmse", "mx": 1})", {"'max'"});
  says(R"({"metric": "metrics.rmse"})", {"without a condition"});
  says(R"({"metric": "metrics.rmse", "max_ratio": 0.5})", {"0.5"});
  says(R"({"metric": "timing.frame_ms", "max": 10})", {"max_ratio"});
  says(R"({"metric": "metrics.rmse", "max_ratio_elsewhere": 2})", {"timing"});
  says("", {"nothing would be judged"});
  EXPECT_NE(refusal(R"({"anchor": "ray_tracin", "thresholds": []})").find("'ray_tracing'"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"significance": 0, "thresholds": []})").find("/significance"), std::string::npos);
}

TEST(Thresholds, GroupsThatTechniquesNameTakeAnyMember) {
  const Thresholds t = thresholds(
      R"({"thresholds": [{"metric": "counters.rays", "max_ratio": 1}, {"metric": "timing.passes.trace", "max_ratio": 2}]})");
  EXPECT_EQ(t.rules.size(), 2U);
}

}  // namespace
}  // namespace penumbra::compare
