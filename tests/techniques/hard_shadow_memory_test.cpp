// What every hard-shadow technique owes about memory: after the first frame of a case it allocates nothing on
// the device, not even when the camera moves on; and what it reports is what it holds.
#include "stencil_planar_stage.h"
#include "techniques/alias_free_shadow_map/alias_free_shadow_map.h"
#include "techniques/planar_shadow/planar_shadow.h"
#include "techniques/shadow_map/shadow_map.h"
#include "techniques/shadow_map_per_sample/shadow_map_per_sample.h"
#include "techniques/stencil_shadow_volume/stencil_shadow_volume.h"

namespace penumbra::test {
namespace {

struct Entry {
  const char* name;
  TechniqueInfo info;
  ParamValues params;
};

std::vector<Entry> entries() {
  const auto text = [](const char* s) { return ParamValue(std::string(s)); };
  std::vector<Entry> all;
  const auto add = [&](const char* name, const TechniqueInfo& info, ParamValues params) {
    if (info.name.starts_with("shadow_map")) params.emplace("map_size", int64_t{256});
    all.push_back({name, info, std::move(params)});
  };
  const TechniqueInfo map = shadow_map_technique(), volumes = stencil_shadow_volume_technique();
  add("shadow_map", map, {});
  add("shadow_map_warped", map, {{"warp", text("lispsm")}});
  add("shadow_map_logarithmic", map, {{"warp", text("log")}});
  add("shadow_map_stable_cascades", map, {{"cascades", int64_t{4}}, {"fit", text("stable")}});
  add("shadow_map_pcss", map, {{"filter", text("pcss")}});
  add("shadow_map_moments", map, {{"filter", text("msm")}, {"moment_filtering", text("anisotropic")}});
  add("shadow_map_exponential", map, {{"filter", text("evsm")}, {"filter_size", int64_t{5}}});
  add("shadow_map_per_sample", shadow_map_per_sample_technique(), {});
  add("planar_shadow", planar_shadow_technique(), {});
  for (const char* variant : {"z_pass", "z_fail", "zp_plus"})
    for (const char* extrusion : {"silhouette", "per_triangle"})
      add(variant, volumes, {{"variant", text(variant)}, {"extrusion", text(extrusion)}});
  add("stencil_wide", volumes, {{"counter", text("wide")}});
  add("stencil_per_sample", stencil_shadow_volume_per_sample_technique(), {});
  for (const char* origin : {"exact", "offset"})
    add("alias_free", alias_free_shadow_map_technique(), {{"origin", text(origin)}});
  return all;
}

class HardShadowMemory : public ::testing::TestWithParam<Entry> {};
INSTANTIATE_TEST_SUITE_P(Of, HardShadowMemory, ::testing::ValuesIn(entries()), [](const auto& entry) {
  return std::string(entry.param.name) + "_" + std::to_string(entry.index);
});

Frame frame() {
  Frame f;
  testing::add_ground(f.geometry, 6);
  testing::add_box(f.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1});
  Geometry& g = f.geometry;
  g.triangle_instance.assign(g.triangle_count(), 1);
  g.triangle_instance[0] = g.triangle_instance[1] = 0;
  g.instance_albedo.assign(2, {0.5f, 0.5f, 0.5f});
  f.light = testing::rectangle_light({1, 5, 2}, {0, 0, 0}, 1, 1);
  f.camera = camera_at({2, 4, 6}, {0, 0, 0});
  return f;
}

TEST_P(HardShadowMemory, IsReportedAndDoesNotGrowAfterTheFirstFrame) {
  const auto& [name, info, given] = GetParam();
  Stage stage(frame(), 96, 64);
  const bool sampled = info.sampled;
  if (sampled) stage.light_samples = make_light_samples(stage.frame.light, {3, 3});
  gpu::ensure(stage.mask, device(), 4 * stage.pixels(), gpu::Memory::device, "masks");
  const uint64_t before = device().allocated_bytes();
  const std::unique_ptr<Technique> technique = stage.built(info, given);
  stage.render_only(*technique, sampled);
  const uint64_t held = device().allocated_bytes();
  // Small buffers of parameters may be left out of the report, pages may round it.
  EXPECT_GE(technique->structure_bytes() + 65536, held - before);
  EXPECT_LE(technique->structure_bytes(), held - before + 65536);
  EXPECT_GT(technique->structure_bytes(), 4 * stage.pixels());
  for (int step = 1; step <= 2; ++step) {
    stage.frame.camera.eye.x += 0.3f;
    stage.frame.changes = {};
    stage.view.render(stage.frame, stage.geometry, stage.passes);
    stage.passes.take_times();
    stage.render_only(*technique, sampled);
    EXPECT_EQ(device().allocated_bytes(), held) << "frame " << step;
  }
}

// One map after the other: memory does not follow the number of light samples.
TEST(HardShadowMemory, OfAMapPerSampleIsThatOfOneMap) {
  std::vector<uint64_t> bytes;
  for (const int side : {1, 5}) {
    Stage stage(frame(), 96, 64);
    stage.light_samples = make_light_samples(stage.frame.light, {side, side});
    gpu::ensure(stage.mask, device(), 4 * stage.pixels(), gpu::Memory::device, "masks");
    const auto technique = stage.built(shadow_map_per_sample_technique(), {{"map_size", int64_t{512}}});
    const Rendered r = stage.render(*technique, true);
    bytes.push_back(technique->structure_bytes());
    EXPECT_GE(number(r.counters, "map_bytes"), 512 * 512 * 4);
    EXPECT_GE(technique->structure_bytes(), uint64_t(number(r.counters, "map_bytes")));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

}  // namespace
}  // namespace penumbra::test
