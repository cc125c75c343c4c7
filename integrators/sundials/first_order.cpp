#include "integrators/sundials/first_order.h"

#include <algorithm>
#include <cmath>

namespace tress::integrators {
namespace {

/// Returns the options of the stages. The error test allows each unknown atol of its
/// scale and rtol of its size, which is taken as a hundredth of the scale. Newton's
/// iteration may leave a part of that allowance, but not less than the rounding of the
/// unknowns. The matrix is kept as long as it converges.
Options of_stages(Options options) {
  constexpr double sundials_coefficient = 0.1;  // its default, selected by 0
  constexpr double small = 0.01, rounding = 1e-13;
  const double part =
      options.newton_coefficient > 0 ? options.newton_coefficient : sundials_coefficient;
  options.newton_tolerance =
      std::max(part * (options.atol + small * options.rtol), rounding);
  if (options.refresh == Refresh::every_iteration) options.refresh = Refresh::when_slow;
  return options;
}

}  // namespace

FirstOrder::FirstOrder(System& system, const Options& options)
    : rates_(system, options),
      stage_(rates_, of_stages(options)),
      n_(static_cast<std::size_t>(rates_.n())) {
  if (options.formulation == Formulation::projection) projection_.emplace(rates_);
  for (auto* x : {&q_bar_, &a_, &none_, &r_}) x->resize(n_);
  for (auto* x : {&lambda_, &multipliers_, &g_dot_, &g_dot_0_}) {
    x->resize(static_cast<std::size_t>(rates_.m()));
  }
}

Status FirstOrder::rate(double t, In y, Out y_dot) noexcept {
  const In q = y.first(n_), v = y.last(n_);
  const Out a = y_dot.last(n_);
  std::copy(v.begin(), v.end(), y_dot.begin());
  if (const Status s = rates_.accelerate(t, q, v, a, multipliers_); s != Status::ok) {
    return s;
  }
  const bool finite = std::ranges::all_of(a, [](double x) { return std::isfinite(x); });
  return finite ? Status::ok : Status::retry;
}

Status FirstOrder::solve(double t, In known, double gamma, InOut y) noexcept {
  const In v_bar = known.last(n_);
  for (std::size_t i = 0; i < n_; ++i) {
    q_bar_[i] = known[i] + gamma * v_bar[i];
    a_[i] = (y[n_ + i] - v_bar[i]) / gamma;
  }
  const Status s = stage_.solve(t, q_bar_, v_bar, {1, gamma, gamma * gamma}, a_, lambda_);
  if (s == Status::fatal) gave_up_ = true;
  std::ranges::copy(stage_.q(), y.begin());
  std::ranges::copy(stage_.v(), y.last(n_).begin());
  return s;
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
  if (const Status s = form.rate(t, y.first(n_), none_, g_dot_0_); s != Status::ok)
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

int FirstOrder::rate_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                              void* self) noexcept {
  FirstOrder& equations = *static_cast<FirstOrder*>(self);
  const Status status = equations.rate(t, entries(y), entries(y_dot));
  if (status == Status::fatal) equations.gave_up_ = true;
  return sundials_code(status);
}

}  // namespace tress::integrators
