#include "experiments/validation/rods/numerics.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_roots.h>

#include <cmath>
#include <memory>
#include <stdexcept>

namespace tress::experiments::validation {
namespace {

int call_slope(double x, const double* y, double* dy, void* slope) {
  (*static_cast<const Slope*>(slope))(x, y, dy);
  return GSL_SUCCESS;
}

double call_function(double x, void* f) {
  return (*static_cast<const std::function<double(double)>*>(f))(x);
}

std::vector<double> integrate(const Slope& slope, double from, double to,
                              std::vector<double> y, double absolute, double relative) {
  Slope called = slope;
  gsl_odeiv2_system system{call_slope, nullptr, y.size(), &called};
  const auto release = [](gsl_odeiv2_driver* driver) { gsl_odeiv2_driver_free(driver); };
  const double first = 1e-3 * (to - from);
  const std::unique_ptr<gsl_odeiv2_driver, decltype(release)> driver(
      gsl_odeiv2_driver_alloc_standard_new(&system, gsl_odeiv2_step_rk8pd, first,
                                           absolute, relative, 1, 1),
      release);
  if (gsl_odeiv2_driver_apply(driver.get(), &from, to, y.data()) != GSL_SUCCESS) {
    throw std::runtime_error("the step vanishes at x = " + std::to_string(from));
  }
  return y;
}

}  // namespace

std::vector<double> integrate(const Slope& slope, double from, double to,
                              std::vector<double> y) {
  return integrate(slope, from, to, std::move(y), 0, 1e-13);
}

std::vector<double> integrate_scaled(const Slope& slope, double from, double to,
                                     std::vector<double> y) {
  return integrate(slope, from, to, std::move(y), 1e-13, 1e-13);
}

double find_root(const std::function<double(double)>& f, double low, double high,
                 double accuracy) {
  const double at_low = f(low), at_high = f(high);
  if (at_low == 0) return low;
  if (at_high == 0) return high;
  if (!(at_low * at_high < 0)) {
    throw std::runtime_error("no change of sign between " + std::to_string(low) +
                             " and " + std::to_string(high));
  }
  std::function<double(double)> called = f;
  gsl_function function{call_function, &called};
  const auto release = [](gsl_root_fsolver* solver) { gsl_root_fsolver_free(solver); };
  const std::unique_ptr<gsl_root_fsolver, decltype(release)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), release);
  gsl_root_fsolver_set(solver.get(), &function, low, high);
  constexpr int most = 200;
  for (int i = 0; i < most; ++i) {
    gsl_root_fsolver_iterate(solver.get());
    low = gsl_root_fsolver_x_lower(solver.get());
    high = gsl_root_fsolver_x_upper(solver.get());
    if (gsl_root_test_interval(low, high, 0, accuracy) == GSL_SUCCESS) break;
  }
  return gsl_root_fsolver_root(solver.get());
}

double threshold(const std::function<bool(double)>& above, double low, double high,
                 double width) {
  while (high - low > width * high) {
    const double middle = (low + high) / 2;
    (above(middle) ? high : low) = middle;
  }
  return (low + high) / 2;
}

}  // namespace tress::experiments::validation
