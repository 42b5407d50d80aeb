// Properties of sweep expansion.
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "fixture.h"

namespace penumbra {
namespace {

using test::expand_text;
using test::keys;

TEST(Expansion, AValueGivesOnePointWithEverythingResolved) {
  const auto points = expand_text(R"({"scene": "area", "techniques": "gears"})");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].key(),
            "gears/area/resolution=512,camera=front,light=key,mask_size=16,light_pattern=regular,"
            "assignment=clusters,grid_size=128,frame=0");
  EXPECT_LT(points[0].light_size, 0) << "the scene's own";
  EXPECT_EQ(points[0].params.size(), 2u);
}

TEST(Expansion, ListsMultiply) {
  const auto points =
      expand_text(R"({"scene": ["area"], "resolution": [64, [32, 16]], "mask_size": [2, 4, [8, 2]],
    "light_size": [1, 2], "grid_size": [16, 32], "light_pattern": ["regular", "halton"], "light": ["key", "bulb"],
    "camera": ["front", "side"], "frames": 2, "techniques": ["gears"]})");
  EXPECT_EQ(points.size(), 2u * 3 * 2 * 2 * 2 * 2 * 2 * 2);
  std::set<std::string> ids, seen;
  for (const Point& p : points) ids.insert(p.id), seen.insert(p.key());
  EXPECT_EQ(ids.size(), points.size()) << "ids are unique";
  EXPECT_EQ(seen.size(), points.size()) << "keys are unique";
}

TEST(Expansion, AnAxisThatATechniqueDoesNotHaveMakesNoCopies) {
  const auto points =
      expand_text(R"({"scene": "area", "mask_size": [2, 4, 8], "light_pattern": ["regular", "halton"],
    "grid_size": [16, 32], "techniques": ["gears", "shadow_map", "ray_tracing"]})");
  int gears = 0, maps = 0, rays = 0;
  for (const Point& p : points) {
    gears += p.technique == "gears", maps += p.technique == "shadow_map",
        rays += p.technique == "ray_tracing";
    if (p.technique == "shadow_map") {
      EXPECT_EQ(p.light_samples.width, 1);
    }
  }
  EXPECT_EQ(std::tuple(gears, maps, rays), std::tuple(12, 1, 6));
}

TEST(Expansion, AParameterGivenAListIsOneMoreAxis) {
  const auto points = expand_text(R"({"scene": "area", "techniques": [
    {"technique": "shadow_map", "params": {"map_size": [512, 1024], "slope_bias": [1, 2.5, 4]}}]})");
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(std::get<int64_t>(points[0].params.at("map_size")), 512);
  EXPECT_EQ(std::get<double>(points[1].params.at("slope_bias")), 2.5) << "the last parameter varies fastest";
}

TEST(Expansion, AnEntrysParameterOverridesTheSweepsAxis) {
  const auto points = expand_text(R"({"scene": "area", "grid_size": [16, 32, 64],
    "techniques": [{"technique": "gears", "params": {"grid_size": 256}}]})");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(std::get<int64_t>(points[0].params.at("grid_size")), 256);
}

TEST(Expansion, DuplicatesAreMerged) {
  EXPECT_EQ(expand_text(R"({"scene": ["area", "area"], "mask_size": [4, 4, [4, 4]],
    "techniques": ["gears", "gears", {"technique": "gears", "params": {"grid_size": 128}}]})")
                .size(),
            1u);
}

TEST(Expansion, AnEntryMayHaveScenesLightsAndCamerasOfItsOwn) {
  const auto points = expand_text(R"({"scene": "area", "light": "key", "techniques": ["gears",
    {"technique": "shadow_map", "scene": ["lamp", "area"], "light": "spark", "camera": "front", "title": "Acne", "caption": "Dots."},
    {"technique": "ray_tracing", "camera": ["front", "side"]}]})");
  ASSERT_EQ(points.size(), 5u);
  std::set<std::string> seen;
  for (const Point& p : points) {
    seen.insert(p.technique + " " + p.scene + " " + p.light + " " + p.camera);
    EXPECT_EQ(p.title, p.technique == "shadow_map" ? "Acne" : "");
    EXPECT_EQ(p.caption, p.technique == "shadow_map" ? "Dots." : "");
  }
  EXPECT_EQ(seen, (std::set<std::string>{"gears area key front", "shadow_map area spark front",
                                         "ray_tracing area key front", "ray_tracing area key side",
                                         "shadow_map lamp spark front"}));
  // Points of one view stay together.
  EXPECT_EQ(points.back().scene, "lamp");
  EXPECT_EQ(points[3].camera, "side");
}

TEST(Expansion, APointThatALaterEntryNamesTakesItsName) {
  const auto points = expand_text(R"({"scene": "area", "techniques": ["gears",
    {"technique": "gears", "title": "Exact"}, {"technique": "gears", "title": "Late"}]})");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].title, "Exact");
}

TEST(Expansion, MaskSizeAndLightSamplesAreOneAxis) {
  const auto points = expand_text(
      R"({"scene": "area", "mask_size": [4, 8], "light_samples": [12, 48], "techniques": ["ray_tracing"]})");
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[2].light_samples.count, 12);
  EXPECT_EQ(points[1].light_samples.count, 0);
  EXPECT_EQ(points[1].light_samples.width, 8);
}

TEST(Expansion, ScenesGiveTheirOwnValuesToAxesThatTheSweepLeavesOpen) {
  const auto points = expand_text(R"({"scene": "defaults", "techniques": ["gears", "shadow_map"]})");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].width, 640);
  EXPECT_EQ(points[0].height, 360);
  EXPECT_EQ(points[0].light_size, 0.5);
  EXPECT_EQ(points[0].light_samples.width, 16);
  EXPECT_EQ(points[0].light_samples.height, 8);
  EXPECT_EQ(points[0].light_samples.pattern, LightPattern::halton);
  EXPECT_EQ(std::get<int64_t>(points[0].params.at("grid_size")), 64);
  EXPECT_EQ(std::get<int64_t>(points[1].params.at("map_size")), 2048);
  const auto given =
      expand_text(R"({"scene": "defaults", "resolution": 8, "light_samples": 5, "light_size": 2,
    "grid_size": 16, "light_pattern": "regular", "techniques": ["gears"]})");
  EXPECT_EQ(given[0].width, 8);
  EXPECT_EQ(given[0].light_samples.count, 5);
  EXPECT_EQ(given[0].light_size, 2);
  EXPECT_EQ(std::get<int64_t>(given[0].params.at("grid_size")), 16);
}

TEST(Expansion, APointLightTakesOneSampleWhateverTheSweepAsks) {
  for (const char* scene_and_light :
       {R"("scene": "lamp", "light_size": [1, 2])", R"("scene": "area", "light_size": 0)",
        R"("scene": "area", "light": "spark", "light_size": [1, 2])"}) {
    const auto points =
        expand_text("{" + std::string(scene_and_light) +
                    R"(, "mask_size": [2, 4], "light_samples": 7, "techniques": ["ray_tracing"]})");
    ASSERT_EQ(points.size(), 1u) << scene_and_light;
    EXPECT_EQ(points[0].light_samples.width * points[0].light_samples.height, 1);
    EXPECT_EQ(points[0].light_samples.count, 0);
  }
}

TEST(Expansion, ZeroLightSizeIsAValueNotTheScenesOwn) {
  const auto points = expand_text(R"({"scene": "area", "light_size": [0, 1], "techniques": ["shadow_map"]})");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].light_size, 0);
}

TEST(Expansion, PointsOfOneViewAreAdjacent) {
  const auto points = expand_text(R"({"scene": ["area", "lamp"], "resolution": [16, 32], "mask_size": [2, 4],
    "frames": 3, "techniques": ["gears", "shadow_map", "ray_tracing"]})");
  using View = std::tuple<std::string, std::string, int, int, int>;
  std::set<View> finished;
  View current;
  for (const Point& p : points) {
    const View view{p.scene, p.camera, p.width, p.height, p.frame};
    if (view == current) continue;
    EXPECT_FALSE(finished.contains(view)) << p.key();
    finished.insert(current);
    current = view;
  }
  EXPECT_EQ(finished.size(), 12u) << "eleven views and the empty one before the first";
}

TEST(Expansion, TheOrderOfKeysInTheFileDoesNotMatter) {
  const auto a = expand_text(R"({"scene": "area", "mask_size": [2, 4], "techniques": [
    {"technique": "shadow_map", "params": {"map_size": [16, 32], "slope_bias": [1, 2]}}, "gears"]})");
  const auto b = expand_text(R"({"techniques": [{"params": {"slope_bias": [1, 2], "map_size": [16, 32]},
    "technique": "shadow_map"}, "gears"], "mask_size": [2, 4], "scene": "area"})");
  EXPECT_EQ(keys(a), keys(b));
}

TEST(Expansion, IdsDependOnEveryAxisAndOnNothingElse) {
  const std::string same = R"({"scene": "area", "techniques": ["gears"]})";
  std::set<std::string> ids{expand_text(same)[0].id};
  EXPECT_EQ(expand_text(R"({"name": "other", "images": [], "measure": {"repetitions": 1}, "scene": "area",
    "techniques": ["gears"]})")[0]
                .id,
            *ids.begin());
  const std::vector<std::string> changes{
      R"("resolution": 64)", R"("mask_size": 4)",   R"("light_samples": 256)",
      R"("light_size": 5)",  R"("grid_size": 64)",  R"("light_pattern": "halton")",
      R"("light": "bulb")",  R"("camera": "side")", R"("seed": 2)"};
  for (const std::string& change : changes)
    ids.insert(expand_text(R"({"scene": "area", "techniques": ["gears"], )" + change + "}")[0].id);
  ids.insert(expand_text(R"({"scene": "defaults", "techniques": ["gears"]})")[0].id);
  ids.insert(expand_text(R"({"scene": "area", "techniques": ["gears"], "frames": 2})")[1].id);
  EXPECT_EQ(ids.size(), changes.size() + 3);
  for (const std::string& id : ids) {
    EXPECT_EQ(id.size(), 16u);
    EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos);
  }
}

TEST(Filter, KeepsWhatMatchesInOrder) {
  const auto points =
      expand_text(R"({"scene": "area", "mask_size": [2, 4, 8], "techniques": ["gears", "ray_tracing"]})");
  const auto kept = filter_points(points, "gears/.*mask_size=(2|8),");
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].light_samples.width, 2);
  EXPECT_EQ(filter_points(points, "").size(), points.size());
}

TEST(Filter, NoMatchAndBadExpressionsAreErrors) {
  const auto points = expand_text(R"({"scene": "area", "techniques": ["gears"]})");
  EXPECT_THROW(filter_points(points, "stencil"), InputError);
  EXPECT_THROW(filter_points(points, "gears("), InputError);
}

}  // namespace
}  // namespace penumbra
