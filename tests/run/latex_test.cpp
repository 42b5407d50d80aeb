#include "run/latex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "run/statistics.h"

namespace penumbra::run {
namespace {

using nlohmann::json;

json point(const std::string& technique, const std::string& scene, int size,
           const std::string& status = "ok") {
  json p = {{"id", technique}, {"technique", technique}, {"scene", scene},
            {"frame", 0},      {"status", status},       {"params", {{"map_size", size}, {"fit", "tight"}}}};
  if (status == "ok") {
    p["timing"] = {{"frame_ms", to_json(summarize({12, 12.5, 13}))}, {"outliers", 1}, {"drifts", false}};
    p["metrics"] = {{"rmse", 0.0123}, {"flip", nullptr}};
    p["metrics_matched"] = {{"mask_bit_mismatch", 2e-6}};
  }
  return p;
}

RecordSource some_points() {
  return [](const auto& visit) {
    for (const json& p : {point("shadow_map", "bunny", 512), point("shadow_map", "a&b", 1024),
                          point("shadow_map", "a&b", 2048), point("gears", "bunny", 1, "unsupported")})
      visit(p);
  };
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Latex, EveryRowHasEveryColumn) {
  const std::string t = latex_table(some_points());
  EXPECT_TRUE(has(t, "\\begin{tabular}{llrrlrrr}"))
      << t;  // technique scene map_size ms interval rmse flip mask
  EXPECT_TRUE(has(
      t, "shadow\\_map & a\\&b & 1024 & $12.5$ & $[12.0, 13.0]$ & $0.0123$ & -- & $2.0 \\cdot 10^{-6}$ \\\\"))
      << t;
  EXPECT_TRUE(has(t, "gears & bunny & 1 & \\multicolumn{5}{l}{\\emph{unsupported}} \\\\")) << t;
  EXPECT_FALSE(has(t, "fit")) << t;  // the same in all points
  EXPECT_EQ(std::ranges::count(t, '{'), std::ranges::count(t, '}'));
}

TEST(Latex, TheFigureHasAnAxisForEachSceneAndClosesWhatItOpens) {
  const std::string t = pgfplots_figure(some_points());
  EXPECT_TRUE(has(t, "coordinates { (12.5,0.0123) };")) << t;
  EXPECT_TRUE(has(t, "title={a\\&b}")) << t;
  EXPECT_FALSE(has(t, "gears")) << t;
  EXPECT_EQ(std::ranges::count(t, '{'), std::ranges::count(t, '}'));
}

TEST(Latex, SpecialCharactersArePrintedAsTheyAre) {
  EXPECT_EQ(latex_text("50%_x^2\\{~}"), "50\\%\\_x\\^{}2\\textbackslash{}\\{\\~{}\\}");
}

TEST(ProvenanceText, NamesProgramMachineAndCounts) {
  const json run = {{"name", "n"},
                    {"program", {{"version", "1.2"}, {"commit", "abc"}}},
                    {"started", "2026-01-02T00:00:00Z"},
                    {"cpu", {{"model", "A CPU"}, {"usable_cores", 2}}},
                    {"environment", {{"LP_NUM_THREADS", "2"}}},
                    {"config", {{"reference", {{"light_samples", 64}}}}}};
  const std::string t = provenance_text(run, some_points());
  for (const char* part : {"Penumbra 1.2, commit abc", "A CPU (2 cores used", "3 of its 4 points",
                           "LP_NUM_THREADS=2", "64 light samples", "year = {2026}", "@software"})
    EXPECT_TRUE(has(t, part)) << part << "\n" << t;
}

}  // namespace
}  // namespace penumbra::run
