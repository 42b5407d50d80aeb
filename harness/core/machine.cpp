#include "core/machine.h"

#include <cmath>

#include "core/hash.h"

namespace penumbra {
namespace {

using nlohmann::json;

json member(const json& object, const char* name) {
  return object.is_object() && object.contains(name) ? object.at(name) : json();
}

// Knobs that say where files are, or that only tests read, do not change times.
json knobs(const json& environment) {
  json out = json::object();
  if (!environment.is_object()) return out;
  for (const auto& [name, value] : environment.items())
    if (!name.starts_with("PENUMBRA_") || name == "PENUMBRA_VALIDATION" || name == "PENUMBRA_AS_DISCRETE")
      out[name] = value;
  return out;
}

}  // namespace

json machine_of(const json& run) {
  const json cpu = member(run, "cpu"), device = member(run, "vulkan");
  const json memory = member(run, "memory_bytes");
  return {
      {"cpu",
       {{"model", member(cpu, "model")},
        {"cores", member(cpu, "cores")},
        {"usable_cores", member(cpu, "usable_cores")}}},
      // Kernels keep a little for themselves, and not always the same.
      {"memory_gib", memory.is_number() ? json(std::round(memory.get<double>() / double(1 << 30))) : json()},
      {"device",
       {{"name", member(device, "name")},
        {"driver", member(device, "driver")},
        {"driver_version", member(device, "driver_version")}}},
      {"clock", member(run, "clock")},
      {"threads", member(run, "threads")},
      {"build_type", member(member(run, "program"), "build_type")},
      {"environment", knobs(member(run, "environment"))}};
}

std::string machine_fingerprint(const json& machine) {
  return Hasher().text(machine.dump(-1, ' ', false, json::error_handler_t::replace)).hex().substr(0, 16);
}

std::string machine_difference(const json& a, const json& b) {
  std::string text;
  const json left = a.flatten(), right = b.flatten();
  const auto show = [](const json& side, const std::string& key) {
    return side.contains(key) ? side.at(key).dump() : std::string("none");
  };
  const auto add = [&](const std::string& key) {
    if (!text.empty()) text += "; ";
    text += key.substr(1) + ": " + show(left, key) + " against " + show(right, key);
  };
  for (const auto& [key, value] : left.items())
    if (!right.contains(key) || right.at(key) != value) add(key);
  for (const auto& [key, value] : right.items())
    if (!left.contains(key)) add(key);
  return text;
}

}  // namespace penumbra
