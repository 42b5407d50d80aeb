// View samples made on the host, without a device: for tests of what only reads ViewSamplesHost.
#pragma once
#include <vector>

#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "scene/scene.h"

namespace penumbra::testing {

struct HostView {
  int width = 0, height = 0;
  std::vector<uint32_t> triangle;
  std::vector<Vec2f> barycentrics;
  std::vector<Vec4f> position, origin, geometric_normal, shading_normal;
  ViewSamplesHost host() const;
};

// The first triangle (of 0 < t) that each pixel's ray meets, by the oracle's tree in double precision.
HostView see(const Geometry& geometry, const Camera& camera, int width, int height);

// Appends the triangles of a box, wound to face outwards, or one triangle; keeps bounds up to date.
void add_box(Geometry& geometry, Vec3f lo, Vec3f hi);
void add_triangle(Geometry& geometry, Vec3f a, Vec3f b, Vec3f c);
// A square in the plane y = `height` that reaches `half` units from the y axis, facing up.
void add_ground(Geometry& geometry, float half, float height = 0);
// `count` random triangles of about `size` inside the box.
void add_soup(Geometry& geometry, Vec3f lo, Vec3f hi, int count, float size, uint32_t seed);

Light point_light(Vec3f position);
Light directional_light(Vec3f direction);
// `cone_degrees`: half opening angle.
Light spot_light(Vec3f position, Vec3f target, float cone_degrees);
// A rectangle around `center` that faces `target`, with edges of the given lengths.
Light rectangle_light(Vec3f center, Vec3f target, float width, float height);
Camera camera_at(Vec3f eye, Vec3f target, float near_plane = 0.01f);
// k x k cell centres, as LightSamples documents them; for tests that should not depend on harness/samples.
LightSamples regular_samples(const Light& rectangle, int width, int height);
// One sample: a point or spot light's centre, or the direction towards a directional light.
LightSamples single_sample(const Light& light);

}  // namespace penumbra::testing
