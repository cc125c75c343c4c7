#pragma once

#include <array>
#include <memory>
#include <vector>

#include "integrators/formulation/dynamics.h"
#include "integrators/stage/effort.h"

namespace tress::integrators {

/// Coefficients of a stiffly accurate Rosenbrock method in the form without products by
/// the Jacobian [Hairer, Wanner 1996, Solving ODEs II, eq. IV.7.25]. The last stage is
/// the comparison solution; its increment leads to the new state.
struct RosenbrockTable {
  static constexpr std::size_t most_stages = 8;  // bound of the stages
  /// Coefficients of the stages before, by rows.
  using Rows = std::array<std::array<double, most_stages>, most_stages>;
  std::size_t stages = 0;                  // number of stages
  int order = 0;                           // order of the method
  int embedded_order = 0;                  // order of the comparison solution
  double gamma = 0;                        // diagonal coefficient
  Rows a{};                                // a_ij: of increments in the state of stage i
  Rows c{};                                // c_ij: of increments over h in its equation
  std::array<double, most_stages> time{};  // of the stages, over h
  std::array<double, most_stages> rate{};  // of h dr/dt in their equations
  /// The estimate allowed in one step is share times the tolerance.
  double share = 1;
};

/// The stages of one step of q' = v, v' = a, r(t, q, v, a) = 0, a system of index 1 in
/// which a has no derivative. Let g = gamma h, x, z, alpha the increments of q, v, a, and
/// Q, V, A the state of stage i (q + sum a_ij x_j and so on). Its linear equations
///
///     x/g - z = d,      d = V + sum c_ij x_j / h
///     z/g - alpha = b,  b = A + sum c_ij z_j / h
///     dr/dq x + dr/dv z + dr/da alpha = -r(t_i, Q, V, A) - h rate_i dr/dt
///
/// reduce with y = alpha + b + d/g, so that x = g^2 y and z = g y - d, to
///
///     S(1, g, g^2) y = -r(t_i, Q, V, A) - h rate_i dr/dt + dr/da (b + d/g) + dr/dv d.
///
/// All derivatives are those at the start of the step. The last two terms are a central
/// difference of r at (q, v +- e d, +- e (b + d/g)), exact where r is at most quadratic
/// in v. Quadratic drag, for one, is not. Mass matrices that depend on q
/// need no further term, since a is part of the state at which S is taken.
///
/// Cost of a step: a matrix, and three residuals and a solve for each stage, two
/// residuals for dr/dt, a residual and a solve for the estimate. The matrix must be the
/// exact Jacobian.
class RosenbrockStages {
 public:
  /// Works on `dynamics`, which must outlive it, as must `table`. Differences of
  /// velocities are this part of their typical sizes (or of v where it is larger).
  RosenbrockStages(Dynamics& dynamics, const Options& options,
                   const RosenbrockTable& table, double difference_part);

  /// Steps from (q, v) at t, with r(t, q, v, a) = 0, over h.
  Status step(double t, double h, In q, In v, In a, In lambda, Effort effort) noexcept;
  /// There is no history.
  void forget() {}

  /// Returns the coordinates at the end of the last step.
  In q() const { return q_; }
  /// Returns the rates at the end of the last step.
  In v() const { return v_; }
  /// Returns the accelerations at the end of the last step.
  In a() const { return a_; }
  /// There are no multipliers.
  In lambda() const { return {}; }
  /// Writes the estimated error of the last step. It is the distance from the comparison
  /// solution, plus the correction by the defect r(t, q, v, a) of the end. All
  /// derivatives are those of the start. Where a stiff mass or stiffness changes much
  /// within a step, both solutions have the same error, which the defect shows.
  Status difference(Out dq, Out dv) noexcept;

 private:
  /// The state at which the derivatives are taken.
  struct Start {
    double t;
    In q, v, a;
  };
  /// Adds the increments of the first `count` stages with the weights `row`, times
  /// `factor`.
  void add_increments(const std::array<double, RosenbrockTable::most_stages>& row,
                      std::size_t count, double factor,
                      const std::vector<std::vector<double>>& increments,
                      InOut sum) const noexcept;
  /// Sets rate_ = dr/dt by a one-sided difference into the step, with r there in rhs_.
  Status differentiate_in_time(const Start& start, double h) noexcept;
  /// Adds dr/da y_ + dr/dv d_ to rhs_.
  Status add_products(const Start& start) noexcept;
  Status solve_stage(const Start& start, double h, std::size_t i) noexcept;

  const RosenbrockTable& table_;
  Dynamics& dynamics_;
  double difference_part_;
  double end_ = 0, g_ = 0;  // of the last step: its end (s), and gamma h
  std::vector<std::vector<double>> x_, z_, alpha_;  // increments of the stages
  std::vector<double> q_, v_, a_;                   // state of the stage, end of the step
  std::vector<double> d_, y_;                       // d and b + d/g of the stage
  std::vector<double> rhs_, rate_, v_shift_, a_shift_, r_, r_other_;
};

/// The method with a fixed step, or with Options::tolerance. `table` must outlive it.
std::unique_ptr<Integrator> make_rosenbrock(const RosenbrockTable& table, System& system,
                                            const Options& options,
                                            double difference_part);

}  // namespace tress::integrators
