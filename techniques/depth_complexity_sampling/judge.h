// From candidates to masks: one ray decides whether all samples of least relative depth complexity are seen.
#pragma once
#include <span>

#include "techniques/common/host_masks.h"
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

  // A pixel by a ray for each light sample above its horizon; returns how many.
  std::size_t trace_each(std::size_t pixel) const;

  void judge(const ViewPoint* points, std::size_t count, Scratch& scratch) const override;
  const HostMasks& masks() const { return masks_; }
  uint64_t bytes() const { return masks_.bytes(); }

 private:
  struct Choice {
    std::size_t sample = 0;
    bool inner = true;  // its neighbours are candidates as well
  };
  Choice choose(const uint64_t* words) const;
  Choice choose_middle(const uint64_t* words) const;
  bool verify(std::size_t pixel, Choice first, bool blocked, uint64_t* words, Scratch& scratch) const;
  bool blocked(std::size_t pixel, std::size_t sample) const;

  HostMasks masks_;
  Choice middle_;  // among all samples
  const EmbreeHierarchy* hierarchy_ = nullptr;
};

}  // namespace penumbra::depth_complexity
