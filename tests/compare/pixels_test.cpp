// Pictures of two runs held against the reference's variance: from files to verdicts.
#include "compare/pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "compare/baseline.h"
#include "compare/output.h"
#include "image/image.h"
#include "tests/compare/synthetic.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;
using test::TemporaryFolder;

constexpr int side = 32, reference_samples = 4096;

std::vector<float> ramp() {
  std::vector<float> v(side * side);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = float(i % side) / float(side - 1);
  return v;
}

// A run of one point, whose picture is the truth but for `wrong` pixels that are off by 0.2. `noise`: of the
// reference.
RunResults run_with(const TemporaryFolder& folder, const std::string& name, std::size_t wrong,
                    unsigned noise = 1) {
  std::vector<float> visibility = ramp(), truth = ramp(), error(truth.size());
  std::mt19937 random(noise);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    error[i] = std::sqrt(truth[i] * (1 - truth[i]) / float(reference_samples));
    truth[i] += error[i] * std::normal_distribution<float>()(random);
    if (i < wrong)
      visibility[i * 7 % visibility.size()] += visibility[i * 7 % visibility.size()] < 0.5f ? 0.2f : -0.2f;
  }
  const auto path = folder / name;
  std::filesystem::create_directories(path);
  write_exr_gray(path / "v.exr", side, side, visibility);
  write_exr_gray(path / "r.exr", side, side, truth);
  write_exr_gray(path / "e.exr", side, side, error);
  json point = test::point("gears", test::times(10));
  point["images"] = {{"visibility", "v.exr"}, {"reference", "r.exr"}, {"reference_standard_error", "e.exr"}};
  RunResults run = test::run_of({essential(point)});
  run.run["config"] = {{"reference", {{"light_samples", reference_samples}}}};
  run.folder = path;
  return run;
}

const Finding* pixels(const Comparison& c) {
  for (const Finding& f : c.findings)
    if (f.metric == "pixels.farther") return &f;
  return nullptr;
}

TEST(Pixels, ThatAreFartherFromTheTruthAreARegression) {
  const TemporaryFolder folder;
  const RunResults good = run_with(folder, "good", 0), bad = run_with(folder, "bad", 12);
  const Comparison worse = compare(good, bad, default_thresholds());
  const Finding* f = pixels(worse);
  ASSERT_TRUE(f);
  EXPECT_EQ(f->verdict, Verdict::regressed);
  ASSERT_TRUE(f->p.has_value());
  EXPECT_LE(*f->p, 0.002);
  EXPECT_DOUBLE_EQ(*f->current, 12.0 / (side * side));
  EXPECT_NE(f->message.find("of 12 pixels that changed 12 are farther"), std::string::npos) << f->message;
  EXPECT_NE(f->message.find("the truth is"), std::string::npos) << f->message;
  EXPECT_TRUE(worse.bad());
  EXPECT_EQ(pixels(compare(bad, good, default_thresholds()))->verdict, Verdict::improved);
  EXPECT_EQ(pixels(compare(good, good, default_thresholds()))->verdict, Verdict::pass);
}

TEST(Pixels, MayBeFartherAsFarAsARuleAllows) {
  const TemporaryFolder folder;
  const RunResults good = run_with(folder, "good", 0), bad = run_with(folder, "bad", 12);
  const auto rule = [](const char* text) {
    return test::thresholds(std::string(R"({"thresholds": [{"metric": "pixels.farther", )") + text + "}]}");
  };
  EXPECT_EQ(pixels(compare(good, bad, rule(R"("max": 0.02)")))->verdict, Verdict::pass);
  EXPECT_EQ(pixels(compare(good, bad, rule(R"("max": 0.01)")))->verdict, Verdict::regressed);
  EXPECT_THROW(rule(R"("max_increase": 0.1)"), InputError);
  const auto other = test::thresholds(R"({"thresholds": [{"metric": "metrics.rmse", "max": 1}]})");
  EXPECT_EQ(pixels(compare(good, bad, other))->verdict, Verdict::unjudged);
}

TEST(Pixels, AreNotJudgedWithoutACommonReferenceOrPictures) {
  const TemporaryFolder folder;
  RunResults good = run_with(folder, "good", 0);
  const RunResults other = run_with(folder, "other", 12, 2);
  const Comparison c = compare(good, other, default_thresholds());
  EXPECT_EQ(pixels(c)->verdict, Verdict::unjudged);
  EXPECT_EQ(pixels(c)->message, "the runs have different references");
  std::filesystem::remove(folder / "other/v.exr");
  EXPECT_NE(pixels(compare(good, other, default_thresholds()))->message.find("v.exr"), std::string::npos);
  good.folder.clear();
  EXPECT_EQ(pixels(compare(good, other, default_thresholds())), nullptr);
}

TEST(Pixels, OfFilesOutsideTheRunAreNotRead) {
  const TemporaryFolder folder;
  const RunResults good = run_with(folder, "good", 0);
  RunResults bad = run_with(folder, "bad", 12);
  bad.points[0]["images"]["visibility"] = "../good/v.exr";
  const Comparison c = compare(good, bad, default_thresholds());
  EXPECT_EQ(pixels(c)->verdict, Verdict::unjudged);
  EXPECT_NE(pixels(c)->message.find("does not lie inside the run"), std::string::npos);
}

TEST(Pixels, AreNotCommittedWithABaseline) {
  const TemporaryFolder folder;
  EXPECT_EQ(baseline_text(run_with(folder, "good", 0)).find("v.exr"), std::string::npos);
}

TEST(PageData, NamesStatusParametersAndImagesOfBothRuns) {
  const TemporaryFolder folder;
  const RunResults good = run_with(folder, "good", 0), bad = run_with(folder, "bad", 12);
  const json data = page_data(compare(good, bad, default_thresholds()), good, bad);
  ASSERT_EQ(data.at("points").size(), 1U);
  EXPECT_EQ(data["points"][0]["status"], "ok");
  EXPECT_EQ(data["points"][0]["verdict"], "regressed");
  EXPECT_EQ(data["points"][0]["params"]["mask_size"], 8);
  EXPECT_EQ(data["images"][0]["baseline"]["visibility"], "v.exr");
  EXPECT_EQ(data["images"][0]["current"]["visibility"], "v.exr");
  EXPECT_EQ(data["runs"]["current"]["name"], "run");
}

}  // namespace
}  // namespace penumbra::compare
