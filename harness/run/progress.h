// The progress line on a terminal; nothing where standard error is no terminal.
#pragma once
#include <string>
#include <vector>

#include "run/schedule.h"

namespace penumbra::run {

class Progress {
 public:
  Progress(const std::vector<Point>& points, const CostModel& model, bool enabled);
  ~Progress();
  // `finished`: which points are done, by index; `now`: what is being done.
  void show(const std::vector<bool>& finished, const std::string& now);
  // Takes the line away, so that a message can be printed.
  void clear();

 private:
  double seconds_left(const std::vector<bool>& finished) const;
  const std::vector<Point>& points_;
  const CostModel& model_;
  bool enabled_;
  double start_, shown_at_ = 0;
  std::vector<bool> before_;  // finished when this run began
};

// "47 s", "3:05", "2 h 10 min".
std::string duration_text(double seconds);

}  // namespace penumbra::run
