#include "simulation/run/timing.h"

namespace tress::simulation {

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
