// The provenance of a run in sentences that a paper can take over.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/machine.h"
#include "run/latex.h"

namespace penumbra::run {
namespace {

using nlohmann::json;

std::string text_at(const json& object, const char* pointer, const std::string& fallback = "unknown") {
  const json::json_pointer at(pointer);
  if (!object.contains(at) || object.at(at).is_null()) return fallback;
  const json& value = object.at(at);
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string machine_text(const json& machine) {
  return fmt::format("{} ({} cores used, {} GiB), Vulkan device {} with driver {} {}, {} threads",
                     text_at(machine, "/cpu/model"), text_at(machine, "/cpu/usable_cores"),
                     text_at(machine, "/memory_gib"), text_at(machine, "/device/name"),
                     text_at(machine, "/device/driver"), text_at(machine, "/device/driver_version"),
                     text_at(machine, "/threads"));
}

std::string machines_text(const json& run) {
  if (!run.contains("machines")) return machine_text(machine_of(run));
  std::string text;
  for (const auto& [fingerprint, machine] : run.at("machines").items())
    text += (text.empty() ? "" : "; and ") + machine_text(machine);
  return text;
}

std::string knobs_text(const json& run) {
  const json knobs = machine_of(run).at("environment");
  std::string text;
  for (const auto& [name, value] : knobs.items())
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", name,
                        value.is_string() ? value.get<std::string>() : value.dump());
  return text.empty() ? "" : " Driver environment: " + text + ".";
}

}  // namespace

std::string provenance_text(const json& run, const RecordSource& source) {
  std::size_t points = 0, ok = 0, outliers = 0, drifting = 0;
  source([&](const json& p) {
    if (p.at("frame").is_null()) return;
    ++points, ok += p.at("status") == "ok";
    const json timing = p.value("timing", json::object());
    outliers += timing.value("outliers", std::size_t{0}) > 0, drifting += timing.value("drifts", false);
  });
  const std::string version = text_at(run, "/program/version"), commit = text_at(run, "/program/commit", "");
  const std::string from = commit.empty() ? version : version + ", commit " + commit;
  const std::string year = text_at(run, "/started").substr(0, 4);
  return fmt::format(
      "The sweep \"{}\" was measured with Penumbra {} (built with {}, {}, flags {}), Embree {}, on {}; {}, "
      "{}.{} "
      "It ran from {} to {}; {} of its {} points gave results. Times are medians over at least {} "
      "repetitions "
      "(fewer where max_time_s ended them) after {} warm-up frames, with 95 % bootstrap intervals, taken by "
      "{}; {} points "
      "have outliers, {} drift. Errors are against a reference of {} light samples.\n\n"
      "@software{{penumbra,\n  title = {{Penumbra: a benchmark suite for shadow-rendering techniques}},\n"
      "  version = {{{}}},\n  year = {{{}}}\n}}\n",
      text_at(run, "/name"), from, text_at(run, "/program/compiler"), text_at(run, "/program/build_type"),
      text_at(run, "/program/flags"), text_at(run, "/embree"), machines_text(run), text_at(run, "/os/name"),
      text_at(run, "/os/kernel"), knobs_text(run), text_at(run, "/started"), text_at(run, "/ended"), ok,
      points, text_at(run, "/config/measure/repetitions"), text_at(run, "/config/measure/warmup"),
      text_at(run, "/clock"), outliers, drifting, text_at(run, "/config/reference/light_samples"), from,
      year);
}

}  // namespace penumbra::run
