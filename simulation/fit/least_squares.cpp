#include "simulation/fit/least_squares.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <numeric>

namespace tress::simulation {
namespace {

constexpr int most_iterations = 60;
constexpr double out_of_reach = 1e6;  // residual where undefined: never accepted

template <class T, void (*release)(T*)>
struct Release {
  void operator()(T* pointer) const { release(pointer); }
};
using Workspace =
    std::unique_ptr<gsl_multifit_nlinear_workspace,
                    Release<gsl_multifit_nlinear_workspace, gsl_multifit_nlinear_free>>;
using Matrix = std::unique_ptr<gsl_matrix, Release<gsl_matrix, gsl_matrix_free>>;
using Vector = std::unique_ptr<gsl_vector, Release<gsl_vector, gsl_vector_free>>;

/// Callback data for GSL; it is C, so exceptions wait until it has returned.
struct Problem {
  const ResidualAt& residual;
  const DerivativeAt& derivative;
  std::vector<double> x, r, jacobian;
  std::exception_ptr thrown;

  bool guarded(const auto& function, Out values) {
    try {
      return function(x, values);
    } catch (...) {
      thrown = std::current_exception();
      return false;
    }
  }
  void take(const gsl_vector* from) {
    for (std::size_t j = 0; j < x.size(); ++j) x[j] = gsl_vector_get(from, j);
  }

  static int value(const gsl_vector* x, void* self_pointer, gsl_vector* f) {
    auto& self = *static_cast<Problem*>(self_pointer);
    self.take(x);
    const bool there = self.guarded(self.residual, self.r);
    if (self.thrown) return GSL_EFAILED;
    for (std::size_t i = 0; i < self.r.size(); ++i) {
      gsl_vector_set(f, i, there ? self.r[i] : out_of_reach);
    }
    return GSL_SUCCESS;
  }

  static int slopes(const gsl_vector* x, void* self_pointer, gsl_matrix* jacobian) {
    auto& self = *static_cast<Problem*>(self_pointer);
    self.take(x);
    if (!self.guarded(self.derivative, self.jacobian)) return GSL_EFAILED;
    const std::size_t p = self.x.size();
    for (std::size_t i = 0; i < self.r.size(); ++i) {
      for (std::size_t j = 0; j < p; ++j) {
        gsl_matrix_set(jacobian, i, j, self.jacobian[i * p + j]);
      }
    }
    return GSL_SUCCESS;
  }
};

/// (J^T J)^-1 = V S^-2 V^T and the ratio of the singular values S of J = U S V^T.
void add_covariance(LeastSquares& fit, const gsl_matrix& jacobian) {
  const std::size_t n = jacobian.size1, p = jacobian.size2;
  const Matrix u(gsl_matrix_alloc(n, p)), v(gsl_matrix_alloc(p, p));
  const Vector s(gsl_vector_alloc(p)), work(gsl_vector_alloc(p));
  gsl_matrix_memcpy(u.get(), &jacobian);
  gsl_linalg_SV_decomp(u.get(), v.get(), s.get(), work.get());
  const double largest = gsl_vector_get(s.get(), 0);
  const double smallest = gsl_vector_get(s.get(), p - 1);
  const double rounding =
      largest * static_cast<double>(n) * std::numeric_limits<double>::epsilon();
  fit.condition = std::numeric_limits<double>::infinity();
  if (!(smallest > rounding)) return;
  fit.condition = largest / smallest;
  fit.covariance.resize(p * p);
  for (std::size_t i = 0; i < p; ++i) {
    for (std::size_t j = 0; j < p; ++j) {
      for (std::size_t k = 0; k < p; ++k) {
        const double sigma = gsl_vector_get(s.get(), k);
        fit.covariance[i * p + j] += gsl_matrix_get(v.get(), i, k) *
                                     gsl_matrix_get(v.get(), j, k) / (sigma * sigma);
      }
    }
  }
}

/// Position, residuals and derivatives where the iteration is.
LeastSquares state_of(gsl_multifit_nlinear_workspace& workspace) {
  LeastSquares fit;
  const gsl_vector& x = *gsl_multifit_nlinear_position(&workspace);
  const gsl_vector& r = *gsl_multifit_nlinear_residual(&workspace);
  const gsl_matrix& jacobian = *gsl_multifit_nlinear_jac(&workspace);
  for (std::size_t j = 0; j < x.size; ++j) fit.x.push_back(gsl_vector_get(&x, j));
  for (std::size_t i = 0; i < r.size; ++i) {
    fit.residual.push_back(gsl_vector_get(&r, i));
    for (std::size_t j = 0; j < x.size; ++j) {
      fit.jacobian.push_back(gsl_matrix_get(&jacobian, i, j));
    }
  }
  add_covariance(fit, jacobian);
  return fit;
}

/// Takes the Gauss-Newton step that is left, which leaves its square. It changes
/// residuals in proportion.
void take_step(LeastSquares& fit) {
  if (fit.covariance.empty()) return;
  const std::vector<double> left = fit.step(fit.residual);
  const std::size_t p = left.size();
  for (std::size_t j = 0; j < p; ++j) fit.x[j] += left[j];
  for (std::size_t i = 0; i < fit.residual.size(); ++i) {
    for (std::size_t j = 0; j < p; ++j) {
      fit.residual[i] += fit.jacobian[i * p + j] * left[j];
    }
  }
}

std::vector<double> last_step(const gsl_multifit_nlinear_workspace& workspace) {
  std::vector<double> step;
  for (std::size_t j = 0; j < workspace.dx->size; ++j) {
    step.push_back(gsl_vector_get(workspace.dx, j));
  }
  return step;
}

LeastSquares minimum(const ResidualAt& residual, const DerivativeAt& derivative, In start,
                     std::size_t n, double tolerance,
                     const gsl_multifit_nlinear_trs& method) {
  gsl_set_error_handler_off();
  const std::size_t p = start.size();
  Problem problem{residual,
                  derivative,
                  {start.begin(), start.end()},
                  std::vector<double>(n),
                  std::vector<double>(n * p),
                  {}};
  gsl_multifit_nlinear_fdf function{};
  function.f = Problem::value;
  function.df = Problem::slopes;
  function.n = n;
  function.p = p;
  function.params = &problem;
  gsl_multifit_nlinear_parameters parameters =
      gsl_multifit_nlinear_default_parameters();  // More's scaling
  parameters.trs = &method;
  const Workspace workspace(
      gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &parameters, n, p));
  const gsl_vector_const_view from = gsl_vector_const_view_array(start.data(), p);
  const auto within = [&](double dx) { return std::abs(dx) <= tolerance; };
  int code = gsl_multifit_nlinear_init(&from.vector, &function, workspace.get());
  LeastSquares fit;
  for (int k = 0; code == GSL_SUCCESS && k <= most_iterations; ++k) {
    fit = state_of(*workspace);
    // The derivatives there give the step that is left, without another run.
    const bool there = fit.covariance.empty()
                           ? k > 0 && std::ranges::all_of(last_step(*workspace), within)
                           : std::ranges::all_of(fit.step(fit.residual), within);
    if (there) {
      take_step(fit);
      return fit;
    }
    code = k < most_iterations ? gsl_multifit_nlinear_iterate(workspace.get())
                               : static_cast<int>(GSL_EMAXITER);
  }
  if (problem.thrown) std::rethrow_exception(problem.thrown);
  if (code == GSL_EFAILED) {
    fit = {};
    fit.failure = "no residuals or derivatives at a trial value";
  } else if (!fit.covariance.empty()) {
    fit.failure = std::string("not converged: ") + gsl_strerror(code);
  }
  return fit;
}

}  // namespace

std::vector<double> LeastSquares::step(In r) const {
  const std::size_t p = x.size();
  std::vector<double> gradient(p), move(p);
  for (std::size_t i = 0; i < r.size(); ++i) {
    for (std::size_t j = 0; j < p; ++j) gradient[j] += jacobian[i * p + j] * r[i];
  }
  for (std::size_t i = 0; i < p; ++i) {
    for (std::size_t j = 0; j < p; ++j) move[i] -= covariance[i * p + j] * gradient[j];
  }
  return move;
}

std::vector<double> LeastSquares::half_intervals(double degrees,
                                                 double confidence) const {
  const double variance =
      std::inner_product(residual.begin(), residual.end(), residual.begin(), 0.0) /
      degrees;
  const double t = gsl_cdf_tdist_Pinv((1 + confidence) / 2, degrees);
  std::vector<double> half(x.size());
  for (std::size_t j = 0; j < half.size(); ++j) {
    half[j] = t * std::sqrt(variance * covariance[j * half.size() + j]);
  }
  return half;
}

LeastSquares least_squares(const ResidualAt& residual, In start, std::size_t n,
                           double difference, double tolerance) {
  int evaluations = 0;
  const ResidualAt counted = [&](In x, Out r) {
    ++evaluations;
    return residual(x, r);
  };
  const DerivativeAt differences = [&, back = std::vector<double>(n),
                                    forth = std::vector<double>(n)](
                                       In x, Out jacobian) mutable {
    std::vector<double> at(x.begin(), x.end());
    for (std::size_t j = 0; j < at.size(); ++j) {
      at[j] = x[j] + difference;
      const bool there = counted(at, forth);
      at[j] = x[j] - difference;
      if (!there || !counted(at, back)) return false;
      at[j] = x[j];
      for (std::size_t i = 0; i < n; ++i) {
        jacobian[i * at.size() + j] = (forth[i] - back[i]) / (2 * difference);
      }
    }
    return true;
  };
  LeastSquares fit =
      minimum(counted, differences, start, n, tolerance, *gsl_multifit_nlinear_trs_lm);
  fit.evaluations = evaluations;
  return fit;
}

LeastSquares least_squares(const ResidualAt& residual, const DerivativeAt& derivative,
                           In start, std::size_t n, double tolerance) {
  return minimum(residual, derivative, start, n, tolerance,
                 *gsl_multifit_nlinear_trs_ddogleg);
}

}  // namespace tress::simulation
