#include "experiments/validation/master_curve.h"

#include <algorithm>
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
  // at the tip x = 0 and psi = pi/2 at the clamp. Near the tip psi = psi_0 + sin psi_0
  // Gamma x^3/6 up to (Gamma x^3)^2/180; psi_0 is down to exp(-2/3 sqrt Gamma), so its
  // logarithm is the unknown. Beyond pi/2 sin psi is 1 here, so that psi keeps rising:
  // then the clamp's angle rises with the tip's and there is one root.
  constexpr double right_angle = std::numbers::pi / 2;
  const double start = 1e-3 / std::cbrt(gamma);
  const auto bend = [gamma, right_angle](double x, const double* y, double* dy) {
    dy[0] = y[1];
    dy[1] = gamma * x * std::sin(std::min(y[0], right_angle));
  };
  const auto from_tip = [&](double log_tip) -> std::vector<double> {
    const double tip = std::exp(log_tip);
    const double bent = std::sin(tip) * gamma * start * start;
    return {tip + bent * start / 6, bent / 2};
  };
  const auto beyond = [&](double log_tip) {
    return integrate(bend, start, 1, from_tip(log_tip))[0] - right_angle;
  };
  const double log_tip =
      find_root(beyond, -2.0 / 3 * std::sqrt(gamma) - 10, std::log(right_angle));
  std::vector<double> y = from_tip(log_tip);
  y.insert(y.end(), {start * std::sin(y[0]), start * std::cos(y[0])});
  const auto all = [&](double x, const double* of, double* dy) {
    bend(x, of, dy);
    dy[2] = std::sin(of[0]);
    dy[3] = std::cos(of[0]);
  };
  y = integrate(all, start, 1, std::move(y));
  return {y[2], y[3]};
}

}  // namespace tress
