// The visible part of a rectangle light in closed form, by clipping polygons in double precision.
#pragma once
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/light.h"

namespace penumbra::testing {

using Polygon = std::vector<Vec3d>;  // convex, planar, either winding

// The part of a convex polygon where dot(normal, x) >= offset.
Polygon clip(const Polygon& polygon, Vec3d normal, double offset);
double area(const Polygon& polygon);

// The share of the rectangle's area that is above the horizon of (position, normal), faces the position, and
// is not behind any of the polygons. Seen from the position the polygons must not overlap: the faces of one
// convex solid that face it (see faces_towards), or solids side by side.
double rectangle_visibility(const Light& rectangle, Vec3d position, Vec3d normal,
                            std::span<const Polygon> occluders);

// The same for the disc through `center` that faces the position, as a share of the disc's area.
double disc_visibility(Vec3d center, double radius, Vec3d position, Vec3d normal,
                       std::span<const Polygon> occluders);

// The faces of a box that face `position`: disjoint as seen from there.
std::vector<Polygon> faces_towards(Vec3d position, Vec3d lo, Vec3d hi);

}  // namespace penumbra::testing
