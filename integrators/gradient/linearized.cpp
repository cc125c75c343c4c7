#include "integrators/gradient/linearized.h"

#include <algorithm>

#include "linear/vector_ops.h"

namespace tress::integrators {

Linearized::Linearized(System& system, std::span<const VariedSystem> varied,
                       const Options& options, KnownForces forces, System* copies)
    : dynamics_(system, options),
      derivative_(dynamics_, forces, copies),
      varied_(varied),
      base_r_(size(dynamics_.n())),
      base_c_(size(dynamics_.m())),
      r_(base_r_),
      c_(base_c_),
      dc_(base_c_),
      none_(base_r_),
      dv_(varied.size() * base_r_.size()),
      da_(dv_) {
  for (const VariedSystem& one : varied) {
    based_ = based_ || (!one.starts && !one.simple && one.stencil.base != 0);
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
  w_ = w;
  return dynamics_.linearize(state_->t, state_->q, state_->v, state_->a, state_->lambda,
                             w);
}

Status Linearized::excess(In dq, In dv, In da, Out x) noexcept {
  shifted(dv_, dv, -w_.vel / w_.pos, dq);
  shifted(da_, da, -1 / w_.pos, dq);
  Status s = derivative_.at_fixed_q(dv_, da_, x);
  const std::size_t n = base_r_.size();
  for (std::size_t k = 0; k < varied_.size() && s == Status::ok; ++k) {
    const Out column = x.subspan(k * n, n);
    std::ranges::fill(dc_, 0.0);
    s = add_parameter(k, column, dc_);
    if (s == Status::ok) s = dynamics_.solve(column, dc_);
  }
  add(x, 1 / w_.pos, dq);
  return s;
}

Status Linearized::accelerate(In dq, In dv, Out da) noexcept {
  const std::size_t n = base_r_.size();
  Status s = Status::ok;
  for (std::size_t k = 0; k < varied_.size() && s == Status::ok; ++k) {
    const Out column = da.subspan(k * n, n);
    s = derivative_.along(dq.subspan(k * n, n), dv.subspan(k * n, n), none_, column, dc_);
    if (s == Status::ok) s = add_parameter(k, column, dc_);
    if (s == Status::ok) s = dynamics_.solve(column, dc_);
  }
  for (double& entry : da) entry = -entry;
  return s;
}

Status Linearized::add_parameter(std::size_t k, InOut dr, InOut dc) noexcept {
  if (varied_[k].starts) return Status::ok;
  if (const auto& simple = varied_[k].simple) {
    for (std::size_t i = 0; i < dr.size(); ++i) {
      dr[i] += simple->constant[i] + simple->by_q[i] * state_->q[i] +
               simple->by_v[i] * state_->v[i];
    }
    return Status::ok;
  }
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
