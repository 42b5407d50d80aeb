// The space that the room works in: the light's samples lie about the origin of the x-y plane (all of them in
// it, if they are on a plane), z > 0 is where the light shines, and the unit along x and y is the step
// between neighbouring samples. Seen from a point P with z > 0, what counts is where things project to on the
// plane z = 0.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "samples/light_samples.h"
#include "scene/scene.h"

namespace penumbra::depth_complexity {

struct LightSpace {
  Vec3d origin, x, y, z;  // rows: light_from_world(p) = (dot(x, p - origin), ...)
  Vec3f from_world(Vec3f p) const {
    const Vec3d d = Vec3d(p) - origin;
    return Vec3f(Vec3d{dot(x, d), dot(y, d), dot(z, d)});
  }
  // A grid: sample (column c, row r) lies at (c, r, 0). Else a set: see `points`.
  bool grid = false;
  int columns = 0, rows = 0;  // of a grid
  std::vector<float> points_x, points_y,
      points_z;  // of a set, padded to a multiple of 16 by repeating the last one
  std::size_t sample_count = 0;
  bool planar = true;  // all samples in z = 0; else below it
  Vec3f lo, hi;        // the samples' bounds, a little wider
  float magnitude =
      1;  // the largest coordinate that vertices and samples can have: what rounding errors scale with
};

// Why the light cannot be looked at this way, or nothing.
std::optional<std::string> light_space_fails(const Light& light, const LightSamples& samples,
                                             const Box& bounds);

// `bounds`: the geometry's.
LightSpace make_light_space(const Light& light, const LightSamples& samples, const Box& bounds);

}  // namespace penumbra::depth_complexity
