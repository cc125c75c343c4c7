#include "experiments/validation/rods/beam_modes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "contract/input_error.h"
#include "experiments/validation/rods/numerics.h"

namespace tress::experiments::validation {
namespace {

/// The `count`-th root above 0, searched in steps shorter than the distance of roots.
double nth_root(const std::function<double(double)>& f, int count, double step) {
  double at = step, value = f(at);
  for (;;) {
    const double next = at + step, beyond = f(next);
    if (value * beyond <= 0 && --count == 0) return find_root(f, at, next);
    at = next;
    value = beyond;
  }
}

}  // namespace

double heavy_rod_mode(double gamma, int mode) {
  constexpr double falls_over = -7.837347438943484;  // Greenhill
  if (!(gamma > falls_over && gamma <= 1e5) || mode < 1 || mode > 10) {
    throw InputError("no such mode of a heavy rod", "Gamma or mode",
                     "give Gamma in (-7.837, 1e5] and a mode from 1 to 10");
  }
  const auto clamp = [gamma](double omega) {
    const double square = omega * omega;
    // Minors 12, 13, 14, 23, 24, 34 of (w, w', w'', w''').
    const Slope minors = [=](double x, const double* y, double* dy) {
      dy[0] = y[1];
      dy[1] = y[3] + y[2];
      dy[2] = y[4] + gamma * y[0] + gamma * x * y[1];
      dy[3] = y[4];
      dy[4] = y[5] - square * y[0] + gamma * x * y[3];
      dy[5] = -square * y[1] - gamma * y[3];
    };
    return integrate_scaled(minors, 0, 1, {1, 0, 0, 0, 0, 0})[0];
  };
  // Neighbouring roots are 1.5 apart for a beam (the first from 0, standing), pi/2
  // sqrt(Gamma) for a chain.
  const double step = gamma < 0 ? 0.02 : 0.2 * (1 + std::sqrt(gamma));
  return nth_root(clamp, mode, step);
}

double curved_beam_mode(double opening, int mode) {
  const auto tip = [opening](double omega) {
    const double square = omega * omega, k = opening;
    const Slope slope = [=](double, const double* y, double* dy) {
      dy[0] = k * y[1];
      dy[1] = y[2] - k * y[0];
      dy[2] = y[3];
      dy[3] = -y[5];
      dy[4] = k * y[5] - square * y[0];
      dy[5] = -k * y[4] - square * y[1];
    };
    std::array<std::vector<double>, 3> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<double> y(6);
      y[3 + i] = 1;
      ends[i] = integrate_scaled(slope, 0, 1, y);
    }
    const auto& [a, b, c] = ends;
    return a[3] * (b[4] * c[5] - b[5] * c[4]) - a[4] * (b[3] * c[5] - b[5] * c[3]) +
           a[5] * (b[3] * c[4] - b[4] * c[3]);
  };
  return nth_root(tip, mode, 0.1);
}

}  // namespace tress::experiments::validation
