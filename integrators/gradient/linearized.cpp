#include "integrators/gradient/linearized.h"

#include <algorithm>

#include "linear/vector_ops.h"

namespace tress::integrators {

Linearized::Linearized(System& system, std::span<const VariedSystem> varied,
                       const Options& options, bool sparse)
    : dynamics_(system, options),
      derivative_(dynamics_, sparse),
      varied_(varied),
      base_r_(size(dynamics_.n())),
      base_c_(size(dynamics_.m())),
      r_(base_r_),
      c_(base_c_) {
  for (const VariedSystem& one : varied) {
    based_ = based_ || one.stencil.base != 0;
    auto& equations = equations_.emplace_back();
    for (const auto& made : one.systems) {
      equations.push_back(std::make_unique<Dynamics>(*made, options));
    }
  }
}

Status Linearized::move(const WatchedSystem::Motion& state) noexcept {
  state_ = &state;
  const Status s = derivative_.move(state.t, state.q, state.v, state.a, state.lambda);
  if (s != Status::ok || !based_) return s;
  return dynamics_.residual(state.t, state.q, state.v, state.a, state.lambda, base_r_,
                            base_c_);
}

Status Linearized::factor(Weights w) noexcept {
  return dynamics_.linearize(state_->t, state_->q, state_->v, state_->a, state_->lambda,
                             w);
}

Status Linearized::along(std::size_t k, In dq, In dv, In da, Out dr, Out dc) noexcept {
  const Status s = derivative_.along(dq, dv, da, dr, dc);
  return s == Status::ok ? add_parameter(k, dr, dc) : s;
}

Status Linearized::add_parameter(std::size_t k, InOut dr, InOut dc) noexcept {
  const Stencil& stencil = varied_[k].stencil;
  add(dr, stencil.base, base_r_);
  add(dc, stencil.base, base_c_);
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    const Status s = equations_[k][i]->residual(state_->t, state_->q, state_->v,
                                                state_->a, state_->lambda, r_, c_);
    if (s != Status::ok) return s;
    add(dr, stencil.weight[i], r_);
    add(dc, stencil.weight[i], c_);
  }
  return Status::ok;
}

}  // namespace tress::integrators
