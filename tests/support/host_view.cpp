#include "tests/support/host_view.h"

#include <random>

#include "core/parallel.h"
#include "tests/support/triangle_tree.h"

namespace penumbra::testing {
namespace {

Vec4f four(Vec3d v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

Vec2f weights(const Triangle& t, Vec3d p) {
  const Vec3d n = cross(t[1] - t[0], t[2] - t[0]);
  const double area = dot(n, n);
  return {static_cast<float>(dot(n, cross(p - t[0], t[2] - t[0])) / area),
          static_cast<float>(dot(n, cross(t[1] - t[0], p - t[0])) / area)};
}

}  // namespace

ViewSamplesHost HostView::host() const {
  return {width, height, triangle, barycentrics, position, origin, geometric_normal, shading_normal};
}

HostView see(const Geometry& geometry, const Camera& camera, int width, int height) {
  const TriangleTree tree(geometry);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  HostView view{width, height, std::vector<uint32_t>(pixels, no_triangle), std::vector<Vec2f>(pixels), {}, {},
                {},    {}};
  for (auto* values : {&view.position, &view.origin, &view.geometric_normal, &view.shading_normal})
    values->assign(pixels, Vec4f{});
  const Vec3d eye(camera.eye), forward = camera.basis().forward;
  const double reach = 4 * (tree.diagonal() + length(eye - tree.triangle(0)[0]));
  const auto eps = static_cast<float>(static_cast<double>(relative_offset) * tree.diagonal());
  parallel_for(pixels, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double x = static_cast<double>(i % static_cast<std::size_t>(width)) + 0.5;
      const double y = static_cast<double>(i / static_cast<std::size_t>(width)) + 0.5;
      const Segment ray{eye, normalize(camera.ray_direction(x, y, width, height)) * reach};
      const auto [hit, t] = tree.nearest(ray);
      if (hit == no_triangle) continue;
      const Triangle& tri = tree.triangle(hit);
      Vec3d n = normalize(cross(tri[1] - tri[0], tri[2] - tri[0]));
      if (dot(n, ray.along) > 0) n = -n;
      const Vec3d p = ray.at(t);
      view.triangle[i] = hit;
      view.barycentrics[i] = weights(tri, p);
      view.position[i] = four(p, dot(p - eye, forward));
      view.geometric_normal[i] = view.shading_normal[i] = four(n, 0);
      const Vec3f o = view.position[i].xyz() + view.geometric_normal[i].xyz() * eps;
      view.origin[i] = {o.x, o.y, o.z, 1};
    }
  });
  return view;
}

void add_triangle(Geometry& geometry, Vec3f a, Vec3f b, Vec3f c) {
  for (const Vec3f& p : {a, b, c}) {
    geometry.indices.push_back(static_cast<uint32_t>(geometry.positions.size()));
    geometry.positions.push_back(p);
    geometry.normals.push_back(normalize(cross(b - a, c - a)));
    geometry.bounds.extend(p);
  }
  geometry.triangle_instance.push_back(0);
  if (geometry.instance_albedo.empty()) geometry.instance_albedo.push_back({0.7F, 0.7F, 0.7F});
}

void add_box(Geometry& geometry, Vec3f lo, Vec3f hi) {
  const auto corner = [&](int i) {
    return Vec3f{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z};
  };
  constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    add_triangle(geometry, corner(f[0]), corner(f[1]), corner(f[2]));
    add_triangle(geometry, corner(f[0]), corner(f[2]), corner(f[3]));
  }
}

void add_ground(Geometry& geometry, float half, float height) {
  add_triangle(geometry, {-half, height, -half}, {half, height, half}, {half, height, -half});
  add_triangle(geometry, {-half, height, -half}, {-half, height, half}, {half, height, half});
}

void add_soup(Geometry& geometry, Vec3f lo, Vec3f hi, int count, float size, uint32_t seed) {
  std::mt19937 random(seed);
  const auto unit = [&] { return static_cast<float>(random() >> 8) * 0x1p-24F; };
  for (int i = 0; i < count; ++i) {
    const Vec3f a{lo.x + (hi.x - lo.x) * unit(), lo.y + (hi.y - lo.y) * unit(),
                  lo.z + (hi.z - lo.z) * unit()};
    const auto near = [&] { return a + Vec3f{unit() - 0.5F, unit() - 0.5F, unit() - 0.5F} * (2 * size); };
    const Vec3f b = near(), c = near();
    add_triangle(geometry, a, b, c);
  }
}

Light point_light(Vec3f position) {
  Light light;
  light.kind = LightKind::point, light.center = position;
  return light;
}

Light directional_light(Vec3f direction) {
  Light light;
  light.kind = LightKind::directional, light.direction = normalize(direction);
  return light;
}

Light spot_light(Vec3f position, Vec3f target, float cone_degrees) {
  Light light;
  light.kind = LightKind::spot, light.center = position, light.direction = normalize(target - position);
  light.cone_degrees = cone_degrees;
  return light;
}

Camera camera_at(Vec3f eye, Vec3f target, float near_plane) {
  Camera camera;
  camera.eye = eye, camera.target = target, camera.near_plane = near_plane;
  return camera;
}

Light rectangle_light(Vec3f center, Vec3f target, float width, float height) {
  Light light;
  light.kind = LightKind::rectangle;
  light.center = center;
  light.direction = normalize(target - center);
  const Vec3f any = std::abs(light.direction.y) < 0.9F ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0};
  const Vec3f u = normalize(cross(any, light.direction)), v = cross(light.direction, u);
  light.edge_u = u * width, light.edge_v = v * height;
  return light;
}

LightSamples regular_samples(const Light& rectangle, int width, int height) {
  LightSamples samples;
  samples.width = width, samples.height = height;
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const Vec3f p =
          rectangle.at((static_cast<float>(column) + 0.5F) / w, (static_cast<float>(row) + 0.5F) / h);
      samples.points.push_back({p.x, p.y, p.z, 1});
    }
  samples.weights.assign(samples.points.size(), 1 / (w * h));
  return samples;
}

LightSamples single_sample(const Light& light) {
  LightSamples samples;
  const Vec3f towards = -light.direction;
  samples.points.push_back(light.kind == LightKind::directional
                               ? Vec4f{towards.x, towards.y, towards.z, 0}
                               : Vec4f{light.center.x, light.center.y, light.center.z, 1});
  samples.weights = {1};
  return samples;
}

}  // namespace penumbra::testing
