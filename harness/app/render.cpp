// `penumbra render`: one picture of one technique, without a sweep.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "config/expand.h"
#include "config/sweep.h"
#include "core/error.h"
#include "image/image.h"
#include "run/still.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct RenderArguments {
  std::string scene, technique, out;
  std::vector<std::string> values;
};

const std::vector<std::string> axes = {"resolution",    "mask_size",      "light_samples",
                                       "light_pattern", "light_size",     "light",
                                       "camera",        "light_rotation", "accumulate"};

// 512x256 is [512, 256]; what is JSON is taken as such, the rest as a word.
json value_of(const std::string& text) {
  int width = 0, height = 0, used = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &used) == 2 &&
      used == static_cast<int>(text.size()))
    return {width, height};
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

// The config that the arguments stand for; `frame` comes apart, for a config has a number of frames.
json config_of(const RenderArguments& arguments, const TechniqueInfo& info, int& frame) {
  json config = {{"name", "render"}, {"scene", arguments.scene}, {"reference", {{"light_samples", 0}}}};
  json params = json::object();
  std::vector<std::string> names = axes;
  names.insert(names.end(), {"frame", "seed"});
  for (const ParamInfo& param : info.params) names.push_back(param.name);
  for (const std::string& argument : arguments.values) {
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    if (equals == std::string::npos || std::ranges::find(names, name) == names.end())
      throw InputError(
          fmt::format("render: found '{}', expected PARAM=VALUE.{}", argument, suggestion(name, names)));
    const json value = value_of(argument.substr(equals + 1));
    if (name == "frame") {
      if (!value.is_number_unsigned())
        throw InputError(fmt::format("render: frame: found {}, expected an integer from 0.", value.dump()));
      frame = value;
    } else if (name == "seed" || std::ranges::find(axes, name) != axes.end()) {
      // A list of one: [512, 256] by itself would be two resolutions.
      config[name] = name == "seed" ? value : json::array({value});
    } else {
      params[name] = value;
    }
  }
  config["techniques"] = {{{"technique", info.name}, {"params", params}}};
  return config;
}

Point point_of(const RenderArguments& arguments, const Context& context) {
  const TechniqueInfo& info = find_technique(context.registry, arguments.technique);
  int frame = 0;
  const json config = config_of(arguments, info, frame);
  const Sweep sweep = parse_sweep(JsonDocument::parse(config.dump(), "render"), context.registry, "render");
  std::vector<Point> points =
      expand(sweep, [&](const std::string& name) { return declare_scene(name, context.scene_search); });
  if (points.size() != 1)
    throw InputError(fmt::format(
        "render: the arguments mean {} pictures, expected one; `penumbra run` makes many.", points.size()));
  points.front().frame = frame;
  return points.front();
}

void write_picture(const fs::path& out, const run::Still& still) {
  if (out.extension() == ".exr")
    write_exr_gray(out, still.width, still.height, still.visibility);
  else
    write_png(out, tonemap(still.shaded, still.width, still.height));
}

void render_command(const RenderArguments& arguments, Context& context) {
  const fs::path out =
      arguments.out.empty()
          ? fs::path(fs::path(arguments.scene).stem().string() + "-" + arguments.technique + ".png")
          : fs::path(arguments.out);
  if (out.extension() != ".png" && out.extension() != ".exr")
    throw InputError(
        fmt::format("-o {}: found the ending '{}', expected .png (the shaded picture) or .exr (visibility).",
                    out.string(), out.extension().string()));
  const Point point = point_of(arguments, context);
  const run::Still still = run::render_still(point, context.registry, context.scene_search, context.device);
  if (!still.unsupported.empty()) {
    fmt::print(stderr, "penumbra: unsupported: {}\n", still.unsupported);
    context.exit_code = exit_points_failed;
    return;
  }
  write_picture(out, still);
  for (const auto& pass : still.passes) fmt::print("{:<24} {:>10.3f} ms\n", pass.name, pass.ms);
  fmt::print("{}\n", out.string());
}

}  // namespace

void add_render(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* sub = app.add_subcommand("render", "Render one picture");
  sub->add_option("SCENE", arguments->scene, "Scene file, or its name")->required();
  sub->add_option("TECHNIQUE", arguments->technique, "Technique")->required();
  sub->add_option("VALUES", arguments->values,
                  "PARAM=VALUE: of the technique, or resolution, mask_size, light, ...");
  sub->add_option("-o,--out", arguments->out,
                  "IMAGE.png (shaded) or IMAGE.exr (visibility); default SCENE-TECHNIQUE.png");
  sub->callback([arguments, &context] { render_command(*arguments, context); });
}

}  // namespace penumbra
