#include "config/expand.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <unordered_map>

namespace penumbra {
namespace {

// The axes of one scene: the sweep's values, the scene's own where the sweep has none, the general default
// else.
struct SceneAxes {
  std::vector<Extent> resolutions;
  std::vector<SampleCount> samples;
  std::vector<LightPattern> patterns;
  std::vector<double> light_sizes;
  std::vector<LightRotation> rotations;
  std::vector<int> accumulations;
};

// An entry in one scene: its own lights and cameras, or the sweep's.
struct EntryAxes {
  const SweepEntry* entry = nullptr;
  std::vector<const Light*> lights;
  std::vector<std::string> cameras;
  std::vector<ParamValues> params;
};

template <class T>
bool contains(const std::vector<T>& list, const T& value) {
  return std::ranges::find(list, value) != list.end();
}

// All values that any entry has, in the order in which they come.
template <class T>
std::vector<T> union_of(const std::vector<EntryAxes>& entries, std::vector<T> EntryAxes::*values) {
  std::vector<T> all;
  for (const EntryAxes& e : entries)
    for (const T& value : e.*values)
      if (!contains(all, value)) all.push_back(value);
  return all;
}

JsonNode default_node(const SceneDeclaration& scene, const std::string& axis) {
  return JsonDocument::parse(scene.axis_defaults.at(axis),
                             scene.file.string() + " (defaults of " + axis + ")")
      .root();
}

template <class T, class Reader>
std::vector<T> values_or_default(const std::vector<T>& values, const SceneDeclaration& scene,
                                 const std::string& axis, Reader read, T fallback) {
  if (!values.empty()) return values;
  if (!scene.axis_defaults.contains(axis)) return {fallback};
  return {read(default_node(scene, axis))};
}

std::vector<SampleCount> sample_counts(const Sweep& sweep, const SceneDeclaration& scene) {
  if (sweep.samples.empty() && !scene.axis_defaults.contains("mask_size") &&
      scene.axis_defaults.contains("light_samples"))
    return {read_light_samples(default_node(scene, "light_samples"))};
  return values_or_default(sweep.samples, scene, "mask_size", read_mask_size, SampleCount{});
}

std::vector<const Light*> chosen_lights(const std::vector<NamedValue>& chosen,
                                        const SceneDeclaration& scene) {
  std::vector<std::string> names;
  for (const Light& light : scene.lights) names.push_back(light.name);
  if (chosen.empty()) return {&scene.lights.front()};
  std::vector<const Light*> lights;
  for (const NamedValue& wanted : chosen) {
    const auto it = std::ranges::find(names, wanted.name);
    if (it == names.end())
      wanted.node.fail(fmt::format("a light of the scene '{}'", scene.name), suggestion(wanted.name, names));
    lights.push_back(&scene.lights[static_cast<std::size_t>(it - names.begin())]);
  }
  return lights;
}

std::vector<std::string> chosen_cameras(const std::vector<NamedValue>& chosen,
                                        const SceneDeclaration& scene) {
  if (chosen.empty()) return {scene.cameras.front()};
  std::vector<std::string> cameras;
  for (const NamedValue& wanted : chosen) {
    if (std::ranges::find(scene.cameras, wanted.name) == scene.cameras.end())
      wanted.node.fail(fmt::format("a camera of the scene '{}'", scene.name),
                       suggestion(wanted.name, scene.cameras));
    cameras.push_back(wanted.name);
  }
  return cameras;
}

SceneAxes scene_axes(const Sweep& sweep, const SceneDeclaration& scene) {
  return {
      values_or_default(sweep.resolutions, scene, "resolution", read_resolution, Extent{512, 512}),
      sample_counts(sweep, scene),
      values_or_default(sweep.patterns, scene, "light_pattern", read_light_pattern, LightPattern::regular),
      values_or_default(sweep.light_sizes, scene, "light_size", read_light_size, -1.0),
      sweep.rotations.empty() ? std::vector{LightRotation::none} : sweep.rotations,
      sweep.accumulations.empty() ? std::vector{1} : sweep.accumulations};
}

// Every combination of an entry's parameters: its own values, then the sweep's axes, the scene's defaults,
// the technique's. The last parameter varies fastest.
std::vector<ParamValues> combinations(const Sweep& sweep, const SweepEntry& entry,
                                      const SceneDeclaration& scene) {
  std::vector<ParamValues> out{{}};
  for (const ParamInfo& info : entry.info->params) {
    std::vector<ParamValue> values{info.fallback};
    if (const auto own = entry.params.find(info.name); own != entry.params.end())
      values = own->second;
    else if (const auto axis = sweep.axes.find(info.name); axis != sweep.axes.end())
      values = axis->second;
    else if (scene.axis_defaults.contains(info.name))
      values = {read_param(default_node(scene, info.name), info)};
    std::vector<ParamValues> longer;
    if (static_cast<int64_t>(out.size() * values.size()) > limits::points)
      throw InputError(fmt::format("the parameters of {} make more than {} combinations.", entry.info->name,
                                   limits::points));
    for (const ParamValues& given : out)
      for (const ParamValue& value : values) {
        longer.push_back(given);
        longer.back()[info.name] = value;
      }
    out = std::move(longer);
  }
  return out;
}

bool has_size(const Light& light) {
  return light.kind == LightKind::rectangle || light.kind == LightKind::sphere ||
         light.kind == LightKind::textured_rectangle;
}

// Axes that make no difference take one value, so that their copies become duplicates.
void drop_idle_axes(Point& point, const Light& light) {
  if (!has_size(light)) point.light_size = -1;
  const float size = point.light_size < 0 ? light.size() : static_cast<float>(point.light_size);
  const bool one_sample = !light.is_area() || (has_size(light) && size == 0);
  if (point.sampled && !one_sample) {
    if (point.light_samples.count > 0) point.light_samples.width = point.light_samples.height = 1;
    return;
  }
  point.light_samples.width = point.light_samples.height = 1;
  point.light_samples.count = 0;
  point.light_samples.pattern = LightPattern::regular;
  point.light_samples.rotation = LightRotation::none;
  point.accumulate = 1;
}

class Expansion {
 public:
  Expansion(const Sweep& sweep, const DeclareScene& declare) : sweep_(sweep), declare_(declare) {}

  std::vector<Point> run() {
    std::vector<NamedValue> scenes;
    const auto add = [&](const std::vector<NamedValue>& more) {
      for (const NamedValue& scene : more)
        if (std::ranges::none_of(scenes, [&](const NamedValue& s) { return s.name == scene.name; }))
          scenes.push_back(scene);
    };
    add(sweep_.scenes);
    for (const SweepEntry& entry : sweep_.entries) add(entry.scenes);
    for (const NamedValue& scene : scenes) {
      const std::vector<const SweepEntry*> entries = entries_in(scene.name);
      if (entries.empty()) continue;
      const SceneDeclaration declaration = declared(scene);
      expand_scene(scene.name, declaration, entries);
    }
    return std::move(points_);
  }

 private:
  // Errors about a scene's name are told where the name stands; those about its file name the file.
  SceneDeclaration declared(const NamedValue& scene) const {
    try {
      return declare_(scene.name);
    } catch (const InputError& e) {
      scene.node.complain(e.what());
    }
  }

  std::vector<const SweepEntry*> entries_in(const std::string& scene) const {
    std::vector<const SweepEntry*> entries;
    for (const SweepEntry& entry : sweep_.entries)
      if (std::ranges::any_of(entry.scenes.empty() ? sweep_.scenes : entry.scenes,
                              [&](const NamedValue& s) { return s.name == scene; }))
        entries.push_back(&entry);
    return entries;
  }

  void expand_scene(const std::string& name, const SceneDeclaration& scene,
                    const std::vector<const SweepEntry*>& taken) {
    const SceneAxes axes = scene_axes(sweep_, scene);
    std::vector<EntryAxes> entries;
    for (const SweepEntry* entry : taken)
      entries.push_back({entry, chosen_lights(entry->lights.empty() ? sweep_.lights : entry->lights, scene),
                         chosen_cameras(entry->cameras.empty() ? sweep_.cameras : entry->cameras, scene),
                         combinations(sweep_, *entry, scene)});
    check_count(axes, entries);
    Point p;
    p.scene = name;
    p.seed = sweep_.seed;
    for (const std::string& camera : union_of(entries, &EntryAxes::cameras))
      for (const Extent& resolution : axes.resolutions)
        for (int frame = 0; frame < sweep_.frames; ++frame) {
          p.camera = camera, p.width = resolution.width, p.height = resolution.height, p.frame = frame;
          expand_light(p, axes, entries);
        }
  }

  void expand_light(Point p, const SceneAxes& axes, const std::vector<EntryAxes>& entries) {
    for (const Light* light : union_of(entries, &EntryAxes::lights))
      for (const double size : axes.light_sizes)
        for (const SampleCount& samples : axes.samples)
          for (const LightPattern pattern : axes.patterns) {
            p.light = light->name, p.light_size = size;
            p.light_samples = {samples.width, samples.height, samples.count, pattern, sweep_.seed};
            expand_rotation(p, *light, axes, entries);
          }
  }

  void expand_rotation(Point p, const Light& light, const SceneAxes& axes,
                       const std::vector<EntryAxes>& entries) {
    for (const LightRotation rotation : axes.rotations)
      for (const int accumulate : axes.accumulations) {
        p.light_samples.rotation = rotation, p.accumulate = accumulate;
        for (const EntryAxes& e : entries)
          if (contains(e.cameras, p.camera) && contains(e.lights, &light)) expand_entry(p, light, e);
      }
  }

  void expand_entry(const Point& like, const Light& light, const EntryAxes& e) {
    for (const ParamValues& values : e.params) {
      Point p = like;
      p.technique = e.entry->info->name;
      p.sampled = e.entry->info->sampled;
      p.params = values;
      p.title = e.entry->title, p.caption = e.entry->caption;
      drop_idle_axes(p, light);
      p.id = point_id(p);
      const auto [known, is_new] = seen_.emplace(p.id, points_.size());
      if (is_new)
        points_.push_back(std::move(p));
      else if (Point& first = points_[known->second]; first.title.empty())  // named by a later entry
        first.title = p.title, first.caption = p.caption;
    }
  }

  void check_count(const SceneAxes& axes, const std::vector<EntryAxes>& entries) {
    double count = 0;
    for (const EntryAxes& e : entries)
      count += static_cast<double>(e.params.size()) * static_cast<double>(e.lights.size()) *
               static_cast<double>(e.cameras.size());
    count *= sweep_.frames;
    for (const std::size_t n : {axes.resolutions.size(), axes.samples.size(), axes.patterns.size(),
                                axes.light_sizes.size(), axes.rotations.size(), axes.accumulations.size()})
      count *= static_cast<double>(n);
    bound_ += count;
    if (bound_ > static_cast<double>(limits::points))
      throw InputError(fmt::format("{}: the sweep expands to {:.0f} points or more, expected at most {}.",
                                   sweep_.scenes.front().node.location(), bound_, limits::points));
  }

  const Sweep& sweep_;
  const DeclareScene& declare_;
  std::vector<Point> points_;
  std::unordered_map<std::string, std::size_t> seen_;  // id -> index of the point
  double bound_ = 0;
};

}  // namespace

std::vector<Point> expand(const Sweep& sweep, const DeclareScene& declare) {
  return Expansion(sweep, declare).run();
}

std::vector<Point> filter_points(std::vector<Point> points, const std::string& regex,
                                 std::vector<Point>* left_out) {
  if (regex.empty()) return points;
  std::regex expression;
  try {
    expression.assign(regex, std::regex::ECMAScript);
  } catch (const std::regex_error& e) {
    throw InputError(fmt::format(
        "--filter '{}': found no regular expression ({}), expected one such as 'gears/.*mask_size=16'.",
        regex, e.what()));
  }
  std::vector<Point> kept;
  for (const Point& p : points)
    if (std::regex_search(p.key(), expression))
      kept.push_back(p);
    else if (left_out)
      left_out->push_back(p);
  if (kept.empty())
    throw InputError(fmt::format("--filter '{}': found no match among {} points, expected one such as '{}'.",
                                 regex, points.size(), points.empty() ? "" : points.front().key()));
  return kept;
}

}  // namespace penumbra
