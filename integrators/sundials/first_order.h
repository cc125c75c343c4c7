#pragma once

#include <optional>

#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"
#include "integrators/sundials/linear_adapter.h"

namespace tress::integrators {

/// The system as an ODE: y = (q, v), y' = (v, a(t, q, v)) with a, lambda from
/// Dynamics::accelerate, and its Newton matrix I - gamma J in eliminated form.
///
/// (I - gamma J) x = b reads x_q - gamma x_v = b_q and x_v - z = b_v, where z = gamma da
/// and da is the change of a along (x_q, x_v). So
///
///     x_v = b_v + z,    x_q = b_q + gamma x_v = (b_q + gamma b_v) + gamma z.
///
/// Differentiating r(t, q, v, a, lambda) = 0 and c(t, q, v, a) = 0 along that change,
/// times gamma, with nu = gamma dlambda and the known part of (x_q, x_v) on the right:
///
///     S z - G^T nu = -gamma D r,   H z = -gamma D c,   w = (1, gamma, gamma^2),
///     D = derivative along dq = b_q + gamma b_v, dv = b_v at fixed a and lambda,
///
/// which is one Dynamics::directional and one Dynamics::solve of size n + m. No 2n matrix
/// and no derivative of M^-1 is ever formed.
///
/// accelerate() factors the mass matrix in its own Dynamics. A system without constraints
/// and without an explicit form keeps one factorisation for both (System::linearize), and
/// rates are evaluated between any two Newton corrections. Its Newton matrix is therefore
/// factored from its sparse form by a separate solver; without that form, the Newton
/// matrix is rebuilt at its old state whenever a rate has overwritten it.
class FirstOrder final : public NewtonMatrix {
 public:
  FirstOrder(System& system, const Options& options);

  Status rate(double t, In y, Out y_dot) noexcept;
  Status factor(double t, In y, In y_dot, double gamma) noexcept override;
  Status solve(InOut b) noexcept override;

  /// correction = projected state - y; the components of `error` (may be empty) that
  /// leave the constraints are removed, as the projected state cannot have them.
  Status project(double t, In y, Out correction, InOut error) noexcept;

  /// Whether the model has returned `fatal` since begin().
  bool gave_up() const { return gave_up_; }
  void begin() { gave_up_ = false; }

  Stats work() const;
  Dynamics& rates() { return rates_; }

  /// CVRhsFn and ARKRhsFn; user data: a FirstOrder.
  static int rate_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                           void* self) noexcept;

 private:
  Status newton_matrix() noexcept;
  Status newton_solve() noexcept;
  Status project_error(double t, In y, InOut error) noexcept;

  Dynamics rates_, newton_;
  std::optional<Projection> projection_;
  const std::size_t n_;
  const bool shared_;  // both Dynamics use System::linearize
  SparseForm* const sparse_;
  std::unique_ptr<LinearSolver> own_;  // of the Newton matrix, when shared_ and sparse_
  std::vector<double> own_values_;
  bool gave_up_ = false;
  bool newton_current_ = false;  // what is factored is the Newton matrix
  Dynamics::Base base_ = Dynamics::Base::fresh;
  double t_ = 0, gamma_ = 0;  // of the Newton matrix, with the state below
  std::vector<double> q_, v_, a_, lambda_;
  std::vector<double> dq_, r_, c_, multipliers_;  // scratch
  std::vector<double> g_dot_, g_dot_0_;
};

}  // namespace tress::integrators
