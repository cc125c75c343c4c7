#pragma once

#include "contract/forms/sparse_form.h"
#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// The system as a residual F(t, y, y') = 0 with y = (q, v, lambda, mu):
///
///     q' - v - G^T mu                   (n)
///     r(t, q, v, v') - G^T lambda       (n)
///     rows of lambda                    (m)  g'' = -alpha g - beta g' (index 1), g
///                                            (index 3), or g' (GGL)
///     rows of mu                        (m)  g, GGL only
///
/// GGL: Gear, Gupta, Leimkuhler, J. Comput. Appl. Math. 12 (1985) 77, stabilised index 2.
/// Without constraints F consists of the first two rows only.
class DaeForm {
 public:
  /// Takes formulation and gains from the options; the system must outlive it.
  DaeForm(System& system, const Options& options);

  /// Number of unknowns that follow q and v.
  static int multipliers(System& system, Formulation formulation);

  /// Evaluates F at y and y'.
  Status residual(double t, In y, In y_dot, Out f) noexcept;

  /// Fills lambda, mu = 0 and y' = (v, a, 0) so that F = 0 when (q, v) satisfies g = 0
  /// and g' = 0, without a corrector of the initial values.
  Status consistent(double t, InOut y, Out y_dot) noexcept;

  /// Computes typical sizes of the multipliers at a consistent y. For mu: v_typ / |G|.
  /// For lambda: the larger of its value and of the force that reverses v_typ within
  /// q_typ, M v_typ^2 / (q_typ |G|).
  Status multiplier_scale(double t, In y, Out typ) noexcept;

  /// 1 for differential unknowns (q and v), 0 for multipliers.
  void differential(Out id) const;

  Dynamics dynamics;              // system with the form of its constraints
  SparseForm* const sparse;       // null without constraints
  const Formulation formulation;  // form of the constraints
  const std::size_t n, m;         // numbers of coordinates and constraints

  /// The parts of y, y' or a direction.
  struct Parts {
    In q, v, lambda, mu;  // q (n), v (n), lambda (m), mu (m; GGL only)
  };
  /// Returns the parts of a vector of unknowns.
  Parts parts(In y) const noexcept;

 private:
  std::vector<double> gt_, mass_;
};

}  // namespace tress::integrators
