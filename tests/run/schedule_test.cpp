#include "run/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "core/error.h"
#include "run/progress.h"

namespace penumbra::run {
namespace {

std::vector<Point> some_points(int n) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) {
    Point p;
    p.id = std::to_string(i);
    p.technique = i % 3 ? "a" : "b";
    p.scene = i < n / 2 ? "s" : "t";
    p.width = p.height = 64 << (i % 4);
    p.sampled = true;
    p.light_samples.width = p.light_samples.height = 1 + i % 16;
    points.push_back(p);
  }
  return points;
}

TEST(Batches, CutWhereTheViewChangesAndKeepTheOrder) {
  std::vector<Point> points(5);
  points[0].scene = points[1].scene = "s";
  points[2].scene = points[3].scene = points[4].scene = "t";
  points[4].frame = 1;
  const auto b = batches(points);
  ASSERT_EQ(b.size(), 3U);
  EXPECT_EQ(b[0], (BatchIndices{0, 1}));
  EXPECT_EQ(b[1], (BatchIndices{2, 3}));
  EXPECT_EQ(b[2], (BatchIndices{4}));
}

TEST(CostModel, LearnsATechniquesRateAndScalesItWithTheWork) {
  CostModel model({1, 7, 0, 1000}, {});
  auto points = some_points(4);
  const double before = model.expected_s(points[1]);
  model.learn(points[1], 3.0);
  EXPECT_GT(model.expected_s(points[1]), 7 * 3.0);
  EXPECT_GT(model.expected_s(points[1]), before);
  Point dearer = points[1];
  dearer.width *= 2;
  EXPECT_NEAR(model.expected_s(dearer) / model.expected_s(points[1]), 2, 0.1);
}

TEST(Shard, PartsAreDisjointCompleteAndBalanced) {
  const auto points = some_points(500);
  const CostModel model({}, {});
  std::set<std::string> seen;
  double least = 1e30, most = 0;
  for (int i = 1; i <= 7; ++i) {
    double cost = 0;
    for (const Point& p : shard(points, i, 7, model)) {
      EXPECT_TRUE(seen.insert(p.id).second) << p.id;
      cost += model.expected_s(p);
    }
    least = std::min(least, cost), most = std::max(most, cost);
  }
  EXPECT_EQ(seen.size(), 500U);
  EXPECT_LT(most / least, 1.05);
}

TEST(Shard, KeepsASequenceTogetherAndRefusesNonsense) {
  std::vector<Point> points(12);
  for (int i = 0; i < 12; ++i) {
    points[static_cast<std::size_t>(i)].scene = i % 2 ? "s" : "t";
    points[static_cast<std::size_t>(i)].frame = i / 2;
  }
  const CostModel model({}, {});
  for (int i = 1; i <= 2; ++i) {
    const auto part = shard(points, i, 2, model);
    ASSERT_EQ(part.size(), 6U);
    for (const Point& p : part) EXPECT_EQ(p.scene, part.front().scene);
  }
  EXPECT_THROW(shard(points, 0, 2, model), InputError);
  EXPECT_THROW(shard(points, 3, 2, model), InputError);
}

TEST(Shard, TenThousandPointsTakeNoTime) {
  const auto points = some_points(10000);
  const auto start = std::chrono::steady_clock::now();
  shard(points, 1, 16, CostModel({}, {}));
  batches(points);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

TEST(DurationText, ReadsLikeAClock) {
  EXPECT_EQ(duration_text(47.2), "47 s");
  EXPECT_EQ(duration_text(185), "3:05");
  EXPECT_EQ(duration_text(7800), "2 h 10 min");
}

}  // namespace
}  // namespace penumbra::run
