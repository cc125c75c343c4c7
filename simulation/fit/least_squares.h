#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "contract/basics.h"

namespace tress::simulation {

/// Fills the n residuals at x; false: not defined, x is too far off.
using ResidualAt = std::function<bool(In x, Out r)>;

/// Fills dr/dx (n x p, row-major) at x; false: not defined.
using DerivativeAt = std::function<bool(In x, Out jacobian)>;

/// Minimiser of the sum of n squared residuals r(x), with its statistics.
struct LeastSquares {
  std::vector<double> x;         // (p)
  std::vector<double> residual;  // (n) r(x)
  std::vector<double> jacobian;  // (n x p) dr/dx, row-major
  /// (J^T J)^-1 (p x p): times the variance of a residual it is the covariance of x.
  /// Empty when J is rank deficient to rounding.
  std::vector<double> covariance;
  double condition = 0;  // of J; infinite when rank deficient
  int evaluations = 0;   // of r, where J is by differences
  std::string failure;   // empty: converged

  /// Gauss-Newton step -(J^T J)^-1 J^T r of x when the residuals become r.
  std::vector<double> step(In r) const;

  /// Half-width of the confidence interval of each x_j, for normal, independent residuals
  /// of one unknown variance with `degrees` of freedom: t sqrt(s^2 C_jj), s^2 =
  /// |r|^2/degrees, t Student's two-sided quantile.
  std::vector<double> half_intervals(double degrees, double confidence) const;
};

/// Gauss-Newton steps within a trust region (double dogleg) by GSL's
/// gsl_multifit_nlinear from `start`. Converged when the remaining Gauss-Newton step is
/// below `tolerance` in every x_j. Exceptions of `residual` and `derivative` propagate.
LeastSquares least_squares(const ResidualAt& residual, const DerivativeAt& derivative,
                           In start, std::size_t n, double tolerance);
/// Levenberg-Marquardt, with J by central differences x_j +- difference, error
/// difference^2 r'''/6.
LeastSquares least_squares(const ResidualAt& residual, In start, std::size_t n,
                           double difference, double tolerance);

}  // namespace tress::simulation
