#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "gpu/device.h"

namespace penumbra {
namespace {

using nlohmann::json;

json techniques(const Context& context) {
  json out = json::array();
  for (const TechniqueInfo& info : context.registry)
    out.push_back(
        {{"name", info.name}, {"title", info.title}, {"sources", info.sources}, {"sampled", info.sampled}});
  return out;
}

json devices() {
  json out = json::array();
  for (const gpu::DeviceInfo& d : gpu::list_devices())
    out.push_back({{"index", d.index},
                   {"name", d.name},
                   {"driver", d.driver},
                   {"driver_version", d.driver_version},
                   {"api_version", d.api_version},
                   {"software", d.software},
                   {"usable", d.missing.empty()},
                   {"missing", d.missing}});
  return out;
}

json names(const std::vector<std::string>& list) {
  json out = json::array();
  for (const std::string& name : list) out.push_back({{"name", name}});
  return out;
}

void print_line(const json& entry) {
  if (entry.contains("title"))
    fmt::print("{:<26} {}\n", entry["name"].get<std::string>(), entry["title"].get<std::string>());
  else if (entry.contains("index"))
    fmt::print("{} {} ({} {}, Vulkan {}){}\n", entry["index"].get<int>(), entry["name"].get<std::string>(),
               entry["driver"].get<std::string>(), entry["driver_version"].get<std::string>(),
               entry["api_version"].get<std::string>(),
               entry["usable"].get<bool>() ? "" : ": not usable: " + entry["missing"].get<std::string>());
  else
    fmt::print("{}\n", entry["name"].get<std::string>());
}

}  // namespace

void add_list(CLI::App& app, Context& context) {
  struct Options {
    std::string what;
    bool as_json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("list", "List techniques, scenes, configs or devices");
  sub->add_option("what", options->what, "techniques|scenes|configs|devices")->required();
  sub->add_flag("--json", options->as_json, "As a JSON array");
  sub->callback([options, &context] {
    const std::vector<std::string> kinds{"techniques", "scenes", "configs", "devices"};
    json entries;
    if (options->what == "techniques")
      entries = techniques(context);
    else if (options->what == "scenes")
      entries = names(context.scene_names());
    else if (options->what == "configs")
      entries = names(context.config_names());
    else if (options->what == "devices")
      entries = devices();
    else
      throw InputError(
          fmt::format("list: found '{}', expected one of {}.{}", options->what, fmt::join(kinds, ", "),
                      nearest_name(options->what, kinds).empty() ? "" : suggestion(options->what, kinds)));
    if (options->as_json)
      fmt::print("{}\n", entries.dump(2));
    else
      for (const json& entry : entries) print_line(entry);
  });
}

}  // namespace penumbra
