#include <gtest/gtest.h>

#include "tests/run/sweep.h"

namespace penumbra::test {
namespace {

TEST(Sequence, GivesOnePointPerFrameAndASummary) {
  Sweep sweep;
  sweep.plan.frames = 3;
  for (int frame = 0; frame < 3; ++frame) sweep.add({{"value", 0.5}}, frame, "moving");
  EXPECT_EQ(sweep.run().ok, 3U);
  const auto points = sweep.results()["points"];
  ASSERT_EQ(points.size(), 4U);
  const auto& summary = points[3];
  EXPECT_TRUE(summary["frame"].is_null());
  EXPECT_EQ(summary["timing"]["frame_ms"]["samples"].size(), 3U);
  EXPECT_TRUE(points[0]["metrics"]["flicker"].is_null());
  EXPECT_GT(points[1]["metrics"]["flicker"], 0);  // a constant answer to a moving shadow
  EXPECT_GT(summary["metrics"]["flicker"], 0);
  EXPECT_FALSE(std::filesystem::exists(sweep.out() / ".sequence"));
}

// What a moving scene makes techniques do again is part of its frames.
TEST(Sequence, MovingScenesAreDynamicFromTheSecondFrameOn) {
  Sweep sweep;
  sweep.plan.frames = 2;
  sweep.add({}, 0, "moving").add({}, 1, "moving").add({}, 1, "still").run();
  EXPECT_EQ(sweep.record("p0")["timing"]["dynamic"], false);
  EXPECT_EQ(sweep.record("p1")["timing"]["dynamic"], true);
  EXPECT_TRUE(sweep.record("p1")["timing"]["passes"].contains("fake_build"));
  EXPECT_EQ(sweep.record("p2")["timing"]["dynamic"], false);
}

TEST(Sequence, FlickerReachesBackOverACrashOfAnotherPoint) {
  Sweep sweep;
  sweep.plan.frames = 2;
  sweep.add({{"value", 0.5}}, 0, "moving");
  sweep.add({{"fault", std::string("abort")}}, 0, "moving");
  sweep.add({{"value", 0.5}}, 1, "moving");
  sweep.add({{"fault", std::string("abort")}}, 1, "moving");
  sweep.run();
  EXPECT_GT(sweep.record("p2")["metrics"]["flicker"], 0);
}

}  // namespace
}  // namespace penumbra::test
