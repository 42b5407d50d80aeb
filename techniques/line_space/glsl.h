// What shaders/overlap.glsl and shaders/traverse.glsl need to compile as C++.
#pragma once
#include <algorithm>
#include <cmath>

#include "techniques/line_space/shaders/shared.h"

#define precise
#define VEC3(x, y, z) \
  vec3 { x, y, z }

namespace penumbra::line_space {

inline float floor(float v) { return std::floor(v); }
inline float abs(float v) { return std::abs(v); }
inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline float clamp(float v, float lo, float hi) { return min(max(v, lo), hi); }

}  // namespace penumbra::line_space
