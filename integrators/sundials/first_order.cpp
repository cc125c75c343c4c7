#include "integrators/sundials/first_order.h"

#include <algorithm>
#include <cmath>

namespace tress::integrators {

FirstOrder::FirstOrder(System& system, const Options& options)
    : rates_(system, options),
      newton_(system, options),
      n_(static_cast<std::size_t>(rates_.n())),
      shared_(rates_.m() == 0 && system.explicit_form() == nullptr),
      sparse_(shared_ ? system.sparse_form() : nullptr) {
  if (sparse_ != nullptr) {
    own_ = make_linear_solver(options.linear, sparse_->pattern());
    own_values_.resize(static_cast<std::size_t>(sparse_->pattern().nonzeros()));
  }
  if (options.formulation == Formulation::projection) projection_.emplace(rates_);
  for (auto* x : {&q_, &v_, &a_, &dq_, &r_}) x->resize(n_);
  for (auto* x : {&lambda_, &c_, &multipliers_, &g_dot_, &g_dot_0_}) {
    x->resize(static_cast<std::size_t>(rates_.m()));
  }
}

Status FirstOrder::rate(double t, In y, Out y_dot) noexcept {
  if (shared_ && own_ == nullptr) newton_current_ = false;
  const In q = y.first(n_), v = y.last(n_);
  const Out a = y_dot.last(n_);
  std::copy(v.begin(), v.end(), y_dot.begin());
  if (const Status s = rates_.accelerate(t, q, v, a, multipliers_); s != Status::ok) {
    return s;
  }
  const bool finite = std::ranges::all_of(a, [](double x) { return std::isfinite(x); });
  return finite ? Status::ok : Status::retry;
}

Status FirstOrder::factor(double t, In y, In y_dot, double gamma) noexcept {
  t_ = t;
  gamma_ = gamma;
  std::ranges::copy(y.first(n_), q_.begin());
  std::ranges::copy(y.last(n_), v_.begin());
  std::ranges::copy(y_dot.last(n_), a_.begin());
  if (rates_.m() > 0) {
    if (const Status s = rates_.accelerate(t, q_, v_, a_, lambda_); s != Status::ok) {
      return s;
    }
  }
  base_ = Dynamics::Base::fresh;
  return newton_matrix();
}

Status FirstOrder::newton_matrix() noexcept {
  newton_current_ = true;
  const Weights w{1, gamma_, gamma_ * gamma_};
  if (own_ == nullptr) return newton_.linearize(t_, q_, v_, a_, lambda_, w);
  ++newton_.stats.linearizations;
  const Status s = sparse_->values(t_, q_, v_, a_, w, own_values_);
  return s == Status::ok ? own_->factor(own_values_) : s;
}

/// Overwrites (r_, c_) with (z, nu).
Status FirstOrder::newton_solve() noexcept {
  if (own_ == nullptr) return newton_.solve(r_, c_);
  ++newton_.stats.solves;
  return own_->solve(r_);
}

Status FirstOrder::solve(InOut b) noexcept {
  const InOut x_q = b.first(n_), x_v = b.last(n_);
  for (std::size_t i = 0; i < n_; ++i) dq_[i] = x_q[i] + gamma_ * x_v[i];
  Status s = newton_.directional(t_, q_, v_, a_, lambda_, dq_, x_v, r_, c_, base_);
  if (s == Status::ok) base_ = Dynamics::Base::kept;
  if (s == Status::ok && !newton_current_) s = newton_matrix();
  if (s != Status::ok) return s;
  for (double& entry : r_) entry *= -gamma_;
  for (double& entry : c_) entry *= -gamma_;
  if (s = newton_solve(); s != Status::ok) return s;
  for (std::size_t i = 0; i < n_; ++i) {
    x_v[i] += r_[i];
    x_q[i] += gamma_ * x_v[i];
  }
  return Status::ok;
}

Status FirstOrder::project(double t, In y, Out correction, InOut error) noexcept {
  std::ranges::copy(y, correction.begin());
  Status s = projection_->project(t, correction.first(n_), correction.last(n_));
  for (std::size_t i = 0; i < y.size(); ++i) correction[i] -= y[i];
  if (s == Status::ok && !error.empty()) s = project_error(t, y, error);
  return s;
}

/// Removes from e_q and e_v their M-orthogonal part across the constraints, e.g. e_q -=
/// M^-1 G^T (G M^-1 G^T)^-1 G e_q, using the factorisation of project().
Status FirstOrder::project_error(double t, In y, InOut error) noexcept {
  ConstraintForm& form = *rates_.constraints();
  std::ranges::fill(dq_, 0.0);
  if (const Status s = form.rate(t, y.first(n_), dq_, g_dot_0_); s != Status::ok)
    return s;
  for (const InOut part : {error.first(n_), error.last(n_)}) {
    // G part = rate(part) - rate(0): the second is dg/dt of moving constraints.
    if (const Status s = form.rate(t, y.first(n_), part, g_dot_); s != Status::ok)
      return s;
    for (std::size_t k = 0; k < g_dot_.size(); ++k) g_dot_[k] -= g_dot_0_[k];
    std::ranges::fill(r_, 0.0);
    if (const Status s = rates_.solve(r_, g_dot_); s != Status::ok) return s;
    for (std::size_t i = 0; i < n_; ++i) part[i] -= r_[i];
  }
  return Status::ok;
}

Stats FirstOrder::work() const {
  Stats all = rates_.stats;
  all.residuals += newton_.stats.residuals;
  all.linearizations += newton_.stats.linearizations;
  all.solves += newton_.stats.solves;
  all.rank_deficiency = std::max(all.rank_deficiency, newton_.stats.rank_deficiency);
  all.condition = std::max(all.condition, newton_.stats.condition);
  if (own_ != nullptr) all.solver = own_->name();
  return all;
}

int FirstOrder::rate_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                              void* self) noexcept {
  FirstOrder& equations = *static_cast<FirstOrder*>(self);
  const Status status = equations.rate(t, entries(y), entries(y_dot));
  if (status == Status::fatal) equations.gave_up_ = true;
  return sundials_code(status);
}

}  // namespace tress::integrators
