// The scenes of the design study that the published figures of this suite are held against: same numbers from
// the same random sequence (the 32-bit Mersenne twister, whose output the C++ standard fixes), seed 7.
#include <cmath>
#include <numbers>
#include <random>

#include "scene/generator_table.h"
#include "scene/mesh_builder.h"

namespace penumbra {
namespace {

using std::numbers::pi;

class StudyRandom {
 public:
  double uniform(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(twister_()) / 4294967296.0);
  }

 private:
  std::mt19937 twister_{7};
};

Mesh make_study_city(const GeneratorValues&) {
  Mesh m;
  StudyRandom random;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const double x = (i - 9.5) * 0.16, z = (j - 9.5) * 0.16;
      const double height = 0.1 + 0.9 * std::pow(random.uniform(0, 1), 3);
      const double half = random.uniform(0.04, 0.065);
      add_box(m, {x - half, 0, z - half}, {x + half, height, z + half});
    }
  return m;
}

Mesh make_study_knots(const GeneratorValues&) {
  Mesh m;
  constexpr int segments = 480;
  for (int k = 0; k < 3; ++k) {
    const int p = 2 + k, q = 3 + 2 * k;
    const bool middle = k == 1;
    std::vector<Vec3d> line;
    for (int i = 0; i < segments; ++i) {
      const double t = 2 * pi * i / segments;
      const double r = 0.5 + 0.2 * std::cos(q * t);
      line.push_back(
          {r * std::cos(p * t) * 1.0 + (k - 1) * 1.1,
           0.75 + (middle ? 0.5 : 0) + 0.25 * std::sin(q * t) + (middle ? r * std::sin(p * t) * 0.6 : 0),
           r * std::sin(p * t) + (middle ? -0.6 : 0.1)});
    }
    add_tube(m, line, 0.05, 24, TubeEnds::joined);
  }
  return m;
}

Mesh make_study_nest(const GeneratorValues&) {
  Mesh m;
  StudyRandom random;
  for (int i = 0; i < 2500; ++i) {
    const double at = random.uniform(0, 2 * pi), wall = random.uniform(0.5, 1.0),
                 y = random.uniform(0.05, 0.6);
    const double length = random.uniform(0.5, 1.4), tilt = random.uniform(-0.35, 0.35);
    const double bend = random.uniform(-0.2, 0.2);
    std::vector<Vec3d> line;
    for (int k = 0; k < 9; ++k) {
      const double u = (k / 8.0 - 0.5) * length, a = at + u / wall;
      const double r = wall * (0.55 + 0.6 * y) + bend * u * u;
      line.push_back({r * std::cos(a), 0.05 + y + tilt * u, r * std::sin(a)});
    }
    add_tube(m, line, 0.006, 4, TubeEnds::capped);
  }
  return m;
}

Mesh make_study_hair(const GeneratorValues&) {
  Mesh m;
  StudyRandom random;
  for (int i = 0; i < 7000; ++i) {
    const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * pi);
    const double s = std::sqrt(1 - z * z);
    const Vec3d d{s * std::cos(turn), z, s * std::sin(turn)};
    Vec3d p = Vec3d{0, 1, 0} + d * 0.2;
    const double wx = random.uniform(-1, 1), wy = random.uniform(-1, 1), wz = random.uniform(-1, 1);
    std::vector<Vec3d> line;
    for (int k = 0; k < 9; ++k) {
      line.push_back(p);
      p += normalize(d + Vec3d{wx, wy, wz} * (0.1 * k)) * 0.085;
      if (p.y < 0.02) p.y = 0.02 + 0.001 * k;
    }
    add_tube(m, line, 0.003, 4, TubeEnds::capped);
  }
  return m;
}

}  // namespace

std::vector<Generator> study_generators() {
  return {
      {{"study_city", "The design study's 20 x 20 boxes.", "4800", {}}, make_study_city},
      {{"study_knots", "The design study's three torus knots.", "69120", {}}, make_study_knots},
      {{"study_nest", "The design study's 2500 twigs, capped.", "170000", {}}, make_study_nest},
      {{"study_hair", "The design study's 7000 hairs, capped.", "476000", {}}, make_study_hair},
  };
}

}  // namespace penumbra
