#include "run/processors.h"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <string>

namespace penumbra::run {

double process_cpu_s() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::optional<ProcessorUse> processor_use() {
  std::ifstream file("/proc/stat");
  std::string name;
  // user nice system idle iowait irq softirq steal, in ticks, see proc(5)
  double ticks[8] = {};
  file >> name;
  for (double& t : ticks) file >> t;
  if (!file || name != "cpu") return std::nullopt;
  const double tick = 1.0 / static_cast<double>(::sysconf(_SC_CLK_TCK));
  ProcessorUse use;
  for (const double t : ticks) use.all += t * tick;
  use.idle = (ticks[3] + ticks[4]) * tick;
  use.own = process_cpu_s();
  return use;
}

std::optional<double> others_share(const std::optional<ProcessorUse>& before,
                                   const std::optional<ProcessorUse>& after) {
  if (!before || !after || after->all - before->all < 0.2) return std::nullopt;
  const double busy = (after->all - after->idle) - (before->all - before->idle);
  return std::clamp((busy - (after->own - before->own)) / (after->all - before->all), 0.0, 1.0);
}

}  // namespace penumbra::run
