// How things move: values at keyframes with straight lines between them, and procedural deformations. Frames
// are whole numbers; keyframes may lie anywhere.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "core/vec.h"

namespace penumbra {

// When the keyframes of a track are. Before the first and after the last the ends hold; a looping track
// starts again at its first keyframe when it reaches the last.
struct Timeline {
  std::vector<double> frames;  // strictly ascending, at least one
  bool loop = false;

  struct Place {
    std::size_t from, to;  // keyframes
    double t;              // in [0, 1]
  };
  Place at(int frame) const;
};

template <class T>
Vec3<T> mix(Vec3<T> a, Vec3<T> b, T t) {
  return a * (T(1) - t) + b * t;
}
inline double mix(double a, double b, double t) { return a * (1 - t) + b * t; }

struct CameraTrack {
  std::size_t camera = 0;
  Timeline timeline;
  std::vector<Vec3f> eye, target;
};

struct LightTrack {
  std::size_t light = 0;
  Timeline timeline;
  std::vector<Vec3f> center;     // empty: does not move
  std::vector<Vec3f> direction;  // empty: does not turn
};

// Rigid but for a uniform scale: T(translate) T(pivot) R(axis, degrees) S(scale) T(-pivot), after the
// instance's own transform.
struct InstanceTrack {
  std::size_t instance = 0;
  Timeline timeline;
  Vec3d axis{0, 1, 0}, pivot{0, 0, 0};
  std::vector<Vec3d> translate;
  std::vector<double> degrees, scale;

  Mat4d world_from_world(int frame) const;
};

enum class DeformationKind { twist, bend, wave };

// Moves the vertices of a mesh in its own space, before the instance's transform. With h in [0, 1] the height
// of a point within the mesh's bounds along `axis`, and s = sin(2 pi frame / period):
//   twist  turns about the axis through the bounds' centre by amplitude s h (degrees);
//   bend   leans towards `direction` by turning about the foot's centre by amplitude s h (degrees);
//   wave   shifts along `direction` by amplitude sin(2 pi (p[axis] / wavelength - frame / period)) (mesh
//   units).
struct Deformation {
  std::size_t instance = 0;
  DeformationKind kind = DeformationKind::twist;
  int axis = 1, direction = 0;  // 0, 1, 2 for x, y, z; different
  double amplitude = 0, period = 60, wavelength = 1;

  Vec3d apply(Vec3d p, const Box& bounds, int frame) const;
  // The normal of the deformed surface at p, from the derivative of apply().
  Vec3d apply_to_normal(Vec3d p, Vec3d normal, const Box& bounds, int frame) const;
};

struct Animation {
  std::vector<CameraTrack> cameras;
  std::vector<LightTrack> lights;
  std::vector<InstanceTrack> instances;
  std::vector<Deformation> deformations;
};

}  // namespace penumbra
