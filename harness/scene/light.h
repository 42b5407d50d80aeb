// Lights. A light is a shape; how it is sampled is in samples/light_samples.h.
#pragma once
#include <string>
#include <vector>

#include "core/vec.h"

namespace penumbra {

enum class LightKind { point, directional, spot, rectangle, sphere, textured_rectangle, volume };
const char* to_string(LightKind kind);

struct Light {
  LightKind kind = LightKind::point;
  std::string name;
  Vec3f center;  // all but directional; the rectangle's or sphere's centre
  Vec3f direction{0, -1,
                  0};  // unit; the way light travels (directional, spot axis, rectangle's front normal)
  // rectangle: full edge vectors, orthogonal; direction = normalize(cross(edge_u, edge_v)). It spans
  // center + (s - 1/2) edge_u + (t - 1/2) edge_v for s, t in [0, 1] and emits from the side direction points
  // to.
  Vec3f edge_u, edge_v;
  float radius = 0;         // sphere
  float cone_degrees = 30;  // spot: half opening angle
  float intensity = 1;      // radiance or power up to the picture's exposure; never changes visibility
  // textured_rectangle: row-major weights, width x height, >= 0. volume: sample positions and weights.
  int texture_width = 0, texture_height = 0;
  std::vector<float> weights;
  std::vector<Vec3f> points;

  bool is_area() const {
    return kind != LightKind::point && kind != LightKind::directional && kind != LightKind::spot;
  }
  // Corner (s, t) of a rectangle.
  Vec3f at(float s, float t) const { return center + edge_u * (s - 0.5f) + edge_v * (t - 0.5f); }
  // Rectangle: diagonal; sphere: diameter; otherwise 0. In scene units.
  float size() const;
  bool operator==(const Light&) const = default;
};

// The same light with another size (see Light::size), keeping centre and shape. Size 0 makes it a point light
// at its centre. Throws InputError for a negative or not finite size, or one for a light that has no size.
Light with_size(const Light& light, float size);

}  // namespace penumbra
