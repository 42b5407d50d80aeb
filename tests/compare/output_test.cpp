#include "compare/output.h"

#include <gtest/gtest.h>

#include "tests/compare/synthetic.h"

namespace penumbra::compare {
namespace {

using test::point;
using test::run_of;
using test::times;

Comparison some_comparison() {
  auto now = test::failed(point("gears", times(10)), "failed", "said <\"no\"> & left \x01");
  return compare(run_of({point("gears", times(10)), point("ray_tracing", times(5), 0.01)}),
                 run_of({now, point("ray_tracing", times(5), 0.5)}), default_thresholds());
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Output, TheTableNamesWhatIsBadAndCountsAll) {
  const std::string t = table(some_comparison());
  EXPECT_TRUE(has(t, "regressed  gears  bunny")) << t;
  EXPECT_TRUE(has(t, "metrics.rmse: 0.5 is more than 0.001 above 0.01 [built in]")) << t;
  EXPECT_TRUE(has(t, "2 regressed, 0 ambiguous, 0 missing")) << t;
}

TEST(Output, JUnitCountsItsCasesAndEscapesForeignText) {
  const std::string x = junit_xml(some_comparison());
  EXPECT_TRUE(has(x, R"(tests="5" failures="2" errors="0")")) << x;  // 2 status, frame_ms, rmse, mask bits
  EXPECT_TRUE(has(x, "&lt;&quot;no&quot;&gt; &amp; left ?")) << x;
  EXPECT_TRUE(has(x, R"(<failure type="regressed")")) << x;
}

TEST(Output, JUnitOfNothingIsAnError) {
  Comparison c;
  c.error = "measured nothing";
  EXPECT_TRUE(has(junit_xml(c), R"(errors="1")"));
  EXPECT_TRUE(has(junit_xml(c), R"(<error type="error" message="measured nothing"/>)"));
}

TEST(Output, JsonHasEveryFindingAndNoInfinity) {
  auto before = point("gears", times(10)), now = point("gears", times(10), 0);
  before["metrics"]["psnr"] = 40, now["metrics"]["psnr"] = nullptr;
  const auto j = to_json(compare(run_of({before}), run_of({now}), default_thresholds()));
  EXPECT_EQ(j["points"].size(), 1U);
  EXPECT_EQ(j["points"][0]["verdict"], "improved");
  EXPECT_FALSE(has(j.dump(), "inf"));
  EXPECT_EQ(j["bad"], false);
  bool found = false;
  for (const auto& f : j["points"][0]["findings"]) found = found || f["metric"] == "metrics.zones.umbra.mae";
  EXPECT_TRUE(found);  // without a rule, but there
}

}  // namespace
}  // namespace penumbra::compare
