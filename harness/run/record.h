// Points and their results as JSON: what travels between supervisor and worker and what stands in the result
// files.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "config/plan.h"

namespace penumbra::run {

inline constexpr int schema_version = 1;

// Everything that the worker needs to know of a point, and back.
nlohmann::json to_json(const Point& point);
Point point_from_json(const nlohmann::json& json);

// The part of a point's record that the plan alone determines: id, technique, scene, frame, params, command.
nlohmann::json record_of(const Point& point);
// The record of a point that has no result. Status: "failed", "unsupported" or "timeout".
nlohmann::json record_without_result(const Point& point, std::string_view status, const std::string& message);

// The same point in whatever frame: names a sequence.
std::string sequence_key(const Point& point);
// Points of one view share scene, camera, resolution and frame; its name is for file names.
std::string view_key(const Point& point);

// One line, never NaN or Infinity (null instead), invalid UTF-8 of foreign messages replaced.
std::string dump_line(const nlohmann::json& json);

}  // namespace penumbra::run
