// From candidates to masks: one ray decides whether all samples of least relative depth complexity are seen.
#pragma once
#include <span>

#include "samples/view_samples.h"
#include "techniques/depth_complexity_sampling/kernel.h"
#include "techniques/depth_complexity_sampling/occlusion.h"

namespace penumbra::depth_complexity {

class RayJudge final : public Judge {
 public:
  // What stays between frames of a case: the light's samples.
  void assign(const Light& light, const LightSamples& samples, const LightSpace& space);
  // For one frame.
  void bind(const EmbreeHierarchy& hierarchy, const ViewSamplesHost& view, std::span<float> visibility,
            std::span<uint32_t> mask);

  enum class Horizon { above, across, below };
  // Where the light's samples lie beyond any rounding; `below` also where the light does not shine.
  Horizon horizon(std::size_t pixel) const;
  // A pixel without a ray: no view sample, or no light.
  void write_whole(std::size_t pixel, bool blocked) const;

  // A pixel by a ray for each light sample above its horizon; returns how many.
  std::size_t trace_each(std::size_t pixel) const;

  void judge(const ViewPoint* points, std::size_t count, Scratch& scratch) const override;
  uint64_t bytes() const;

 private:
  struct Choice {
    std::size_t sample = 0;
    bool inner = true;  // its neighbours are candidates as well
  };
  bool shines_on(Vec3f position) const;
  void keep_above_horizon(std::size_t pixel, uint64_t* words) const;
  Choice choose(const uint64_t* words) const;
  Choice choose_middle(const uint64_t* words) const;
  bool verify(std::size_t pixel, Choice first, bool blocked, uint64_t* words, Scratch& scratch) const;
  bool blocked(std::size_t pixel, std::size_t sample) const;
  void write(std::size_t pixel, const uint64_t* visible) const;
  std::size_t write_packed(const uint64_t* visible, uint32_t* mask) const;
  std::size_t write_unpacked(const uint64_t* visible, uint32_t* mask) const;
  std::size_t sample_at(std::size_t word, int bit) const;

  Light light_;
  std::vector<float> x_, y_, z_, weights_;
  Box bounds_;
  float cone_cosine_ = -1;
  bool uniform_ = true;
  bool grid_ = false, packed_ = false;
  Choice middle_;              // among all samples
  std::vector<uint64_t> all_;  // words with all samples in them
  std::size_t columns_ = 1, used_words_ = 1, mask_words_ = 1, samples_ = 1;
  const EmbreeHierarchy* hierarchy_ = nullptr;
  const ViewSamplesHost* view_ = nullptr;
  std::span<float> visibility_;
  std::span<uint32_t> mask_;
};

}  // namespace penumbra::depth_complexity
