// Fine, irregular geometry: hair, twigs, grass.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/generator_table.h"
#include "scene/mesh_builder.h"
#include "scene/random.h"

namespace penumbra {
namespace {

using std::numbers::pi;

Vec3d random_direction(Pcg32& random) {
  const double z = random.uniform(-1, 1), a = random.uniform(0, 2 * pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(a), z, r * std::sin(a)};
}

TubeEnds ends(const GeneratorValues& v) { return v.integer("caps") ? TubeEnds::capped : TubeEnds::open; }

// Each strand leaves the inner sphere along its normal and wanders.
Mesh make_hair_ball(const GeneratorValues& v) {
  Mesh m;
  Pcg32 random(static_cast<uint64_t>(v.integer("seed")));
  const int segments = v.integer("segments");
  const double inner = v.number("inner_radius"), step = (v.number("radius") - inner) / segments;
  for (int i = 0; i < v.integer("strands"); ++i) {
    Vec3d heading = random_direction(random);
    Vec3d p = heading * inner;
    std::vector<Vec3d> line{p};
    for (int s = 0; s < segments; ++s) {
      heading = normalize(heading + random_direction(random) * v.number("curl"));
      p += heading * step;
      line.push_back(p);
    }
    add_tube(m, line, v.number("thickness") / 2, v.integer("sides"), ends(v));
  }
  return m;
}

// One twig: an arc of the bowl, a paraboloid, tilted out of its circle and with a bend of its own.
std::vector<Vec3d> twig(Pcg32& random, double radius, double height, int segments) {
  const double at = random.uniform(0, 2 * pi), out = 0.12 + 0.88 * std::sqrt(random.uniform(0, 1));
  const double wall = radius * out * random.uniform(0.9, 1.1);
  // Of about one length everywhere, so that twigs near the middle cross it.
  const double length = radius * random.uniform(0.5, 1.3), curl = random.uniform(0.6, 1);
  const double tilt = random.uniform(-0.35, 0.35) * out, kink = random.uniform(-0.03, 0.03);
  const double phase = random.uniform(0, 2 * pi),
               level = height * out * out + radius * random.uniform(0, 0.06);
  const Vec3d center{wall * std::cos(at), 0, wall * std::sin(at)}, along{-std::sin(at), 0, std::cos(at)};
  std::vector<Vec3d> line;
  for (int s = 0; s <= segments; ++s) {
    const double u = double(s) / segments - 0.5, way = length * u;
    // Between a chord and the bowl's circle, by `curl`.
    const double sag = curl * out * way * way / (2 * wall) * (wall > length / 2 ? 1 : 0.5);
    const Vec3d inward = center * (-sag / wall);
    line.push_back(center + along * way + inward + along * (radius * kink * std::sin(9 * u + phase)) +
                   Vec3d{0, level + radius * (tilt * u + kink * std::cos(7 * u + phase)), 0});
  }
  return line;
}

Mesh make_bird_nest(const GeneratorValues& v) {
  Mesh m;
  Pcg32 random(static_cast<uint64_t>(v.integer("seed")));
  const double radius = v.number("radius"), height = v.number("height");
  for (int i = 0; i < v.integer("twigs"); ++i)
    add_tube(m, twig(random, radius, height, v.integer("segments")), v.number("thickness") / 2,
             v.integer("sides"), ends(v));
  const int eggs = v.integer("eggs");
  const double egg = radius * 0.2;
  for (int i = 0; i < eggs; ++i) {
    const double a = 2 * pi * i / eggs + 0.4, r = eggs > 1 ? egg * 1.15 : 0;
    add_ellipsoid(m, {r * std::cos(a), egg * 1.1 + radius * 0.08, r * std::sin(a)},
                  {egg * 0.85, egg * 1.1, egg * 0.85}, v.integer("egg_columns"), v.integer("egg_rows"));
  }
  return m;
}

// A blade of five triangles: two bent quads and a tip.
void add_blade(Mesh& m, Pcg32& random, Vec3d foot, double height, double width) {
  const double facing = random.uniform(0, 2 * pi), lean = random.uniform(0.1, 0.6);
  height *= random.uniform(0.6, 1);
  const Vec3d across{std::cos(facing), 0, std::sin(facing)}, out{-across.z, 0, across.x};
  const auto spine = [&](double t) { return foot + Vec3d{0, height * t, 0} + out * (height * lean * t * t); };
  const auto normal = [&](double t) {
    return normalize(cross(across, Vec3d{0, 1, 0} + out * (2 * lean * t)));
  };
  const auto base = static_cast<uint32_t>(m.positions.size());
  for (int row = 0; row < 3; ++row) {
    const double t = row * 0.4, half = width / 2 * (1 - 0.3 * row);
    add_vertex(m, spine(t) - across * half, normal(t));
    add_vertex(m, spine(t) + across * half, normal(t));
  }
  const uint32_t tip = add_vertex(m, spine(1), normal(1));
  for (uint32_t row = 0; row < 2; ++row) {
    const uint32_t a = base + 2 * row;
    add_triangle(m, a, a + 1, a + 3);
    add_triangle(m, a, a + 3, a + 2);
  }
  add_triangle(m, base + 4, base + 5, tip);
}

Mesh make_ring_field(const GeneratorValues& v) {
  Mesh m;
  Pcg32 random(static_cast<uint64_t>(v.integer("seed")));
  const double size = v.number("size"), ring = v.number("ring_radius"), tube = v.number("tube_radius");
  const int rings = v.integer("rings"), segments = v.integer("ring_segments");
  const int side = static_cast<int>(std::ceil(std::sqrt(double(rings))));
  for (int i = 0; i < rings; ++i) {
    const Vec3d center{((i % side + 0.5) / side - 0.5) * size, ring + tube,
                       ((i / side + 0.5) / side - 0.5) * size};
    const double turn = random.uniform(0, pi);
    const Vec3d across{std::cos(turn), 0, std::sin(turn)};
    std::vector<Vec3d> line;
    for (int s = 0; s < segments; ++s) {
      const double a = 2 * pi * s / segments;
      line.push_back(center + across * (ring * std::cos(a)) + Vec3d{0, ring * std::sin(a), 0});
    }
    add_tube(m, line, tube, v.integer("ring_sides"), TubeEnds::joined, cross(across, Vec3d{0, 1, 0}));
  }
  for (int i = 0; i < v.integer("blades"); ++i) {
    const double x = random.uniform(-size / 2, size / 2), z = random.uniform(-size / 2, size / 2);
    add_blade(m, random, {x, 0, z}, v.number("blade_height"), v.number("blade_width"));
  }
  return m;
}

}  // namespace

std::vector<Generator> natural_generators() {
  return {
      {{"hair_ball",
        "Strands that wander off a sphere.",
        "2 sides segments strands + caps 2 (sides - 2) strands",
        {{"strands", "", 367, 1, 1e6, true},
         {"segments", "of a strand", 20, 1, 1024, true},
         {"sides", "of a strand", 3, 3, 64, true},
         {"inner_radius", "where strands begin", 0.3, 1e-6, 1e6, false},
         {"radius", "where a straight strand would end", 1, 1e-6, 1e6, false},
         {"thickness", "of a strand", 0.01, 1e-6, 1e6, false},
         {"curl", "how far each segment may turn", 0.35, 0, 10, false},
         {"caps", "1: strands have ends, the mesh is closed", 0, 0, 1, true},
         {"seed", "", 1, 0, 4294967295.0, true}}},
       make_hair_ball},
      {{"bird_nest",
        "Bent twigs woven round a bowl, and eggs in it.",
        "2 sides segments twigs + caps 2 (sides - 2) twigs + 2 egg_columns (egg_rows - 1) eggs",
        {{"twigs", "", 1000, 1, 1e6, true},
         {"segments", "of a twig", 12, 1, 1024, true},
         {"sides", "of a twig", 6, 3, 64, true},
         {"radius", "of the bowl", 1, 1e-6, 1e6, false},
         {"height", "of the bowl", 0.5, 1e-6, 1e6, false},
         {"thickness", "of a twig", 0.02, 1e-6, 1e6, false},
         {"eggs", "", 3, 0, 64, true},
         {"egg_columns", "", 32, 3, 1024, true},
         {"egg_rows", "", 16, 2, 1024, true},
         {"caps", "1: twigs have ends, the mesh is closed", 0, 0, 1, true},
         {"seed", "", 1, 0, 4294967295.0, true}}},
       make_bird_nest},
      {{"ring_field",
        "Upright rings in grass.",
        "2 ring_segments ring_sides rings + 5 blades",
        {{"rings", "", 1, 0, 10000, true},
         {"ring_segments", "", 64, 3, 4096, true},
         {"ring_sides", "", 32, 3, 4096, true},
         {"ring_radius", "", 1, 1e-6, 1e6, false},
         {"tube_radius", "", 0.2, 1e-6, 1e6, false},
         {"blades", "of grass", 75000, 0, 1e7, true},
         {"blade_height", "", 0.25, 1e-6, 1e6, false},
         {"blade_width", "", 0.015, 1e-6, 1e6, false},
         {"size", "of the field", 6, 1e-6, 1e6, false},
         {"seed", "", 1, 0, 4294967295.0, true}}},
       make_ring_field},
  };
}

}  // namespace penumbra
