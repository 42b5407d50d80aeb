// @name@ behind the technique contract, against the matched reference and the oracle in double
// precision.
#include "techniques/@name@/@name@.h"

#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"

namespace penumbra {
namespace {

using testing::Rendered;
using testing::Stage;

Frame soup_on_ground() {
  Frame frame;
  testing::add_ground(frame.geometry, 2);
  testing::add_soup(frame.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, 60, 0.25F, 11);
  frame.camera.eye = {0, 1.5F, 3.5F}, frame.camera.target = {0, 0.6F, 0};
  frame.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);
  return frame;
}

TEST(@Name@, EachBitThatDiffersFromTheReferenceIsATie) {
  Stage stage(soup_on_ground(), 61, 43);
  stage.light_samples = make_light_samples(stage.frame.light, {8, 6});
  const Rendered r = stage.render(@name@_technique(), {});
  const MatchedReference& m = stage.reference(ReferenceOrigin::offset);
  const testing::Differences d =
      testing::explain_differences(testing::BruteForce(stage.frame.geometry), stage.frame.light,
                                   stage.light_samples, stage.view.host(), r.mask, m.mask, m.evaluated);
  EXPECT_EQ(d.unexplained, 0U) << d.differing << " of " << d.bits << " bits differ";
  EXPECT_GT(d.bits, 1000U);
}

TEST(@Name@, DispatchesDoNotMatter) {
  Stage stage(soup_on_ground(), 61, 43);
  stage.light_samples = make_light_samples(stage.frame.light, {5, 5});
  const Rendered whole = stage.render(@name@_technique(), {});
  const Rendered parts = stage.render(@name@_technique(), {{"triangles_per_dispatch", int64_t{7}}});
  EXPECT_EQ(whole.mask, parts.mask);
  EXPECT_EQ(whole.visibility, parts.visibility);
  EXPECT_GT(testing::number(parts.counters, "dispatches"), testing::number(whole.counters, "dispatches"));
}

}  // namespace
}  // namespace penumbra
