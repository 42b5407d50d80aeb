// Every part of what determines a point changes its fingerprint.
#include "run/fingerprint.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace penumbra::run {
namespace {

struct All {
  Point point;
  MeasuredWith with{"content", "0.1.0", "3.13.5", "CPU", "llvmpipe", "23.1"};
  WorkerSettings settings;
  All() { point.id = "0123456789abcdef"; }
  std::string hash() const { return fingerprint(point, with, settings); }
};

TEST(Fingerprint, ChangesWithEachOfItsParts) {
  const std::vector<std::function<void(All&)>> changes = {
      [](All& a) { a.point.id = "0123456789abcdee"; },
      [](All& a) { a.with.scene_content += 'x'; },
      [](All& a) { a.with.program += 'x'; },
      [](All& a) { a.with.embree += 'x'; },
      [](All& a) { a.with.cpu += 'x'; },
      [](All& a) { a.with.device += 'x'; },
      [](All& a) { a.with.driver_version += 'x'; },
      // What moves from one text to its neighbour.
      [](All& a) { a.with.program = "0.1.03", a.with.embree = ".13.5"; },
      [](All& a) { a.settings.reference_samples += 1; },
      [](All& a) { a.settings.threads += 1; },
      [](All& a) { a.settings.frames += 1; },
      [](All& a) { a.settings.images.push_back("mask"); },
      [](All& a) { a.settings.measure.warmup += 1; },
      [](All& a) { a.settings.measure.repetitions += 1; },
      [](All& a) { a.settings.measure.min_time_s += 1; },
      [](All& a) { a.settings.measure.max_time_s += 1; },
      [](All& a) { a.settings.measure.target_interval += 0.01; },
      [](All& a) { a.settings.measure.counters = false; },
  };
  std::set<std::string> seen{All().hash()};
  EXPECT_EQ(All().hash(), All().hash());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    All changed;
    changes[i](changed);
    EXPECT_TRUE(seen.insert(changed.hash()).second) << "change " << i;
  }
}

// Where results are written and where scenes are looked for is not what they are.
TEST(Fingerprint, DoesNotChangeWithPlaces) {
  All moved;
  moved.settings.run_folder = "/elsewhere", moved.settings.reference_cache = "/cache";
  moved.settings.scene_search = {"/scenes"};
  EXPECT_EQ(moved.hash(), All().hash());
}

}  // namespace
}  // namespace penumbra::run
