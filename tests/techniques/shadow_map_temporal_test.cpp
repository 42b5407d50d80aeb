// What fitting and warping do to the error while the camera moves: flicker, as the harness measures it.
#include <nlohmann/json.hpp>

#include "run/flicker.h"
#include "shadow_map_scenes.h"

namespace penumbra::test {
namespace {

struct Seen {
  std::unique_ptr<Stage> stage;
  std::vector<float> error;
};

Frame step_of(int frame) {
  Frame f = box_and_sphere(directional_light({-0.5f, -1, -0.3f}));
  add_ground(f.geometry, 12, -0.01f);
  for (int i = 0; i < 8; ++i) add_box(f.geometry, {float(i) - 4, 0, 1.5f}, {float(i) - 3.6f, 0.8f, 1.9f});
  const float along = 0.021f * float(frame);
  f.camera.eye = {0.5f + along, 3.5f, 6 - 0.4f * along},
  f.camera.target = f.camera.eye + Vec3f{-0.5f, -3, -6};
  return f;
}

Seen look(int frame, const ParamValues& given) {
  Seen seen;
  seen.stage = std::make_unique<Stage>(step_of(frame), 200, 150);
  const Rendered r = seen.stage->render(given);
  const MatchedReference& truth = seen.stage->reference();
  seen.error = run::signed_error(r.visibility, truth.visibility, truth.evaluated);
  return seen;
}

// Mean over the frames of a short walk.
double flicker_of(const char* fit, int64_t cascades = 1) {
  const ParamValues given{{"pcf_kernel", int64_t{1}}, {"slope_bias", 1.5}, {"constant_bias", 2e-5},
                          {"map_size", int64_t{128}}, {"fit", fit},        {"cascades", cascades}};
  constexpr int frames = 6;
  double sum = 0;
  Seen before = look(0, given);
  for (int frame = 1; frame <= frames; ++frame) {
    Seen now = look(frame, given);
    const auto past =
        run::past_pixels(now.stage->view.host(), before.stage->view.host(), before.stage->frame);
    sum += run::flicker(now.error, before.error, past).get<double>();
    before = std::move(now);
  }
  return sum / frames;
}

// A map that covers the scene stands still, and a stable one moves by whole texels: their errors stay where
// they are. A tight one is laid anew in every frame.
TEST(ShadowMapTemporal, StableFitFlickersLessThanTightWhileTheCameraWalks) {
  const double none = flicker_of("none"), tight = flicker_of("tight"), stable = flicker_of("stable");
  EXPECT_LT(stable, 0.5 * tight);
  EXPECT_LT(none, 0.5 * tight);
  EXPECT_GT(tight, 1e-3);
}

}  // namespace
}  // namespace penumbra::test
