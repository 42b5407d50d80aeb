// Double-precision segments and triangles: the few predicates that the oracle stands on.
#pragma once
#include <array>
#include <optional>

#include "core/vec.h"

namespace penumbra::testing {

// The points origin + t * along, 0 < t < 1.
struct Segment {
  Vec3d origin, along;
  Vec3d at(double t) const { return origin + along * t; }
  double length() const { return penumbra::length(along); }
};
using Triangle = std::array<Vec3d, 3>;

// The t in (0, 1) at which the segment meets the triangle, its edges included; none when it lies in the
// plane.
std::optional<double> meet(const Segment& s, const Triangle& triangle);

// The shortest vector from a point of the (closed) segment to a point of the edge a-b.
Vec3d to_edge(const Segment& s, Vec3d a, Vec3d b);

// Distance between the closed segment and the triangle; 0 where they meet.
double distance(const Segment& s, const Triangle& triangle);

}  // namespace penumbra::testing
