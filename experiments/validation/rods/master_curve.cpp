#include "experiments/validation/rods/master_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "experiments/validation/rods/numerics.h"

namespace tress::experiments::validation {

Cantilever cantilever(double gamma, double alpha) {
  const auto within = [](double x) { return x >= 0 && x <= 1e5; };
  if (!within(gamma) || !within(alpha) || gamma + alpha == 0) {
    throw InputError("no cantilever of these loads", "Gamma or alpha",
                     "give numbers of at most 1e5, one of them above 0");
  }
  // With x = 1 - s and psi the angle from the vertical, psi'' = (Gamma x + alpha) sin
  // psi, psi' = 0 at the tip x = 0 and psi = pi/2 at the clamp. psi at the tip is down to
  // exp(-2/3 sqrt Gamma), so its logarithm is the unknown. Beyond pi/2 sin psi is 1 here,
  // so that psi keeps rising: the clamp's angle rises with the tip's and there is one
  // root.
  constexpr double right_angle = std::numbers::pi / 2;
  const auto bend = [=](double x, const double* y, double* dy) {
    dy[0] = y[1];
    dy[1] = (gamma * x + alpha) * std::sin(std::min(y[0], right_angle));
  };
  // The start by a series, to 1e-9 squared: relative accuracy is meaningless there.
  const double start = 3e-5 / std::sqrt(1 + gamma + alpha);
  const auto from_tip = [=](double log_tip) -> std::vector<double> {
    const double tip = std::exp(log_tip), push = std::sin(tip) * start;
    return {tip + push * start * (gamma * start / 6 + alpha / 2),
            push * (gamma * start / 2 + alpha)};
  };
  const auto beyond = [&](double log_tip) {
    return integrate(bend, start, 1, from_tip(log_tip))[0] - right_angle;
  };
  const double log_tip = find_root(
      beyond, -2.0 / 3 * std::sqrt(gamma) - std::sqrt(alpha) - 10, std::log(right_angle));
  std::vector<double> y = from_tip(log_tip);
  y.insert(y.end(), {start * std::sin(y[0]), start * std::cos(y[0])});
  const auto all = [&](double x, const double* of, double* dy) {
    bend(x, of, dy);
    dy[2] = std::sin(of[0]);
    dy[3] = std::cos(of[0]);
  };
  y = integrate(all, start, 1, std::move(y));
  return {y[2], y[3], right_angle - std::exp(log_tip)};
}

}  // namespace tress::experiments::validation
