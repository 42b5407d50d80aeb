// The page of two runs side by side: what is written, and what a browser makes of it.
#include "report/comparison.h"

#include <gtest/gtest.h>

#include <fstream>

#include "browser.h"
#include "compare/output.h"
#include "core/error.h"
#include "image/image.h"
#include "report/pictures.h"
#include "scratch_folder.h"
#include "synthetic_run.h"

namespace penumbra {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using test::ScratchFolder;

// The same run again, but for: GEARS' first point twice as slow; its second darker in a corner of its
// picture, and so its rmse higher; the third gone.
void write_worse_run(const fs::path& from, const fs::path& to) {
  fs::copy(from, to, fs::copy_options::recursive);
  json results = json::parse(test::read_file(from / "results.json"));
  json kept = json::array();
  int gears = 0;
  for (json& point : results["points"]) {
    const int nth = point["technique"] == "gears" ? ++gears : 0;
    if (nth == 1)
      for (json& sample : point["timing"]["frame_ms"]["samples"]) sample = 2 * sample.get<double>();
    if (nth == 2) {
      point["metrics"]["rmse"] = point["metrics"]["rmse"].get<double>() + 0.01;
      const fs::path picture = to / point["images"]["visibility"].get<std::string>();
      ExrImage image = read_exr(picture);
      for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x) image.floats[0].values[std::size_t(y * image.width + x)] -= 0.5f;
      write_exr(picture, image);
    }
    if (nth != 3) kept.push_back(point);
  }
  results["points"] = kept;
  std::ofstream(to / "results.json") << results.dump();
}

ReportSummary compare_runs(const fs::path& before, const fs::path& now, const fs::path& out) {
  const compare::RunResults a = compare::read_results(before), b = compare::read_results(now);
  compare::Thresholds thresholds = compare::default_thresholds();
  thresholds.significance = 0.05;  // of few samples
  const compare::Comparison c = compare::compare(a, b, thresholds);
  return write_comparison_report(compare::page_data(c, a, b), a.folder, b.folder, out);
}

TEST(ComparisonReport, HoldsThePicturesOfBothRunsAndWhatChanged) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "before");
  write_worse_run(scratch / "before", scratch / "now");
  const ReportSummary summary = compare_runs(scratch / "before", scratch / "now", scratch / "out");
  EXPECT_TRUE(summary.warnings.empty()) << summary.warnings.front();
  EXPECT_TRUE(fs::exists(scratch / "out/index.html"));
  int changed = 0, same = 0;
  for (const auto& entry : fs::recursive_directory_iterator(scratch / "out/difference"))
    if (entry.is_regular_file()) {
      const Rgb8Image picture = read_png(entry.path());
      const bool corner = decode_signed_error(picture.rgb[0]) < -0.45f;
      ++(corner ? changed : same);
      EXPECT_EQ(picture.rgb[picture.rgb.size() - 1], 128) << entry.path();
    }
  EXPECT_EQ(changed, 1);
  EXPECT_GT(same, 10);
  // Pictures of an earlier comparison in this folder are not taken for this one's, however old the runs.
  compare_runs(scratch / "now", scratch / "now", scratch / "out");
  for (const auto& entry : fs::recursive_directory_iterator(scratch / "out/difference"))
    if (entry.is_regular_file()) {
      EXPECT_EQ(read_png(entry.path()).rgb[0], 128);
    }
}

TEST(ComparisonReport, NeedsNoPictures) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run", {16, 12, false});
  const ReportSummary summary = compare_runs(scratch / "run/results.json", scratch / "run", scratch / "out");
  EXPECT_EQ(summary.pictures, 0U);
  EXPECT_TRUE(summary.warnings.empty());
}

TEST(ComparisonReport, LeavesForeignPagesAlone) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run", {16, 12, false});
  fs::create_directories(scratch / "site");
  std::ofstream(scratch / "site/index.html") << "my page";
  EXPECT_THROW(compare_runs(scratch / "run", scratch / "run", scratch / "site"), InputError);
  EXPECT_EQ(test::read_file(scratch / "site/index.html"), "my page");
}

TEST(ComparisonInBrowser, ShowsVerdictsAndFlicksBothRuns) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "before");
  write_worse_run(scratch / "before", scratch / "now");
  compare_runs(scratch / "before", scratch / "now", scratch / "out");
  const json outcome =
      test::selftest(scratch / "out", scratch / "profile", "tests/report/comparison_selftest.js");
  test::expect_all(outcome);
  EXPECT_GE(outcome["checks"].size(), 20u);
}

TEST(ComparisonInBrowser, HoldsTenThousandPointsWithFewRowsInTheDocument) {
  ScratchFolder scratch;
  test::write_large_run(scratch / "run", 10000);
  compare_runs(scratch / "run", scratch / "run", scratch / "out");
  const json outcome =
      test::selftest(scratch / "out", scratch / "profile", "tests/report/comparison_selftest.js");
  test::expect_all(outcome);
  EXPECT_EQ(outcome.value("points", 0), 10000);
  EXPECT_LT(outcome.value("rows_in_document", 10000), 120);
}

}  // namespace
}  // namespace penumbra
