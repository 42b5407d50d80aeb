// The one shadow ray per view sample that fixes the constant: Embree in robust mode.
#pragma once
#include <cstdint>

#include "core/vec.h"
#include "techniques/common/embree_hierarchy.h"

namespace penumbra::depth_complexity {

inline constexpr std::size_t rays_per_call = 16;

// Segments from origins to light samples in world space.
struct alignas(64) Segments {
  float x[rays_per_call], y[rays_per_call], z[rays_per_call];           // origins
  float to_x[rays_per_call], to_y[rays_per_call], to_z[rays_per_call];  // light samples
};

// Bit i: segment i, one of `wanted`, meets a triangle.
uint32_t blocked_segments(const EmbreeHierarchy& hierarchy, const Segments& segments, uint32_t wanted);

}  // namespace penumbra::depth_complexity
