#include "compare/match.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "compare/significance.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;

// Parameters that are not a technique's own.
constexpr std::array shared = {"resolution",    "light",         "camera", "light_size",     "mask_size",
                               "light_samples", "light_pattern", "seed",   "light_rotation", "accumulate"};

std::string group_of(const json& point) {
  return point.at("technique").get<std::string>() + '\n' + point.at("scene").get<std::string>() + '\n' +
         point.at("frame").dump();
}

bool agree(const json& a, const json& b) {
  for (const auto& [name, value] : a.at("params").items())
    if (b.at("params").contains(name) && b.at("params").at(name) != value) return false;
  // How many light samples there are is said in one of two ways.
  const auto has = [](const json& p, const char* name) { return p.at("params").contains(name); };
  // Rotation and accumulation are named only where there is one.
  return std::ranges::all_of(std::array{"mask_size", "light_samples", "light_rotation", "accumulate"},
                             [&](const char* name) { return has(a, name) == has(b, name); });
}

// The points of the other side that agree with each; only pairs that are each other's only choice count.
void match_left_over(std::vector<Pair>& pairs, std::vector<const json*>& left) {
  std::unordered_map<std::string, std::vector<const json*>> groups;
  for (const json* point : left) groups[group_of(*point)].push_back(point);
  std::unordered_map<const json*, std::vector<Pair*>> wanted;
  for (Pair& pair : pairs) {
    if (pair.current) continue;
    std::vector<const json*> candidates;
    if (const auto group = groups.find(group_of(*pair.baseline)); group != groups.end())
      std::ranges::copy_if(group->second, std::back_inserter(candidates),
                           [&](const json* p) { return agree(*pair.baseline, *p); });
    for (const json* candidate : candidates)
      wanted[candidate].push_back(candidates.size() == 1 ? &pair : nullptr);
  }
  for (const auto& [point, by] : wanted)
    if (by.size() == 1 && by[0]) {
      by[0]->current = point;
      by[0]->note = "matched by the parameters that both runs have";
    }
  std::erase_if(left, [&](const json* point) {
    const auto it = wanted.find(point);
    return it != wanted.end() && it->second.size() == 1 && it->second[0];
  });
}

bool same_setting(const json& a, const json& b) {
  const json &p = a.at("params"), &q = b.at("params");
  return a.at("scene") == b.at("scene") && a.at("frame") == b.at("frame") &&
         std::ranges::all_of(shared, [&](const char* name) {
           return !p.contains(name) || !q.contains(name) || p.at(name) == q.at(name);
         });
}

// Median frame time; 0 where there is none.
double frame_ms(const json& point) {
  const auto all = figures(point);
  const auto stat = all.find("timing.frame_ms");
  if (stat == all.end()) return 0;
  const auto samples = stat->second.at("samples").get<std::vector<double>>();
  return samples.empty() ? 0 : median(samples);
}

bool can_anchor(const Pair& pair, const Thresholds& thresholds) {
  if (!pair.baseline || !pair.current || pair.baseline->at("technique") != thresholds.anchor) return false;
  if (pair.baseline->at("status") != "ok" || pair.current->at("status") != "ok") return false;
  const json& params = pair.baseline->at("params");
  return frame_ms(*pair.baseline) > 0 && frame_ms(*pair.current) > 0 &&
         std::ranges::all_of(thresholds.anchor_params, [&](const auto& wanted) {
           return params.contains(wanted.first) && params.at(wanted.first) == wanted.second;
         });
}

}  // namespace

std::vector<Pair> match(const RunResults& baseline, const RunResults& current) {
  std::unordered_map<std::string, const json*> by_identity;
  for (const json& point : current.points) by_identity[identity(point)] = &point;
  std::vector<Pair> pairs;
  for (const json& point : baseline.points) {
    Pair& pair = pairs.emplace_back(Pair{&point, nullptr, ""});
    if (const auto it = by_identity.find(identity(point)); it != by_identity.end()) {
      pair.current = it->second;
      by_identity.erase(it);
    }
  }
  std::vector<const json*> left;
  for (const json& point : current.points)
    if (const auto it = by_identity.find(identity(point)); it != by_identity.end() && it->second == &point)
      left.push_back(&point);
  match_left_over(pairs, left);
  for (const json* point : left) pairs.push_back({nullptr, point, ""});
  return pairs;
}

std::vector<const Pair*> anchors(const std::vector<Pair>& pairs, const Thresholds& thresholds) {
  std::vector<const Pair*> out(pairs.size(), nullptr);
  if (thresholds.anchor.empty()) return out;
  struct Candidate {
    const Pair* pair;
    double ms;
  };
  std::unordered_map<std::string, std::vector<Candidate>> by_scene;
  for (const Pair& pair : pairs)
    if (can_anchor(pair, thresholds))
      by_scene[pair.baseline->at("scene")].push_back({&pair, frame_ms(*pair.baseline)});
  // The fastest first, so that the first that fits is the anchor.
  for (auto& [scene, candidates] : by_scene) std::ranges::stable_sort(candidates, {}, &Candidate::ms);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].baseline) continue;
    const auto scene = by_scene.find(pairs[i].baseline->at("scene"));
    if (scene == by_scene.end()) continue;
    const auto found = std::ranges::find_if(scene->second, [&](const Candidate& c) {
      return same_setting(*pairs[i].baseline, *c.pair->baseline);
    });
    if (found != scene->second.end()) out[i] = found->pair;
  }
  return out;
}

}  // namespace penumbra::compare
