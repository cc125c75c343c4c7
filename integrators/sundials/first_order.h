#pragma once

#include <optional>

#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"
#include "integrators/stage/stage.h"
#include "integrators/sundials/sundials.h"

namespace tress::integrators {

/// The system as an ODE: y = (q, v), y' = f = (v, a(t, q, v)) with a, lambda from
/// Dynamics::accelerate.
///
/// Implicit methods ask for y = known + gamma f(t, y), that is
///
///     v = v_bar + gamma a,              v_bar = known_v
///     q = q_bar + gamma^2 a,            q_bar = known_q + gamma known_v
///
/// with r(t, q, v, a) = 0: the equations of a Stage with the weights (1, gamma, gamma^2),
/// which are solved for a. No mass matrix is factored, no 2n matrix and no derivative of
/// M^-1 is ever formed.
class FirstOrder {
 public:
  /// Takes formulation, solver and tolerances from the options; the system must outlive
  /// it.
  FirstOrder(System& system, const Options& options);

  /// Evaluates y' = f(t, y).
  Status rate(double t, In y, Out y_dot) noexcept;

  /// y: guess in, solution of y = known + gamma f(t, y) out.
  Status solve(double t, In known, double gamma, InOut y) noexcept;

  /// correction = projected state - y; the components of `error` (may be empty) that
  /// leave the constraints are removed, as the projected state cannot have them.
  Status project(double t, In y, Out correction, InOut error) noexcept;

  /// Whether the model has returned `fatal` since begin().
  bool gave_up() const { return gave_up_; }
  /// Forgets an earlier `fatal`.
  void begin() { gave_up_ = false; }

  /// Returns the work of all evaluations.
  const Stats& work() const { return rates_.stats; }
  /// Returns the system with the form of its constraints.
  Dynamics& rates() { return rates_; }

  /// CVRhsFn and ARKRhsFn; user data: a FirstOrder.
  static int rate_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                           void* self) noexcept;

 private:
  Status project_error(double t, In y, InOut error) noexcept;

  Dynamics rates_;
  Stage stage_;
  std::optional<Projection> projection_;
  const std::size_t n_;
  bool gave_up_ = false;
  std::vector<double> q_bar_, a_, lambda_, multipliers_;
  std::vector<double> none_, r_, g_dot_, g_dot_0_;  // scratch
};

}  // namespace tress::integrators
