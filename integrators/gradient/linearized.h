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
///     dr_k = r_q dq + r_v dv + r_a da + dr/ds_k,   and likewise dc_k.
class Linearized {
 public:
  /// All must outlive it. `sparse`: as ResidualDerivative.
  Linearized(System& system, std::span<const VariedSystem> varied, const Options& options,
             bool sparse);

  Dynamics& dynamics() { return dynamics_; }
  int constraints() const { return dynamics_.m(); }
  /// Moves to a state, which must last until the next call.
  Status move(const WatchedSystem::Motion& state) noexcept;
  /// Prepares solve() with S(w) at that state.
  Status factor(Weights w) noexcept;
  /// (dr, dc) along a direction of parameter k.
  Status along(std::size_t k, In dq, In dv, In da, Out dr, Out dc) noexcept;
  Status solve(InOut r, InOut c) noexcept { return dynamics_.solve(r, c); }

 private:
  Status add_parameter(std::size_t k, InOut dr, InOut dc) noexcept;

  Dynamics dynamics_;
  ResidualDerivative derivative_;
  std::span<const VariedSystem> varied_;
  std::vector<std::vector<std::unique_ptr<Dynamics>>> equations_;  // of varied_
  bool based_ = false;  // some stencil needs the residual of the system itself
  const WatchedSystem::Motion* state_ = nullptr;
  std::vector<double> base_r_, base_c_, r_, c_;
};

}  // namespace tress::integrators
