#include "run/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "run/record.h"

namespace penumbra::run {
namespace {

// Of a first guess: Embree's rate on two cores, read-back, metrics and pictures of a point.
constexpr double guessed_s_per_work = 2.5e-8, guessed_overhead_s = 0.4;

double sample_count(const Point& p) {
  if (!p.sampled) return 1;
  const auto& r = p.light_samples;
  return r.count > 0 ? r.count : double(r.width) * double(r.height);
}

double number(const ParamValue& value) {
  if (const auto* i = std::get_if<int64_t>(&value)) return static_cast<double>(*i);
  if (const auto* d = std::get_if<double>(&value)) return *d;
  return 1;
}

}  // namespace

std::vector<BatchIndices> batches(const std::vector<Point>& points) {
  std::vector<BatchIndices> out;
  std::string last;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string key = view_key(points[i]);
    if (out.empty() || key != last) out.emplace_back();
    out.back().push_back(i);
    last = key;
  }
  return out;
}

CostModel::CostModel(const MeasureSettings& measure, const Registry& registry) : measure_(measure) {
  for (const TechniqueInfo& info : registry)
    for (const ParamInfo& param : info.params)
      if (param.cost) cost_params_[info.name].push_back(param);
}

double CostModel::work(const Point& p) const {
  double work = double(p.width) * double(p.height) * sample_count(p);
  const auto params = cost_params_.find(p.technique);
  if (params == cost_params_.end()) return work;
  for (const ParamInfo& param : params->second)
    if (const auto value = p.params.find(param.name); value != p.params.end())
      work *= std::max(number(value->second), 1e-3) / std::max(number(param.fallback), 1e-3);
  return work;
}

double CostModel::expected_s(const Point& p) const {
  double rate = guessed_s_per_work;
  for (const std::string& key : {p.technique, p.technique + '/' + p.scene})
    if (const auto it = rate_.find(key); it != rate_.end()) rate = it->second;
  const double frame_s = rate * work(p);
  const double frames =
      std::max({double(measure_.repetitions), measure_.min_time_s / std::max(frame_s, 1e-6), 1.0});
  return guessed_overhead_s + std::min(frames * frame_s, measure_.max_time_s) +
         (measure_.warmup + p.accumulate) * frame_s;
}

void CostModel::learn(const Point& p, double frame_s) {
  const double rate = frame_s / std::max(work(p), 1.0);
  for (const std::string& key : {p.technique, p.technique + '/' + p.scene}) {
    const auto [it, fresh] = rate_.try_emplace(key, rate);
    if (!fresh) it->second = std::sqrt(it->second * rate);  // rates differ by factors, not by amounts
  }
}

std::vector<Point> shard(const std::vector<Point>& points, int index, int count, const CostModel& model) {
  if (count < 1 || index < 1 || index > count)
    throw InputError(fmt::format("--shard {}/{}: expected I/N with 1 <= I <= N.", index, count));
  std::map<std::string, std::vector<std::size_t>> units;  // a sequence's frames need each other
  for (std::size_t i = 0; i < points.size(); ++i) units[sequence_key(points[i])].push_back(i);
  struct Unit {
    double cost;
    const std::vector<std::size_t>* members;
  };
  std::vector<Unit> order;
  for (const auto& [key, members] : units) {
    double cost = 0;
    for (std::size_t i : members) cost += model.expected_s(points[i]);
    order.push_back({cost, &members});
  }
  std::ranges::sort(order, [](const Unit& a, const Unit& b) {
    return a.cost != b.cost ? a.cost > b.cost : a.members->front() < b.members->front();
  });
  std::vector<double> load(static_cast<std::size_t>(count), 0.0);
  std::vector<std::size_t> mine;
  for (const Unit& unit : order) {  // the dearest first, each to the least loaded
    const auto least = std::min_element(load.begin(), load.end());
    *least += unit.cost;
    if (least - load.begin() == index - 1)
      mine.insert(mine.end(), unit.members->begin(), unit.members->end());
  }
  std::ranges::sort(mine);
  std::vector<Point> out;
  for (std::size_t i : mine) out.push_back(points[i]);
  return out;
}

}  // namespace penumbra::run
