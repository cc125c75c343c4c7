#include "experiments/harness/cheapest_run.h"

#include <limits>

namespace tress {
namespace {

constexpr double little_gain = 0.8;

// Errors this many times the target need not fall with the step yet: all is damped away.
constexpr double far = 10;

// One run beside others takes up to twice its time: what looks dearer may not be.
constexpr double noise = 2;

}  // namespace

std::optional<CheapRun> cheapest_run(
    const CheapSearch& search,
    const std::function<std::optional<CheapRun>(int elements, double dt)>& run,
    const std::function<bool()>& stop) {
  std::optional<CheapRun> best;
  for (const int elements : search.elements) {
    double last = std::numeric_limits<double>::infinity();
    for (double dt = search.coarsest; dt >= search.finest; dt /= 2) {
      if (stop()) return best;
      const auto found = run(elements, dt);
      if (!found) continue;  // too long a step
      if (found->error <= search.target) {
        if (!best || found->wall_s < best->wall_s) best = found;
        break;
      }
      const bool too_dear = best && found->wall_s > noise * best->wall_s;
      const bool of_space =
          found->error > little_gain * last && found->error < far * search.target;
      if (too_dear || of_space) break;
      last = found->error;
    }
  }
  return best;
}

}  // namespace tress
