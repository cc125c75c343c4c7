#pragma once

#include <array>
#include <limits>
#include <vector>

#include "integrators/formulation/dynamics.h"
#include "integrators/one_step/radau_newton.h"
#include "integrators/one_step/radau_table.h"
#include "integrators/stage/effort.h"
#include "integrators/stage/newton_rules.h"
#include "integrators/stage/stress_origin.h"
#include "integrators/stage/unknowns.h"

namespace tress::integrators {

/// Continuation in the length of parts of a step.
struct RadauParts {
  double first, shortest;  // over the step
  double least_growth;     // of the length from part to part; it falls where one fails
  double growth_power;     // of the growth after a part that succeeds
  int most = std::numeric_limits<int>::max();  // number of parts
};

/// The stages of one step of q' = v, v' = a, by
///
///     v_i = v + h sum_j A_ij a_j,   q_i = q + h sum_j A_ij v_j,   r(t_i, q_i, v_i, a_i)
///     = G^T lambda_i
///
/// The modified Newton iteration replaces A by the lower triangular T in the matrix of
/// the 3n unknowns. The stages are then solved one after the other with the same weights
/// (1, g, g^2), g = T_ii h, so that one real matrix serves all of them. With the changes
/// x, z, y of q, v, a, and V_i = v + h sum_j A_ij a_j from the last iteration,
///
///     z_i = V_i - v_i + h sum_{j<=i} T_ij y_j
///     x_i = q + h sum_j A_ij v_j - q_i + h sum_{j<=i} T_ij z_j
///     S(1, g, g^2) y_i = -r(t_i, q_i + x_i, v_i + z_i, a_i) at y_i = 0.
///
/// v_i is an unknown of its own until the iteration has converged: where it is tied to
/// a_j, the rate is 0.5 with Crout's factors.
///
/// Matrices: one for all stages while it converges (Refresh::every_step, when_slow), or
/// one for each stage at its own state, which reaches longer steps of strands whose stiff
/// directions turn. Where that fails, shorter steps from the same start lead to the whole
/// one. Where these stop growing, RadauNewton solves longer ones.
class RadauStages {
 public:
  /// Works on `dynamics`, which must outlive it. `remaining` is the error left at which
  /// the iteration ends over its tolerance.
  RadauStages(Dynamics& dynamics, const Options& options,
              double remaining = NewtonRules::margin);

  /// Steps from (q, v) at t, with acceleration a and multipliers lambda, over h.
  Status step(double t, double h, In q, In v, In a, In lambda, Effort effort) noexcept;
  /// The next step does not guess from the last one.
  void forget() { solved_.h = 0; }

  /// Returns the coordinates at the end of the last step.
  In q() const { return q_[RadauTable::stages - 1]; }
  /// Returns the rates at the end of the last step.
  In v() const { return v_[RadauTable::stages - 1]; }
  /// Returns the accelerations at the end of the last step.
  In a() const { return x_.back().a; }
  /// Returns the multipliers at the end of the last step.
  In lambda() const { return x_.back().lambda; }
  /// Writes the estimated errors of the last step. The formula of order 3 has the weight
  /// T_ii at the start of the step. The estimate is (I - g J)^-1 times the difference to
  /// it [Hairer, Wanner 1996, Solving ODEs II, eq. IV.8.19]. Zero where it cannot be
  /// evaluated.
  Status difference(Out dq, Out dv) noexcept;

 private:
  /// The start of the step.
  struct Start {
    double t = 0;
    In q, v, a, lambda;
  };
  /// Accelerations and multipliers at the stages of the step from t over h.
  struct Solution {
    double t = 0, h = 0;  // h = 0: none
    std::vector<Unknowns> x;
  };
  /// One matrix of all stages; one of each stage; these without stresses of other states
  /// (StressOrigin).
  enum class Matrices { one, own, own_stresses };

  void start_from(const Start& start) noexcept;
  void guess(const Solution& from, double h) noexcept;
  Status newton(double h) noexcept;
  Status iterate(double h, Matrices matrices) noexcept;
  /// Corrects all stages; `fresh`: with a new matrix.
  Status sweep(double h, Matrices matrices, bool fresh, bool first,
               double& correction) noexcept;
  Status linearize(double h, std::size_t i, Matrices matrices, bool first) noexcept;
  /// Corrects stage i from its state q_, v_ at which y_i = 0.
  Status correct_stage(double h, std::size_t i) noexcept;
  /// Sets q_ and v_ to those of the accelerations.
  void tie(double h) noexcept;
  template <class Solve>
  Status follow(const RadauParts& parts, double h, Solve solve) noexcept;
  /// Solves a part of the step, then longer ones from its polynomial.
  Status by_parts(double h) noexcept;
  /// Goes on from the longest part, with the whole Jacobian.
  Status by_path(double h) noexcept;
  /// Guesses a step of length h from the last two parts.
  void extrapolate(double h) noexcept;
  void keep(double h, Solution& solution) const noexcept;
  double time(double h, std::size_t i) const noexcept {
    return start_.t + radau_table().c[i] * h;
  }

  Dynamics& dynamics_;
  NewtonRules rules_;
  int iterations_;
  Refresh refresh_;
  Start start_;
  std::vector<Unknowns> x_, guess_, y_;         // of the stages; y_: last correction
  std::vector<std::vector<double>> q_, v_, z_;  // of the stages; z_: change of v_
  Solution solved_, part_;                      // the last step, the longest part
  Solution before_;                             // the part solved before it
  RadauNewton whole_;
  std::vector<StressOrigin> stresses_;  // of the stages
};

}  // namespace tress::integrators
