// The truth, from Embree in robust mode. Shares no code with techniques/: its horizon rule, ray set-up and
// loops are its own.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "scene/scene.h"

namespace penumbra {

// Segments start at P' (offset), or at P with the triangle of the view sample left out (exact).
enum class ReferenceOrigin { offset, exact };

// What a sphere is sampled as: its volume, or the disc through its centre that faces each view sample, as
// techniques take it that project the light.
enum class SphereAs { ball, disc };

// Visibility at exactly the given light samples, as each pixel takes them. Pixels without a view sample, or
// with no light sample above their horizon, are not evaluated and hold 1.
struct MatchedReference {
  std::vector<float> visibility;
  std::vector<uint32_t> mask;  // mask_words per pixel, 1 = blocked (below the horizon counts as blocked)
  std::vector<uint8_t> evaluated;
};

// Embree's structure over one frame's geometry, kept for several references of the same frame.
class ReferenceScene {
 public:
  explicit ReferenceScene(const Geometry& geometry);
  ~ReferenceScene();
  ReferenceScene(const ReferenceScene&) = delete;
  ReferenceScene& operator=(const ReferenceScene&) = delete;

  MatchedReference matched(const ViewSamplesHost& view, const Light& light, const LightSamples& samples,
                           ReferenceOrigin origin) const;

  struct Converged {
    std::vector<float> visibility;
    std::vector<float> standard_error;  // per pixel, of the mean (from independent batches)
    std::vector<uint8_t> evaluated;
    double mean_standard_error = 0;  // root mean square over evaluated pixels
    bool from_cache = false;
  };
  // `n` low-discrepancy samples per view sample in independent scrambled batches. `cache_dir` empty: no
  // cache; else an entry named by the hash of geometry, view samples, light, n, seed and origin is read if
  // whole and valid (checksum), otherwise made and written (failure to write is a message, not an error).
  Converged converged(const ViewSamplesHost& view, const Light& light, int n, uint32_t seed,
                      ReferenceOrigin origin, const std::filesystem::path& cache_dir,
                      SphereAs sphere = SphereAs::ball) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace penumbra
