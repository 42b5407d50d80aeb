// What the processors were used for: by this process, and by others beside it.
#pragma once
#include <optional>

namespace penumbra::run {

// Processor time of all threads of this process, seconds.
double process_cpu_s();

// A moment's state of the machine's processors, all together, in seconds since it was started.
struct ProcessorUse {
  double all = 0, idle = 0, own = 0;
};
// Nothing where the system does not tell.
std::optional<ProcessorUse> processor_use();

// Share, from 0 to 1, of all processors that other programs (or another guest of the same machine) had
// between two moments. Nothing when they are too near to each other for the system's clock, which ticks in
// hundredths.
std::optional<double> others_share(const std::optional<ProcessorUse>& before,
                                   const std::optional<ProcessorUse>& after);

// From here on times are not to be trusted, and reports say so.
inline constexpr double busy_share = 0.1;

}  // namespace penumbra::run
