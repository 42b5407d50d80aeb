// What techniques show of themselves agrees with what they count of themselves, and leaves their output as it
// was.
#include <gtest/gtest.h>

#include <cmath>

#include "technique/illustration.h"
#include "techniques/registry.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"

namespace penumbra {
namespace {

using testing::number;
using testing::Rendered;
using testing::Stage;

Frame scene() {
  Frame f;
  testing::add_box(f.geometry, {-0.6F, 0.2F, -0.5F}, {-0.1F, 0.9F, 0.1F});
  testing::add_box(f.geometry, {0.1F, 0.0F, -0.3F}, {0.5F, 0.6F, 0.3F});
  testing::add_ground(f.geometry, 2);
  f.geometry.triangle_instance.assign(f.geometry.triangle_count(), 0);
  for (std::size_t t = f.geometry.triangle_count() - 2; t < f.geometry.triangle_count(); ++t)
    f.geometry.triangle_instance[t] = 1;
  f.geometry.instance_closed = {1, 0};
  f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0.3F, 0}, 0.8F, 0.5F);
  f.camera = testing::camera_at({0, 1.5F, 3.5F}, {0, 0.6F, 0});
  return f;
}

struct Shown {
  Rendered rendered;
  std::map<std::string, Illustration> pictures;
  const std::vector<float>& figures(const std::string& name) const {
    const auto& content = pictures.at(name).content;
    if (const auto* grid = std::get_if<GridFigures>(&content)) return grid->values;
    return std::get<PixelFigures>(content).values;
  }
  double sum(const std::string& name) const {
    double s = 0;
    for (const float v : figures(name)) s += std::isnan(v) ? 0 : static_cast<double>(v);
    return s;
  }
  const WorldLines& lines(const std::string& name) const {
    return std::get<WorldLines>(pictures.at(name).content);
  }
  std::size_t segments(const std::string& name, uint8_t kind) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(lines(name).segments, [&](const auto& s) { return s.kind == kind; }));
  }
};

Shown show(const std::string& technique, const ParamValues& params) {
  const Registry all = all_techniques();
  const TechniqueInfo& info = find_technique(all, technique);
  Stage s(scene(), 64, 48);
  if (info.sampled) s.light_samples = make_light_samples(s.frame.light, {8, 8});
  const auto built = s.built(info, params);
  Shown shown{s.render(*built, info.sampled), {}};
  auto* illustrated = dynamic_cast<Illustrated*>(built.get());
  if (!illustrated) {
    ADD_FAILURE() << technique << " shows nothing";
    return shown;
  }
  for (Illustration& i : illustrated->illustrations()) {
    if (const auto* pixels = std::get_if<PixelFigures>(&i.content)) {
      EXPECT_EQ(pixels->values.size(), s.pixels()) << i.name;
    }
    EXPECT_EQ(i.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << i.name;
    shown.pictures.emplace(i.name, std::move(i));
  }
  const Rendered again = s.render(*built, info.sampled, false);
  EXPECT_EQ(again.visibility, shown.rendered.visibility) << technique;
  EXPECT_EQ(again.mask, shown.rendered.mask) << technique;
  return shown;
}

TEST(Illustrations, GearsShowsItsGrid) {
  const Shown s = show("gears", {{"assignment", std::string("triangles")}, {"grid_size", int64_t{16}}});
  const Counters& c = s.rendered.counters;
  EXPECT_EQ(s.sum("triangles_per_view_sample"), number(c, "total_assignments"));
  EXPECT_EQ(s.sum("triangles_over_grid"), number(c, "triangles_per_cell_average") * 256);
  const auto& heat = std::get<std::vector<double>>(c.at("view_samples_of_cells"));
  ASSERT_EQ(heat.size(), 256U);
  for (std::size_t i = 0; i < heat.size(); ++i)
    EXPECT_EQ(static_cast<double>(s.figures("view_samples_over_grid")[i]), heat[i]);
  const auto& projections = std::get<GridFigures>(s.pictures.at("projected_volumes").content);
  ASSERT_FALSE(projections.outer.empty());
  ASSERT_EQ(projections.outer.size(), projections.inner.size());
  for (std::size_t i = 0; i < projections.inner.size(); ++i)
    for (const Vec2d& p : projections.inner[i]) {  // the rectangle holds the hull
      EXPECT_GE(p.x, projections.outer[i][0].x);
      EXPECT_GE(p.y, projections.outer[i][0].y);
      EXPECT_LE(p.x, projections.outer[i][2].x);
      EXPECT_LE(p.y, projections.outer[i][2].y);
    }
}

TEST(Illustrations, AliasFreeMapsShowTheirLists) {
  const Shown s = show("alias_free_shadow_map", {{"grid_size", int64_t{32}}});
  const double listed = number(s.rendered.counters, "view_samples_listed");
  EXPECT_EQ(s.sum("list_lengths_over_light"), listed);
  double squares = 0, seen = 0;
  for (const float n : s.figures("list_lengths_over_light")) squares += static_cast<double>(n * n);
  for (const float n : s.figures("list_length_of_view_sample")) seen += !std::isnan(n);
  EXPECT_EQ(seen, listed);
  EXPECT_EQ(s.sum("list_length_of_view_sample"), squares);  // each list's length once for each of its samples
}

TEST(Illustrations, SampleBasedShadowsShowTheirListsAndCasters) {
  const Shown s = show("sample_based_soft", {{"grid_size", int64_t{32}}});
  const Counters& c = s.rendered.counters;
  EXPECT_EQ(s.sum("list_lengths_over_light"),
            number(c, "view_samples_listed") - number(c, "view_samples_outside"));
  EXPECT_GT(s.sum("casters_per_view_sample"), 0);
  EXPECT_GT(s.sum("casters_over_light"), 0);
  // In the light's view neighbours have more casters in common than what is eight rows apart.
  const std::vector<float>& casters = s.figures("casters_over_light");
  const auto apart = [&](std::size_t rows) {
    double sum = 0;
    for (std::size_t i = 0; i + rows * 32 < casters.size(); ++i)
      sum += std::abs(static_cast<double>(casters[i + rows * 32] - casters[i]));
    return sum / static_cast<double>(casters.size() - rows * 32);
  };
  EXPECT_LT(apart(1), 0.5 * apart(8));
}

TEST(Illustrations, StencilVolumesShowSilhouettesAndFill) {
  const Shown s = show("stencil_shadow_volume", {});
  EXPECT_EQ(s.sum("volume_fragments"), number(s.rendered.counters, "fragments"));
  EXPECT_EQ(static_cast<double>(s.segments("volumes_over_scene", 1)), number(s.rendered.counters, "quads"));
}

TEST(Illustrations, SoftShadowVolumesShowWedges) {
  const Shown s = show("soft_shadow_volume", {{"split", int64_t{2}}});
  EXPECT_EQ(s.sum("wedges_per_view_sample"), number(s.rendered.counters, "wedge_fragments"));
  EXPECT_EQ(s.sum("edges_hiding_light"), number(s.rendered.counters, "wedge_pixels"));
  EXPECT_GT(s.segments("wedges_over_scene", 1), 0U);
  EXPECT_GT(s.segments("wedges_over_scene", 0), s.segments("wedges_over_scene", 1));
}

TEST(Illustrations, ShadowMapsShowTexelsAndCascades) {
  const Shown s = show("shadow_map", {{"cascades", int64_t{3}}, {"map_size", int64_t{256}}});
  std::vector<float> sizes;
  for (const float v : s.figures("texel_size"))
    if (std::isfinite(v)) sizes.push_back(v);
  double mean = 0;
  for (const float v : sizes) mean += static_cast<double>(v) / static_cast<double>(sizes.size());
  EXPECT_NEAR(mean, number(s.rendered.counters, "texel_to_pixel_mean"), 1e-4 * mean);
  const auto& maps = std::get<PixelClasses>(s.pictures.at("maps_over_scene").content);
  EXPECT_EQ(maps.names.size(), 3U);
  std::vector<int> seen(3);
  for (const uint8_t k : maps.values)
    if (k != no_class) ++seen.at(k);
  for (const int n : seen) EXPECT_GT(n, 0);
  EXPECT_EQ(s.lines("map_frusta").segments.size(), 36U);
}

}  // namespace
}  // namespace penumbra
