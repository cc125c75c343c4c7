#include "experiments/validation/helical_spring.h"

#include <cmath>
#include <numbers>

#include "experiments/validation/rods/numerics.h"

namespace tress::experiments::validation {

PulledHelix pulled_helix(double natural_pitch_angle, double poisson_ratio, double force) {
  const double c0 = std::cos(natural_pitch_angle), s0 = std::sin(natural_pitch_angle);
  const double twisting = 1 / (1 + poisson_ratio);
  // No couple about the axis: linear in 1/r.
  const auto turns = [=](double a) {
    const double c = std::cos(a), s = std::sin(a);
    return (c0 * c0 * c + twisting * s0 * c0 * s) / (c * c * c + twisting * s * s * c);
  };
  const auto pull = [=](double a) {
    const double c = std::cos(a), s = std::sin(a), k = turns(a);
    const double bend = c * c * k - c0 * c0, twist = twisting * (s * c * k - s0 * c0);
    return (twist * c - bend * s) * k - force;
  };
  const double a = find_root(pull, natural_pitch_angle, std::numbers::pi / 2 - 1e-6);
  return {1 / turns(a), a};
}

}  // namespace tress::experiments::validation
