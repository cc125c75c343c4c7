#pragma once

#include <functional>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::validation {

/// dy/dx = f(x, y) from `from` to `to` by the Runge-Kutta method of Prince and Dormand
/// (order 8, GSL), each step within 1e-13 of every entry of y, or of what the step adds
/// to it. Throws std::runtime_error where the step vanishes.
using Slope = std::function<void(double x, const double* y, double* dy)>;
std::vector<double> integrate(const Slope& slope, double from, double to,
                              std::vector<double> y);
/// The same, each step within 1e-13 at absolute sizes of 1 or more: for entries that pass
/// 0 and are no smaller than that on the whole.
std::vector<double> integrate_scaled(const Slope& slope, double from, double to,
                                     std::vector<double> y);

/// x in [low, high] where f changes sign, to `accuracy` of itself, by Brent's method
/// (GSL). Throws std::runtime_error when f has the same sign at both ends.
double find_root(const std::function<double(double)>& f, double low, double high,
                 double accuracy = 1e-14);

}  // namespace tress::experiments::validation
