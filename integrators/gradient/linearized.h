#pragma once

#include <memory>
#include <span>
#include <vector>

#include "integrators/gradient/residual_derivative.h"
#include "integrators/gradient/varied_system.h"
#include "integrators/gradient/watched_system.h"

namespace tress::integrators {

/// The equations of a run at one of its states, linearized in the state and in every
/// parameter s_k:
///
///     f_k(dq, dv, da) = r_q dq + r_v dv + r_a da + dr/ds_k,
///
/// with constraints g_q dq + dg/ds_k = 0 and the derivatives of their multipliers.
class Linearized {
 public:
  /// `forces`, `copies`: as ResidualDerivative. All must outlive it.
  Linearized(System& system, std::span<const VariedSystem> varied, const Options& options,
             KnownForces forces, System* copies);

  /// Returns the system with the form of its constraints.
  Dynamics& dynamics() { return dynamics_; }
  /// Moves to a state, which must last until the next call.
  Status move(const WatchedSystem::Motion& state) noexcept;
  /// Prepares the calls below with S(w) at that state.
  Status factor(Weights w) noexcept;
  /// x = S^-1 f_k of all k, one behind the other as the directions: the excess of da if q
  /// moves by w.pos da and v by w.vel da. S has r_q in it: with y = dq/w.pos
  ///
  ///     x = y + S^-1 (r_v (dv - w.vel y) + r_a (da - y) + dr/ds_k),   w.acc = 1,
  ///
  /// and likewise dg/ds_k alone remains of the constraints.
  Status excess(In dq, In dv, In da, Out x) noexcept;
  /// da with f_k = 0, of w = {1, 0, 0}; of all k.
  Status accelerate(In dq, In dv, Out da) noexcept;
  /// Adds the derivatives (dr, dc) of the equations by parameter k, at a fixed state.
  Status add_parameter(std::size_t k, InOut dr, InOut dc) noexcept;

 private:
  Dynamics dynamics_;
  ResidualDerivative derivative_;
  std::span<const VariedSystem> varied_;
  std::vector<std::vector<std::unique_ptr<Dynamics>>> equations_;  // of varied_
  bool based_ = false;  // some column needs the residual of the system itself
  const WatchedSystem::Motion* state_ = nullptr;
  Weights w_;
  std::vector<double> base_r_, base_c_, r_, c_, dc_;
  std::vector<double> none_;     // (n) zeros
  std::vector<double> dv_, da_;  // of all columns, beyond those of y
};

}  // namespace tress::integrators
