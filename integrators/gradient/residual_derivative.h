#pragma once

#include <vector>

#include "integrators/formulation/dynamics.h"
#include "integrators/gradient/known_forces.h"
#include "integrators/gradient/varied_system.h"

namespace tress::integrators {

/// Derivatives of (r - G^T lambda, c), the equations of Dynamics, along directions at one
/// state. Those at fixed q come from the matrices of SparseForm where the system has one,
/// else from central differences.
class ResidualDerivative {
 public:
  /// `copies`: the same system several times as one, whose residuals cost less so; null:
  /// none. All must outlive it.
  ResidualDerivative(Dynamics& dynamics, KnownForces forces, System* copies);

  /// Moves to a state. The spans must last until the next call.
  Status move(double t, In q, In v, In a, In lambda) noexcept;
  /// dr = r_v dv + r_a da of several directions, one behind the other (n each).
  Status at_fixed_q(In dv, In da, Out dr) noexcept;
  /// dr (n), dc (m): derivatives along (dq, dv, da). Those along dq that are not by
  /// matrices are differences of order 4, which stretching asks for.
  Status along(In dq, In dv, In da, Out dr, Out dc) noexcept;

 private:
  Status find_by_q() noexcept;
  Status difference(In dv, In da, Out dr, Out dc) noexcept;
  Status differences(In dq, In dv, In da, Out dr, Out dc) noexcept;
  Status differences_of_copies(In dv, In da, Out dr) noexcept;
  double length(In dv, In da) const noexcept;

  Dynamics& dynamics_;
  SparseForm* sparse_;     // null: not used
  System* copies_;         // null: not used
  Stencil by_rates_;       // of differences along (dv, da), in parts of a distance
  double distance_along_;  // of differences along dq
  std::size_t count_ = 0;  // of copies
  double t_ = 0;
  In q_, v_, a_, lambda_;
  std::vector<double> by_q_, by_v_, by_a_;  // values of the matrices
  bool known_by_q_ = false;                 // by_q_ is that of this state
  bool constant_by_a_ = false;              // by_a_ is that of all states
  std::vector<double> none_;                // (n) zeros
  std::vector<double> q_shift_, v_shift_, a_shift_, a_typ_, r_, c_;
  std::vector<double> q_copies_, v_copies_, a_copies_, r_copies_;
  std::vector<double> e_;  // of each direction
};

}  // namespace tress::integrators
