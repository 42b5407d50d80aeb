// A small registry and stand-in scenes, so that expansion is tested as the pure function it is.
#pragma once
#include <string>
#include <vector>

#include "config/expand.h"
#include "config/sweep.h"

namespace penumbra::test {

// gears (sampled, grid_size is an axis), shadow_map (not sampled), ray_tracing (sampled).
const Registry& registry();
// "area" (rectangle "key", sphere "bulb", point "spark"; cameras "front", "side"), "lamp" (point light
// "spark"; camera "front"), "defaults" (as area, with axis defaults).
SceneDeclaration declare(const std::string& name);

std::vector<Point> expand_text(const std::string& config);
std::vector<std::string> keys(const std::vector<Point>& points);
// The message of the InputError that the config causes; "accepted" if none.
std::string error_of_config(const std::string& config);

}  // namespace penumbra::test
