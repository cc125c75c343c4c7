#include "experiments/numerics/cheapest_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::experiments {
namespace {

constexpr double little_gain = 0.8;

// Errors beyond this multiple of the target need not fall with the step yet: the motion
// is damped away.
constexpr double far = 10;

}  // namespace

Cheapest cheapest_run(
    const CheapSearch& search,
    const std::function<CheapRun(int elements, double dt, double most_work)>& run) {
  std::optional<CheapRun> best;
  double spent = 0;
  for (const int elements : search.elements) {
    double last = std::numeric_limits<double>::infinity();
    for (double dt = search.coarsest; dt >= search.finest; dt /= 2) {
      const double left = search.most_work - spent;
      if (left <= 0) return {best, false};
      const CheapRun found = run(elements, dt, best ? std::min(best->work, left) : left);
      spent += found.work;
      const bool too_dear = best && found.work >= best->work;
      if (too_dear) break;
      if (!std::isfinite(found.error)) continue;  // too long a step
      if (found.error <= search.target) {
        best = found;
        break;
      }
      const bool of_space =
          found.error > little_gain * last && found.error < far * search.target;
      if (of_space) break;
      last = found.error;
    }
  }
  return {best, true};
}

}  // namespace tress::experiments
