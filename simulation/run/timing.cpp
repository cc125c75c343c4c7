#include "simulation/run/timing.h"

#include <time.h>

namespace tress::simulation {

double ThreadTimer::processor_s() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Timing summarize(const std::vector<double>& seconds) {
  if (seconds.empty()) return {};
  return {.median_s = median(seconds),
          .min_s = *std::min_element(seconds.begin(), seconds.end()),
          .repeats = static_cast<int>(seconds.size())};
}

}  // namespace tress::simulation
