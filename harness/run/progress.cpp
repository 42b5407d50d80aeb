#include "run/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "run/view.h"

namespace penumbra::run {
namespace {

std::size_t terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

}  // namespace

std::string duration_text(double seconds) {
  const auto s = static_cast<long>(std::llround(std::max(seconds, 0.0)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(const std::vector<Point>& points, const CostModel& model, bool enabled)
    : points_(points), model_(model), enabled_(enabled && ::isatty(STDERR_FILENO) == 1), start_(now_s()) {}

Progress::~Progress() { clear(); }

// Expected costs are right in their ratios; the time that the finished ones really took gives the scale.
double Progress::seconds_left(const std::vector<bool>& finished) const {
  double done = 0, left = 0;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (!before_[i]) (finished[i] ? done : left) += model_.expected_s(points_[i]);
  const double scale = done > 0 ? std::clamp((now_s() - start_) / done, 0.2, 20.0) : 1;
  return left * scale;
}

void Progress::show(const std::vector<bool>& finished, const std::string& now) {
  // Costs of many points take a while to add up: never more than about 1 % of the time.
  if (!enabled_ || now_s() - shown_at_ < std::max(0.25, 1e-4 * static_cast<double>(points_.size()))) return;
  if (before_.empty()) before_ = finished;
  shown_at_ = now_s();
  const auto done = static_cast<std::size_t>(std::ranges::count(finished, true));
  const std::size_t bar = 20, filled = points_.empty() ? bar : bar * done / points_.size();
  std::string line =
      fmt::format("[{}{}] {}/{}  about {} left  {}", std::string(filled, '#'), std::string(bar - filled, '.'),
                  done, points_.size(), duration_text(seconds_left(finished)), now);
  line.resize(std::min(line.size(), terminal_columns() - 1));
  fmt::print(stderr, "\r\x1b[2K{}", line);
  std::fflush(stderr);
}

void Progress::clear() {
  if (!enabled_ || shown_at_ == 0) return;
  fmt::print(stderr, "\r\x1b[2K");
  std::fflush(stderr);
}

}  // namespace penumbra::run
