// A device that is full: a technique ends in an error that says what it needed, or gives the picture that it
// gives with memory to spare; and what failed leaves the device ready for the next point.
#include <gtest/gtest.h>

#include "core/error.h"
#include "techniques/registry.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"

namespace penumbra {
namespace {

using testing::device;
using testing::Rendered;
using testing::Stage;

// `closed`: without what soft_shadow_volume refuses.
Frame scene(bool closed = false) {
  Frame f;
  testing::add_box(f.geometry, {-0.6F, 0.2F, -0.5F}, {-0.1F, 0.9F, 0.1F});
  testing::add_box(f.geometry, {0.1F, 0.0F, -0.3F}, {0.5F, 0.6F, 0.3F});
  if (!closed) testing::add_soup(f.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, 400, 0.1F, 3);
  testing::add_ground(f.geometry, 2);
  f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0.3F, 0}, 0.8F, 0.5F);
  f.camera = testing::camera_at({0, 1.5F, 3.5F}, {0, 0.6F, 0});
  return f;
}

struct Variant {
  std::string technique;
  ParamValues params;
};

std::vector<Variant> variants() {
  return {
      {"sample_based_soft", {}},
      {"sample_based_soft", {{"half_spaces", std::string("table")}, {"table_size", int64_t{48}}}},
      {"sample_based_soft", {{"coherent_shading", true}, {"transparency", 0.5}}},
      {"gears", {}},
      {"gears", {{"assignment", std::string("triangles")}}},
      {"line_space", {{"branching", int64_t{5}}, {"depth", int64_t{3}}}},
      {"line_space", {{"branching", int64_t{5}}, {"depth", int64_t{3}}, {"build", std::string("device")}}},
      {"shadow_map", {{"map_size", int64_t{512}}, {"filter", std::string("vsm")}}},
      {"shadow_map_per_sample", {{"map_size", int64_t{256}}}},
      {"soft_shadow_volume", {{"split", int64_t{2}}}},
      {"soft_shadow_volume", {{"coverage", std::string("table")}}},
      {"alias_free_shadow_map", {}},
      {"stencil_shadow_volume", {}}};
}

class MemoryLimit : public ::testing::Test {
 protected:
  void TearDown() override { device().set_memory_limit(0); }
};

TEST_F(MemoryLimit, EndsInAnErrorNeverInAnotherPicture) {
  const Registry all = all_techniques();
  for (const Variant& v : variants()) {
    SCOPED_TRACE(v.technique);
    const TechniqueInfo& info = find_technique(all, v.technique);
    Stage s(scene(v.technique == "soft_shadow_volume"), 64, 48);
    if (info.sampled) s.light_samples = make_light_samples(s.frame.light, {8, 8});
    // The stage's own buffers are there before anything is limited.
    Rendered truth = s.render(*s.built(info, v.params), info.sampled, false);
    const uint64_t before = device().allocated_bytes();
    device().reset_peak();
    truth = s.render(*s.built(info, v.params), info.sampled, false);
    const uint64_t needed = device().peak_bytes() - before;
    ASSERT_GT(needed, 0U);
    ASSERT_EQ(device().allocated_bytes(), before);
    int failed = 0;
    for (int part = 0; part <= 10; ++part) {
      device().set_memory_limit(before + needed * static_cast<uint64_t>(part) / 10 + 1);
      try {
        const Rendered r = s.render(*s.built(info, v.params), info.sampled, false);
        EXPECT_EQ(r.visibility, truth.visibility) << part << " tenths";
        EXPECT_EQ(r.mask, truth.mask) << part << " tenths";
      } catch (const PointError& e) {
        ++failed;
        EXPECT_LT(part, 10) << e.what();
        EXPECT_NE(std::string(e.what()).find("MiB"), std::string::npos) << e.what();
      }
      device().set_memory_limit(0);
      s.passes.abandon();
      EXPECT_EQ(device().allocated_bytes(), before) << part << " tenths leave something behind";
    }
    EXPECT_GE(failed, 5);
    const Rendered after = s.render(*s.built(info, v.params), info.sampled, false);
    EXPECT_EQ(after.visibility, truth.visibility);
  }
}

// Limits of their own: what cannot be held is refused before it is made.
TEST_F(MemoryLimit, AbsurdSizesAreRefused) {
  Stage s(scene(), 64, 48);
  s.light_samples = make_light_samples(s.frame.light, {64, 64});
  const Registry all = all_techniques();
  const auto message = [&](const char* name, const ParamValues& params) -> std::string {
    try {
      s.render(*s.built(find_technique(all, name), params), true, false);
    } catch (const PointError& e) {
      s.passes.abandon();
      return e.what();
    }
    return "";
  };
  const std::string table =
      message("sample_based_soft", {{"half_spaces", std::string("table")}, {"table_size", int64_t{256}}});
  EXPECT_NE(table.find("lookup table"), std::string::npos) << table;
  const std::string tree = message(
      "line_space", {{"branching", int64_t{8}}, {"depth", int64_t{4}}, {"memory_limit_mib", int64_t{20}}});
  EXPECT_NE(tree.find("MiB"), std::string::npos) << tree;
}

}  // namespace
}  // namespace penumbra
