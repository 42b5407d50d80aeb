// The plane that receives: found among the instances, no device.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "samples/light_samples.h"
#include "scene/scene.h"

namespace penumbra::planar_shadow {

struct Receiver {
  uint32_t instance = 0;
  Vec4d plane;  // unit normal, offset: dot(plane, (x, 1)) is the distance of x
  double area = 0;
  Box bounds;
  double tilt = 0;  // largest sine between a triangle's normal and the plane's
};

// The instance `wanted`, or with -1 the flat one of largest area (the first of equals); or why there is none.
// Flat: every vertex within 1e-5 of the scene's diagonal of one plane.
std::variant<Receiver, std::string> find_receiver(const Geometry& geometry, int wanted);

// Whether the same light samples are above the horizon of every point of the receiver as the eye sees it,
// rounding included; then `dark` is the mask of those that are below. `emission`: as in light_emission.h; of
// a rectangle the front is left to each point, where it is the same for all of its samples.
bool same_horizon(const Receiver& receiver, const LightSamples& samples, Vec4f emission, Vec3d eye,
                  std::vector<uint32_t>& dark);

// The triangles of all other instances, as indices.
std::vector<uint32_t> occluder_indices(const Geometry& geometry, uint32_t receiver);

// Every point goes to the plane along its ray from the light (position, 1; or the unit direction towards a
// light at infinity, 0): h Q - (plane . Q) L with h = |plane . L|, up to the sign that keeps w positive for
// points between the plane and the light [Blinn 1988]. Zero where the light lies in the plane.
Mat4d onto_plane(Vec4d plane, Vec4d light);

}  // namespace penumbra::planar_shadow
