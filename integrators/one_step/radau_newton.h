#pragma once

#include <array>
#include <vector>

#include "integrators/formulation/dynamics.h"
#include "integrators/one_step/radau_table.h"
#include "integrators/stage/newton_rules.h"
#include "integrators/stage/unknowns.h"

namespace tress::integrators {

/// Newton's method for all stages of a step of Radau IIA at once,
///
///     F_i(a, lambda) = r(t_i, q_i, v_i, a_i) - G^T lambda_i = 0,  c = 0,
///     v_i = v + h sum_j A_ij a_j,   q_i = q + c_i h v + h^2 sum_j (A^2)_ij a_j
///
/// with the Jacobian of all 3 (n + m) unknowns. Where strands turn far within a step, the
/// Jacobians of the stages differ. The iteration of RadauStages, which solves stage after
/// stage, then has a rate of 0.6 to 1.7 at the solution itself.
///
/// GMRES solves the linear equations [Saad, Schultz 1986, SIAM J. Sci. Stat. Comput. 7,
/// 856]. Products with the Jacobian are differences of F. The preconditioner P has the
/// coefficients T in place of A and the matrix of each stage, as the iteration of
/// RadauStages. Corrections are damped until |P^-1 F|, with P of the last iterate,
/// falls (shrinks_enough()).
///
/// Cost: three matrices, three solves and five residuals for each vector of GMRES and for
/// each damping. Stats::newton_iterations counts the vectors. The memory of GMRES is 31
/// times 3 (n + m). No call allocates.
class RadauNewton {
 public:
  /// Accelerations and multipliers of the stages.
  using Stages = std::vector<Unknowns>;

  /// Works on `dynamics`, which must outlive it.
  RadauNewton(Dynamics& dynamics, const NewtonRules& rules, int iterations);

  /// Sets the start of the step. The spans must last until the next call.
  void start_from(double t, In q, In v) noexcept { start_ = {t, q, v}; }
  /// Solves a step of length h; x: guess in, solution out.
  Status solve(double h, Stages& x) noexcept;

 private:
  static constexpr std::size_t count = RadauTable::stages;
  /// Largest number of vectors of GMRES.
  static constexpr std::size_t most_vectors = 30;
  struct Start {
    double t = 0;
    In q, v;
  };
  using Points = std::array<std::vector<double>, count>;

  double time(std::size_t i) const noexcept;
  void place(const Stages& x, Points& q, Points& v) const noexcept;
  /// F(x); moves q_shift_ and v_shift_ to the stages of x.
  Status evaluate(const Stages& x, Stages& f) noexcept;
  /// The base of products and of P.
  Status take_base(const Stages& x) noexcept;
  /// y becomes J y.
  Status multiply(Stages& y) noexcept;
  Status coupled(std::size_t i, double change, Stages& y) noexcept;
  /// y becomes P^-1 y.
  Status precondition(Stages& y) noexcept;
  /// y: P^-1 F in, the correction out.
  Status correction(Stages& y) noexcept;
  Status damp(Stages& x) noexcept;
  double dot(const Stages& x, const Stages& y) const noexcept;
  double size_of(const Unknowns& y) const noexcept;
  double size_of(const Stages& y) const noexcept;

  Dynamics& dynamics_;
  NewtonRules rules_;
  int iterations_;
  double h_ = 0;
  Start start_;
  Points q_, v_, q_shift_, v_shift_;   // of the base, and near it
  Stages base_, f_, shifted_, moved_;  // base_: its unknowns, f_: F there
  Stages level_, step_;
  std::vector<Stages> basis_;
};

}  // namespace tress::integrators
