// Spelling of types in structs that GLSL and C++ both include (scalar layout: C++'s own, as long as no bool
// or double follows an odd number of words; assert sizes and offsets).
#ifndef PENUMBRA_GPU_SHARED_H
#define PENUMBRA_GPU_SHARED_H

#ifdef __cplusplus
#include <vulkan/vulkan.h>

#include <cstdint>

#include "core/vec.h"
#define PENUMBRA_ADDRESS(buffer_type) VkDeviceAddress
namespace penumbra::gpu::shared {
using uint = uint32_t;
using vec2 = Vec2f;
using vec3 = Vec3f;
using vec4 = Vec4f;
using mat4 = Mat4f;
}  // namespace penumbra::gpu::shared
#else
#define PENUMBRA_ADDRESS(buffer_type) buffer_type
#endif

#endif
