// A light as hard-shadow techniques see it, in double precision: one position or direction, and the frames in
// which it looks at the scene. No device.
#pragma once
#include <bit>
#include <cmath>
#include <numbers>

#include "core/vec.h"
#include "scene/light.h"

namespace penumbra {

// Widest |u| and |v| (tangents) of one view from the light: a full opening angle of 127 degrees. Lights whose
// view samples need more get the six faces of a cube.
inline constexpr double widest_tangent = 2;
// Faces overlap by this much, so that a view sample on the border between two is within the bounds of either.
inline constexpr double face_tangent = 1.0001;

struct LightPoint {
  Vec4d towards;      // position, 1; or the unit direction towards a light at infinity, 0
  Vec3d axis;         // spot: the cone's axis; directional: the way light travels; rectangle: its front
  double cosine;      // of the half angle about the axis in which light leaves; -1: everywhere
  bool spot = false;  // the cone is narrow enough for one view about the axis (widest_tangent)
  bool at_infinity() const { return towards.w == 0; }
  // Half the width of a view about the axis that holds the cone.
  double cone_tangent() const { return std::sqrt(1 - cosine * cosine) / cosine; }
  Vec4f device_towards() const { return to_float(towards); }
  Vec4f device_emission() const { return to_float({axis.x, axis.y, axis.z, cosine}); }

 private:
  static Vec4f to_float(Vec4d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(v.w)};
  }
};

// Area lights are seen from their centre.
inline LightPoint light_point(const Light& light) {
  const Vec3d d = normalize(Vec3d(light.direction)), c(light.center);
  LightPoint p{{c.x, c.y, c.z, 1}, d, -1};
  if (light.kind == LightKind::directional) p.towards = {-d.x, -d.y, -d.z, 0};
  if (light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle) p.cosine = 0;
  if (light.kind == LightKind::spot) {
    p.cosine = std::cos(light.cone_degrees * std::numbers::pi / 180);
    p.spot = p.cosine > 0 && p.cone_tangent() < widest_tangent;
  }
  return p;
}

// Right-handed: right x down = forward, so that what is drawn is not mirrored.
struct LightFrame {
  Vec3d right, down, forward;
};

// `hint` projected onto the view points along `down` (any axis when it is parallel to `forward`).
inline LightFrame light_frame(Vec3d forward, Vec3d hint) {
  forward = normalize(forward);
  Vec3d down = hint - forward * dot(hint, forward);
  if (!(length(down) > 1e-6 * length(hint))) {
    const Vec3d a{std::abs(forward.x), std::abs(forward.y), std::abs(forward.z)};
    const Vec3d axis = a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0}
                       : a.y <= a.z             ? Vec3d{0, 1, 0}
                                                : Vec3d{0, 0, 1};
    down = axis - forward * dot(axis, forward);
  }
  down = normalize(down);
  return {cross(down, forward), down, forward};
}

// Faces of a cube about the light, 2 axis + (negative side ? 1 : 0): its own axes, for only then do they
// meet.
inline LightFrame cube_frame(int face) {
  Vec3d forward, hint;
  forward[face / 2] = face % 2 ? -1 : 1, hint[(face / 2 + 1) % 3] = 1;
  return light_frame(forward, hint);
}

// Undoes the order-preserving integers of shaders/ordered_float.glsl.
inline double from_ordered(uint32_t u) {
  return std::bit_cast<float>(u & 0x80000000U ? u & 0x7fffffffU : ~u);
}

}  // namespace penumbra
