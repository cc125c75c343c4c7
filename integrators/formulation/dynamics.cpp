#include "integrators/formulation/dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/finite.h"

namespace tress::integrators {
double scaled_norm(In x, In typ) noexcept {
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double entry = std::abs(x[i]) / typ[i];
    if (!(entry <= std::numeric_limits<double>::max())) {
      return std::numeric_limits<double>::infinity();
    }
    largest = std::max(largest, entry);
  }
  return largest;
}

Dynamics::Dynamics(System& system, const Options& options)
    : system_(system),
      layout_{system.layout().coordinates, options.formulation == Formulation::correction
                                               ? 0
                                               : system.layout().constraints},
      bordered_form_(layout_.constraints > 0 ? bordered_form(system) : nullptr),
      sparse_(layout_.constraints > 0 && bordered_form_ == nullptr ? system.sparse_form()
                                                                   : nullptr),
      constraints_(layout_.constraints > 0 ? system.constraint_form() : nullptr),
      explicit_(system.layout().constraints > 0 ? nullptr : system.explicit_form()),
      position_level_(options.formulation == Formulation::index3) {
  if (options.formulation == Formulation::baumgarte) {
    alpha_ = options.alpha;
    beta_ = options.beta;
  }
  for (auto* values :
       {&q_typ_, &v_typ_, &zero_n_, &q_shift_, &v_shift_, &r_base_, &lost_q_, &lost_v_}) {
    values->assign(size(n()), 0.0);
  }
  for (auto* values : {&g_typ_, &zero_m_, &g_, &g_dot_, &c_base_}) {
    values->assign(size(m()), 0.0);
  }
  system_.scale(q_typ_, v_typ_);
  if (constraints_ == nullptr && !system.traits().regular_mass) {
    constexpr double short_time = 1e-4;
    start_step_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < q_typ_.size(); ++i) {
      start_step_ = std::min(start_step_, short_time * q_typ_[i] / v_typ_[i]);
    }
  }
  stats.solver = "structured";
  if (constraints_ == nullptr) return;
  constraints_->scale(g_typ_);
  if (bordered_form_ != nullptr) {
    bordered_.emplace([&system](InOut b) { return system.solve(b, b); },
                      constraints_->pattern(), q_typ_);
  } else {
    kkt_.emplace(options.linear, sparse_->pattern(), constraints_->pattern());
    s_.resize(size(sparse_->pattern().nonzeros()));
  }
  for (auto* values : {&gt_, &ht_, &rate_gt_}) {
    values->resize(size(constraints_->pattern().nonzeros()));
  }
}

Status Dynamics::residual(double t, In q, In v, In a, In lambda, Out r, Out c) noexcept {
  ++stats.residuals;
  const Status answer = noted(system_.residual(t, q, v, a, r), t, q, v);
  if (answer != Status::ok || constraints_ == nullptr) return answer;
  if (const Status s = find_gradient(t, q); s != Status::ok) return s;
  const Pattern& pattern = constraints_->pattern();
  for (int k = 0; k < m(); ++k) {
    for (int p = pattern.start[size(k)]; p < pattern.start[size(k) + 1]; ++p) {
      r[size(pattern.row[size(p)])] -= gt_[size(p)] * lambda[size(k)];
    }
  }
  return constraint_row(t, q, v, a, c);
}

/// Expects gt_ at (t, q).
Status Dynamics::constraint_row(double t, In q, In v, In a, Out c) noexcept {
  if (position_level_) return constraints_->value(t, q, c);
  if (const Status s = constraints_->bias(t, q, v, c); s != Status::ok) return s;
  const Pattern& pattern = constraints_->pattern();
  for (int k = 0; k < m(); ++k) {
    for (int p = pattern.start[size(k)]; p < pattern.start[size(k) + 1]; ++p) {
      c[size(k)] += gt_[size(p)] * a[size(pattern.row[size(p)])];
    }
  }
  if (alpha_ == 0 && beta_ == 0) return Status::ok;
  if (const Status s = constraints_->value(t, q, g_); s != Status::ok) return s;
  if (const Status s = constraints_->rate(t, q, v, g_dot_); s != Status::ok) return s;
  for (std::size_t k = 0; k < c.size(); ++k) c[k] += alpha_ * g_[k] + beta_ * g_dot_[k];
  return Status::ok;
}

Status Dynamics::linearize(double t, In q, In v, In a, In lambda, Weights w) noexcept {
  ++stats.linearizations;
  ++matrices_;
  weights_ = w;
  const Status answer = noted(assemble(t, q, v, a, lambda, w), t, q, v);
  if (answer != Status::ok || constraints_ == nullptr) return answer;
  if (const Status s = find_gradient(t, q); s != Status::ok) return s;
  if (const Status s = constraint_tangent(t, q, v, a, w); s != Status::ok) return s;
  const Status s = bordered_ ? bordered_->factor(gt_, ht_) : kkt_->factor(s_, gt_, ht_);
  const KktReport& report = bordered_ ? bordered_->report() : kkt_->report();
  stats.solver = report.solver;
  stats.rank_deficiency = std::max(stats.rank_deficiency, report.rank_deficiency);
  stats.condition = std::max(stats.condition, report.condition);
  return s;
}

/// Sets gt_. Newton's method needs it for the matrix and for the residual of one state.
Status Dynamics::find_gradient(double t, In q) noexcept {
  if (bordered_ && t == gradient_t_ && std::ranges::equal(q, gradient_q_)) {
    return Status::ok;
  }
  gradient_t_ = std::numeric_limits<double>::quiet_NaN();
  if (const Status s = constraints_->gradient(t, q, gt_); s != Status::ok) return s;
  if (bordered_) {
    gradient_q_.assign(q.begin(), q.end());
    gradient_t_ = t;
  }
  return Status::ok;
}

/// Prepares S(w) with the second derivatives of the constraints: for the system's own
/// solve(), or as s_.
Status Dynamics::assemble(double t, In q, In v, In a, In lambda, Weights w) noexcept {
  if (constraints_ == nullptr) return system_.linearize(t, q, v, a, w);
  if (bordered_) return bordered_form_->linearize_bordered(t, q, v, a, lambda, w);
  const Status s = sparse_->values(t, q, v, a, w, s_);
  if (s != Status::ok || w.pos == 0) return s;
  return constraints_->add_curvature(t, q, lambda, -w.pos, s_);
}

/// Sets ht_ = (w.acc dc/da + w.vel dc/dv + w.pos dc/dq)^T, where dc/da = G. With R(v) =
/// d(G v + g_t)/dq, the others are dc/dv = 2 R(v) + beta G and dc/dq = R(a) + beta R(v) +
/// alpha G + d(bias)/dq. The last term (third derivatives of g) is omitted. Index 3: G,
/// scaled in solve().
Status Dynamics::constraint_tangent(double t, In q, In v, In a, Weights w) noexcept {
  std::copy(gt_.begin(), gt_.end(), ht_.begin());
  if (position_level_ || (w.vel == 0 && w.pos == 0)) return Status::ok;
  const double gain = w.acc + w.vel * beta_ + w.pos * alpha_;
  for (double& value : ht_) value *= gain;
  const auto add = [&](In direction, double factor) {
    const Status s = constraints_->rate_gradient(t, q, direction, rate_gt_);
    for (std::size_t p = 0; p < ht_.size(); ++p) ht_[p] += factor * rate_gt_[p];
    return s;
  };
  if (const Status s = add(v, 2 * w.vel + w.pos * beta_); s != Status::ok) return s;
  return add(a, w.pos);
}

Status Dynamics::solve(InOut r, InOut c) noexcept {
  ++stats.solves;
  if (constraints_ == nullptr) return system_.solve(r, r);
  if (position_level_ && weights_.pos != 0) {
    for (double& entry : c) entry /= weights_.pos;
  }
  return bordered_ ? bordered_->solve(r, c) : kkt_->solve(r, c);
}

Status Dynamics::directional(double t, In q, In v, In a, In lambda, In dq, In dv, Out dr,
                             Out dc, Base base) noexcept {
  const double length = std::max(scaled_norm(dq, q_typ_), scaled_norm(dv, v_typ_));
  std::fill(dr.begin(), dr.end(), 0.0);
  std::fill(dc.begin(), dc.end(), 0.0);
  if (base == Base::fresh) base_ready_ = false;
  if (length == 0) return Status::ok;
  const double size_of_state =
      1 + std::max(scaled_norm(q, q_typ_), scaled_norm(v, v_typ_));
  const double e =
      std::sqrt(std::numeric_limits<double>::epsilon()) * size_of_state / length;
  for (std::size_t i = 0; i < dq.size(); ++i) {
    q_shift_[i] = q[i] + e * dq[i];
    v_shift_[i] = v[i] + e * dv[i];
  }
  if (!base_ready_) {
    const Status s = residual(t, q, v, a, lambda, r_base_, c_base_);
    if (s != Status::ok) return s;
    base_ready_ = true;
  }
  const Status s = residual(t, q_shift_, v_shift_, a, lambda, dr, dc);
  for (std::size_t i = 0; i < dr.size(); ++i) dr[i] = (dr[i] - r_base_[i]) / e;
  for (std::size_t k = 0; k < dc.size(); ++k) dc[k] = (dc[k] - c_base_[k]) / e;
  return s;
}

Status Dynamics::accelerate(double t, In q, In v, Out a, Out lambda) noexcept {
  if (explicit_ != nullptr) {
    ++stats.residuals;
    ++matrices_;  // the model may have factored its mass
    return noted(explicit_->acceleration(t, q, v, a), t, q, v);
  }
  const bool position_level = position_level_;
  position_level_ = false;
  Status s =
      linearize(t, q, v, zero_n_, zero_m_, {1, start_step_, start_step_ * start_step_});
  if (s == Status::ok) s = residual(t, q, v, zero_n_, zero_m_, a, lambda);
  position_level_ = position_level;
  if (s != Status::ok) return s;
  for (double& entry : a) entry = -entry;
  for (double& entry : lambda) entry = -entry;
  return solve(a, lambda);
}

/// A state that is itself not finite results from earlier failures: it explains nothing
/// if there is a finite one.
void Dynamics::keep_lost(double t, In q, In v) noexcept {
  if (lost_ == Lost::at_finite_state) return;
  const bool finite = all_finite(q) && all_finite(v);
  if (lost_ == Lost::at_infinity && !finite) return;
  lost_ = finite ? Lost::at_finite_state : Lost::at_infinity;
  lost_t_ = t;
  std::ranges::copy(q, lost_q_.begin());
  std::ranges::copy(v, lost_v_.begin());
}

std::string Dynamics::culprit(double t, In q, In v) {
  const auto there = [this] { return system_.not_finite(lost_t_, lost_q_, lost_v_); };
  std::string words;
  if (lost_ == Lost::at_finite_state) words = there();
  if (words.empty()) words = system_.not_finite(t, q, v);
  if (words.empty() && lost_ == Lost::at_infinity) words = there();
  return words;
}

}  // namespace tress::integrators
