// From a sweep to its points: pure functions.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "config/sweep.h"
#include "scene/declaration.h"

namespace penumbra {

using DeclareScene = std::function<SceneDeclaration(const std::string& name)>;

// All points of the sweep in their fixed order: scene, camera, resolution, frame, light, light_size, light
// samples, light pattern, rotation, accumulation, technique entry, parameters. Points that come out twice are
// there once. Throws InputError for scenes, lights and cameras that do not exist.
std::vector<Point> expand(const Sweep& sweep, const DeclareScene& declare);

// Points whose key matches. Throws InputError for a bad expression or when none is left.
std::vector<Point> filter_points(std::vector<Point> points, const std::string& regex,
                                 std::vector<Point>* left_out = nullptr);

// 16 hex digits of everything that determines the result.
std::string point_id(const Point& point);

}  // namespace penumbra
