#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "contract/system.h"

namespace tress::experiments {

/// Fills the n residuals at x; false: there are none, x is too far off.
using ResidualAt = std::function<bool(In x, Out r)>;

/// The least sum of squared residuals r(x), n of them, and what is known of it.
struct LeastSquares {
  std::vector<double> x;  // (p)
  std::vector<double> residual;
  std::vector<double> jacobian;  // (n x p) dr/dx, row-major
  /// (J^T J)^-1 (p x p): times the variance of a residual it is the covariance of x.
  /// Empty when J has not full rank to rounding.
  std::vector<double> covariance;
  double condition = 0;  // of J; infinite without full rank
  int evaluations = 0;   // of r
  std::string failure;   // empty: converged

  /// x moves by -(J^T J)^-1 J^T r, the Gauss-Newton step, when the residuals become r.
  std::vector<double> step(In r) const;

  /// Half of the interval around each x_j that holds the true one with this confidence
  /// when residuals are normal, independent and of one unknown variance, `degrees` of
  /// freedom: t sqrt(s^2 C_jj), s^2 = |r|^2/degrees, t Student's two-sided quantile.
  std::vector<double> half_intervals(double degrees, double confidence) const;
};

/// Levenberg-Marquardt by GSL's gsl_multifit_nlinear from `start`; J by central
/// differences x_j +- difference, error difference^2 r'''/6. Converged: the Gauss-Newton
/// step that is left is below `tolerance` in every x_j. Exceptions of `residual` come
/// through.
LeastSquares least_squares(const ResidualAt& residual, In start, std::size_t n,
                           double difference, double tolerance);

}  // namespace tress::experiments
