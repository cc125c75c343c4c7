#include <limits>

#include "models/head/head.h"
#include "models/head/stepping/step_limits.h"

namespace tress::models {
namespace {

/// Stiff strands need steps some halvings shorter than the first.
constexpr double room = 16;

}  // namespace

bool resolve(HeadNumber number, double tolerance) {
  const double epsilon = number == HeadNumber::float64
                             ? std::numeric_limits<double>::epsilon()
                             : std::numeric_limits<float>::epsilon();
  const StepLimits limits =
      StepLimits::of(lane_method(HeadMethod::tr_bdf2), tolerance, epsilon);
  return limits.first >= room * limits.shortest;
}

}  // namespace tress::models
