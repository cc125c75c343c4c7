#pragma once

#include <functional>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::validation {

/// Integrates dy/dx = f(x, y) over [from, to] by the Runge-Kutta method of Prince and
/// Dormand (order 8, GSL). Each step is within 1e-13 of every entry of y, or of the
/// step's increment. Throws std::runtime_error if the step vanishes.
using Slope = std::function<void(double x, const double* y, double* dy)>;
std::vector<double> integrate(const Slope& slope, double from, double to,
                              std::vector<double> y);
/// Integrates as above, each step within 1e-13 at absolute sizes of 1 or more: for
/// entries that cross 0 and are of at least that size overall.
std::vector<double> integrate_scaled(const Slope& slope, double from, double to,
                                     std::vector<double> y);

/// x in [low, high] where f changes sign, to relative `accuracy`, by Brent's method
/// (GSL). Throws std::runtime_error when f has the same sign at both ends.
double find_root(const std::function<double(double)>& f, double low, double high,
                 double accuracy = 1e-14);

/// The threshold between `low` and `high` from which on `above` is true, by bisection:
/// the middle of an interval of relative `width`. Both ends are known to the caller.
double threshold(const std::function<bool(double)>& above, double low, double high,
                 double width);

}  // namespace tress::experiments::validation
