#pragma once

#include <vector>

#include "integrators/formulation/dynamics.h"

namespace tress {

/// The nonlinear equations of one implicit stage, shared by every implicit fixed-step
/// method: find a (n) and lambda (m) with
///     r(t, q, v, a) = G^T lambda,  c = 0,   q = q_bar + w.pos a,  v = v_bar + w.vel a
/// by Newton's method; where that does not converge, with steps damped by the natural
/// monotonicity test [Deuflhard 2011, Newton Methods for Nonlinear Problems, section 3.3]
/// from the guess, from no acceleration and from standstill: long steps of shaken strands
/// need it. Where that fails too the step is solved short and made longer bit by bit
/// [section 5.1]: soft strands that fall far in one step need that. Options:
/// newton_tolerance bounds the last correction of q and v over System::scale,
/// newton_iterations, refresh.
class Stage {
 public:
  Stage(Dynamics& dynamics, const Options& options);

  /// a, lambda: guess in, solution out. `retry` when the iteration does not converge.
  Status solve(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda) noexcept;

  /// Exactly one Newton step from the guess, converged or not (semi-implicit methods),
  /// with the matrix at acceleration a_matrix.
  Status single_step(double t, In q_bar, In v_bar, Weights w, In a_matrix, InOut a,
                     InOut lambda) noexcept;

  In q() const { return q_; }  // of the last call
  In v() const { return v_; }

 private:
  void place(In q_bar, In v_bar, Weights w, In a) noexcept;
  double size_of(In correction, Weights w) const noexcept;
  Status newton(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda) noexcept;
  Status damped(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda) noexcept;
  Status lengthened(double t, In q_bar, In v_bar, Weights w, InOut a,
                    InOut lambda) noexcept;
  Status halve_until_smaller(double t, In q_bar, In v_bar, Weights w, double size,
                             InOut a, InOut lambda) noexcept;
  Status correct(double t, In q_bar, In v_bar, Weights w, bool linearize, InOut a,
                 InOut lambda, double& correction) noexcept;

  Dynamics& dynamics_;
  double tolerance_;
  int iterations_;
  Refresh refresh_;
  Weights factored_;  // of the matrix that newton() took last
  long matrix_ = -1;  // which of dynamics_'s it was; others may have taken one since
  std::vector<double> q_, v_, r_, c_;
  std::vector<double> a_guess_, lambda_guess_;
  std::vector<double> a_kept_, lambda_kept_, a_step_, lambda_step_;  // of damped steps
};

}  // namespace tress
