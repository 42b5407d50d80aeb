// What every stage of a frame shares: constants, counts, view samples and triangles as kernels fetch them.
#pragma once
#include "gpu/buffer.h"
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/common/view_texels.h"
#include "techniques/sample_based_soft/light_setup.h"
#include "techniques/sample_based_soft/params.h"
#include "techniques/sample_based_soft/shaders/constants.h"

namespace penumbra::sample_based_soft {

inline constexpr uint32_t wide_lanes = 64;  // kernels without subgroup operations
inline constexpr uint64_t groups_for(uint64_t items, uint64_t lanes) { return (items + lanes - 1) / lanes; }

struct FrameState {
  Params params;
  gpu::Device* device = nullptr;
  uint32_t lanes = 8;  // of a workgroup that is one subgroup
  uint32_t width = 0, height = 0;
  LightSetup light;

  gpu::Buffer frame, header, header_host, light_samples, weights;
  TexelArray frame_texels, sample_texels;
  ViewTexels view_texels;
  gpu::Buffer places;   // of clustered light samples
  gpu::Buffer walked;   // masks as walked, where they are not packed
  gpu::Buffer through;  // visibility of transparent triangles, per pixel

  uint32_t pixels() const { return width * height; }
  uint32_t grid_size() const { return static_cast<uint32_t>(params.grid_size); }
  uint32_t tiles() const {
    const uint32_t across = (grid_size() + tile_side - 1) / tile_side;
    return across * across;
  }
  uint32_t lists() const { return tiles() * tile_lists + 1; }

  void set_light(const Case& c, gpu::PassRecorder& passes);
  // Constants up, counts and masks cleared: the first pass of a frame.
  void begin(const RenderInput& in, gpu::PassRecorder& passes);
  // Waits for the device; what it counted so far.
  Header read_header(gpu::PassRecorder& passes);
  bool transparent() const { return params.transparency > 0; }
  // A walk writes visibility itself: masks have their final layout, and all light samples one weight.
  bool walk_resolves() const;
  uint64_t masks_address(const RenderInput& in) const;
  uint64_t bytes() const;
};

// A count of two words.
inline double wide(const uint32_t (&words)[2]) { return words[0] + 4294967296.0 * words[1]; }

}  // namespace penumbra::sample_based_soft
