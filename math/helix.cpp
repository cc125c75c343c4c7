#include "math/helix.h"

#include <cmath>

namespace tress::helix {

HelixFunctions<double> closed_forms(double s, double x2) noexcept {
  const double half = 0.5 * std::sqrt(x2) * s;
  return closed_forms(s, x2, half, std::sin(half), std::cos(half));
}

}  // namespace tress::helix
