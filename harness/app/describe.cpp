#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/describe_scene.h"
#include "compare/thresholds.h"
#include "config/plan.h"
#include "config/schema.h"
#include "core/error.h"

namespace penumbra {
namespace {

using nlohmann::json;

const char* type_name(ParamType type) {
  switch (type) {
    case ParamType::boolean:
      return "boolean";
    case ParamType::integer:
      return "integer";
    case ParamType::number:
      return "number";
    case ParamType::choice:
      return "choice";
  }
  return "";
}

json to_json(const ParamInfo& p) {
  json out = {{"name", p.name}, {"type", type_name(p.type)}, {"default", param_to_json(p.fallback)},
              {"unit", p.unit}, {"symbol", p.symbol},        {"help", p.help},
              {"axis", p.axis}};
  if (p.type == ParamType::integer || p.type == ParamType::number) out["range"] = {p.lo, p.hi};
  if (p.type == ParamType::choice) out["choices"] = p.choices;
  return out;
}

std::vector<std::string> light_names(const TechniqueInfo& info) {
  std::vector<std::string> names;
  for (const LightKind kind : info.lights) names.emplace_back(to_string(kind));
  return names;
}

const char* residence_of(const TechniqueInfo& info) {
  if (info.residence_of) return "by parameters";
  return info.residence == Residence::device ? "device" : "host";
}

json to_json(const TechniqueInfo& info) {
  json params = json::array();
  for (const ParamInfo& p : info.params) params.push_back(to_json(p));
  return {{"name", info.name},           {"title", info.title},     {"sources", info.sources},
          {"lights", light_names(info)}, {"sampled", info.sampled}, {"residence", residence_of(info)},
          {"choosing", info.choosing},   {"parameters", params}};
}

void print_param(const ParamInfo& p) {
  const std::string unit = p.unit.empty() ? "" : " " + p.unit;
  fmt::print("  {} = {}{}: {}\n", p.name, to_text(p.fallback), unit, expectation(p));
  if (!p.help.empty()) fmt::print("      {}\n", p.help);
  if (!p.symbol.empty()) fmt::print("      In the source: {}.\n", p.symbol);
  if (p.axis) fmt::print("      Also a top-level axis of configs.\n");
}

void print_text(const TechniqueInfo& info) {
  fmt::print("{}: {}\n", info.name, info.title);
  fmt::print("Sources: {}\n", fmt::join(info.sources, "; "));
  fmt::print("Lights: {}\n", fmt::join(light_names(info), ", "));
  fmt::print("{}\n",
             info.sampled
                 ? "Sampled: takes mask_size, light_samples, light_pattern and accumulate, and gives masks."
                 : "Not sampled: mask_size, light_samples and light_pattern make no copies.");
  fmt::print("Parameters:{}\n", info.params.empty() ? " none" : "");
  for (const ParamInfo& p : info.params) print_param(p);
  if (info.choosing.empty()) return;
  fmt::print("Choosing:\n");
  for (const std::string& sentence : info.choosing) fmt::print("  {}\n", sentence);
}

void print_schema(const std::string& wanted, const Registry& registry) {
  std::vector<std::string> names;
  std::vector<SchemaFile> files = schema_files(registry);
  files.push_back({"thresholds", compare::thresholds_schema()});
  for (const SchemaFile& file : files) {
    if (file.name == wanted) return fmt::print("{}\n", file.schema.dump(2));
    names.push_back(file.name);
  }
  throw InputError(fmt::format("unknown schema '{}'.{}", wanted, suggestion(wanted, names)));
}

}  // namespace

void add_describe(CLI::App& app, Context& context) {
  struct Options {
    std::string technique, scene, schema;
    bool as_json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("describe", "Parameters, lights and sources of a technique; or what a scene holds");
  sub->add_option("technique", options->technique, "Its name");
  sub->add_flag("--json", options->as_json, "As a JSON object");
  sub->add_option("--scene", options->scene, "A scene's name or file: its meshes, lights and cameras");
  sub->add_option("--schema", options->schema,
                  "Print the JSON Schema of sweep configs (sweep), scene files (scene) or thresholds of "
                  "`compare` (thresholds)");
  sub->callback([options, &context] {
    if (!options->schema.empty()) return print_schema(options->schema, context.registry);
    if (!options->scene.empty()) return describe_scene(context, options->scene, options->as_json);
    if (options->technique.empty())
      throw InputError("describe: found no technique, expected a name; see `penumbra list techniques`.");
    const TechniqueInfo& info = find_technique(context.registry, options->technique);
    if (options->as_json)
      fmt::print("{}\n", to_json(info).dump(2));
    else
      print_text(info);
  });
}

}  // namespace penumbra
