#include "experiments/validation/master_curve.h"

#include <cmath>
#include <numbers>

#include "experiments/validation/numerics.h"
#include "models/input_error.h"

namespace tress {

Cantilever cantilever(double gamma) {
  if (!(gamma > 0 && gamma <= 1e5)) {
    throw InputError("no master curve at this Gamma", "cantilever",
                     "give a number above 0, at most 1e5");
  }
  // With x = 1 - s and psi the angle from the vertical, psi'' = Gamma x sin psi, psi' = 0
  // at the tip x = 0 and psi = pi/2 at the clamp. Near the tip psi = psi_0 (1 + Gamma
  // x^3/6) up to (Gamma x^3)^2/180; psi_0 is down to exp(-2/3 sqrt Gamma), so its
  // logarithm is the unknown.
  const double start = 1e-3 / std::cbrt(gamma);
  const Slope slope = [gamma](double x, const double* y, double* dy) {
    dy[0] = y[1];
    dy[1] = gamma * x * std::sin(y[0]);
    dy[2] = std::sin(y[0]);
    dy[3] = std::cos(y[0]);
  };
  const auto clamp = [&](double log_tip) {
    const double tip = std::exp(log_tip), bent = gamma * start * start;
    return integrate(slope, start, 1,
                     {tip * (1 + bent * start / 6), tip * bent / 2, tip * start,
                      start * std::cos(tip)});
  };
  constexpr double right_angle = std::numbers::pi / 2;
  // The clamp's angle rises with the tip's until psi turns over, beyond pi/2.
  const double root =
      find_root([&](double log_tip) { return clamp(log_tip)[0] - right_angle; },
                -2.0 / 3 * std::sqrt(gamma) - 10, std::log(right_angle));
  const std::vector<double> y = clamp(root);
  return {y[2], y[3]};
}

}  // namespace tress
