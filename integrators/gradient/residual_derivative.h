#pragma once

#include <array>
#include <vector>

#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// Derivatives of (r - G^T lambda, c), the equations of Dynamics, along directions at one
/// state. They come from the matrices of SparseForm where the system has one, else from
/// central differences. There are two of these where stiff modes move much faster than
/// the rest: one alone would leave rounding errors of the positions.
class ResidualDerivative {
 public:
  /// `sparse`: whether the SparseForm is all of dr/dq and dr/dv, which it is not where
  /// effects couple distant points. `dynamics` must outlive it.
  ResidualDerivative(Dynamics& dynamics, bool sparse);

  /// Moves to a state. The spans must last until the next call.
  Status move(double t, In q, In v, In a, In lambda) noexcept;
  /// dr (n), dc (m): the derivatives along (dq, dv, da).
  Status along(In dq, In dv, In da, Out dr, Out dc) noexcept;

 private:
  Status differences(In dq, In dv, In da, Out dr, Out dc) noexcept;
  Status add_difference(double length, In dq, In dv, In da, InOut dr, InOut dc) noexcept;

  Dynamics& dynamics_;
  SparseForm* sparse_;  // null: not used
  double t_ = 0;
  In q_, v_, a_, lambda_;
  std::array<std::vector<double>, 3> by_;  // dr/dq, dr/dv, dr/da
  std::vector<double> none_;               // (n) zeros
  std::vector<double> q_shift_, v_shift_, a_shift_, a_typ_, r_, c_, before_r_, before_c_;
};

}  // namespace tress::integrators
