// In what order points run, what they will probably cost, and which shard has which.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/plan.h"

namespace penumbra::run {

// Indices into plan.points, in order, cut where the view (scene, camera, resolution, frame) changes.
using BatchIndices = std::vector<std::size_t>;
std::vector<BatchIndices> batches(const std::vector<Point>& points);

// Seconds that a point will take. Starts from light samples, pixels and the parameters marked as cost; learns
// the rate of each technique in each scene as results come in.
class CostModel {
 public:
  CostModel(const MeasureSettings& measure, const Registry& registry);
  double expected_s(const Point& point) const;
  void learn(const Point& point, double frame_s);

 private:
  double work(const Point& point) const;
  MeasureSettings measure_;
  std::map<std::string, std::vector<ParamInfo>> cost_params_;  // by technique
  std::map<std::string, double> rate_;  // seconds per unit of work, by technique/scene and by technique
};

// Points of shard `index` of `count` (1-based): deterministic, balanced by expected cost, a sequence's frames
// together, in plan order. Throws InputError unless 1 <= index <= count.
std::vector<Point> shard(const std::vector<Point>& points, int index, int count, const CostModel& model);

}  // namespace penumbra::run
