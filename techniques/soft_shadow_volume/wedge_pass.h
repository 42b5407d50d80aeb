// From silhouettes to visibility: sides of volumes and wedges drawn into sums, and their reading.
#pragma once
#include "techniques/soft_shadow_volume/params.h"
#include "techniques/soft_shadow_volume/silhouettes.h"
#include "techniques/soft_shadow_volume/tables.h"

namespace penumbra::soft_shadow_volume {

// Sums per pixel: volumes crossed from the eye, and coverage by wedges.
inline constexpr VkFormat sum_format = VK_FORMAT_R32G32_SFLOAT;
// Whether the device can add up such sums in a picture.
bool sums_supported(gpu::Device& device);

struct WedgeCounts {
  double fragments = 0, pixels = 0;  // drawn; of these, where the edge hides a part of the light
  double whole_picture = 0;          // wedges that no hull bounds
};

class WedgePass {
 public:
  explicit WedgePass(const Params& params) : params_(params) {}
  void setup(gpu::Device& device, uint32_t shape, gpu::PassRecorder& passes);
  // Once per light. Pass "upload_texture".
  void set_light(gpu::Device& device, const Light& light, gpu::PassRecorder& passes);
  // Once per frame. Pass "view_copy".
  void begin(const RenderInput& in, gpu::PassRecorder& passes);
  // One part of the light. Passes "classify", "wedges", "hard_shadow", "coverage", "resolve".
  void run(const RenderInput& in, const Silhouettes& silhouettes, const Part& part, bool first,
           gpu::PassRecorder& passes);
  // Statistics of one part: draws its wedges again.
  WedgeCounts count(const RenderInput& in, const Silhouettes& silhouettes, const Part& part,
                    gpu::PassRecorder& passes);
  // What such statistics are made of.
  struct Wedges {
    std::vector<Vec2f> sums;  // per pixel: wedges drawn, and those whose edge hides a part of the light
    std::vector<Wedge> wedges;
  };
  Wedges read(const RenderInput& in, const Silhouettes& silhouettes, const Part& part,
              gpu::PassRecorder& passes);
  uint64_t bytes() const;

 private:
  void ensure(const RenderInput& in, gpu::PassRecorder& passes);
  void classify(const RenderInput& in, const Part& part, gpu::PassRecorder& passes);
  void make_wedges(const RenderInput& in, const Silhouettes& silhouettes, const Part& part,
                   gpu::PassRecorder& passes);
  void draw_sides(gpu::Commands& commands, const RenderInput& in, const Silhouettes& silhouettes,
                  const Part& part) const;
  void draw_wedges(gpu::Commands& commands, const RenderInput& in, const Silhouettes& silhouettes,
                   const Part& part, bool counting) const;
  void resolve(const RenderInput& in, const Silhouettes& silhouettes, const Part& part, bool first,
               gpu::PassRecorder& passes) const;

  Params params_;
  uint32_t shape_ = 0;
  Tables tables_;
  gpu::ComputePipeline classify_pipeline_, wedge_pipeline_, resolve_pipeline_;
  gpu::GraphicsPipeline sides_, near_caps_;
  // One for each class of view samples: the whole light above the horizon, a part of it.
  gpu::GraphicsPipeline coverage_[2], counting_[2];
  gpu::Image depth_[2];
  gpu::Buffer depth_buffer_[2], classed_;
  gpu::Image position_, normal_, sums_, texture_;
  gpu::Buffer texels_;
  gpu::Buffer sum_buffer_, wedges_, indices_;
};

}  // namespace penumbra::soft_shadow_volume
