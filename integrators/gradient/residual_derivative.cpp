#include "integrators/gradient/residual_derivative.h"

#include <algorithm>

#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Of the direction's length over System::scale. A central difference at this distance
/// has an error of some 1e-10 in reduced coordinates, from both its order and rounding.
constexpr double distance = 1e-5;
/// Velocities this much larger than positions, over System::scale, have their own.
constexpr double most_faster = 30;

/// y += A x
void add_product(const Pattern& pattern, In values, In x, InOut y) {
  for (std::size_t j = 0; j < x.size(); ++j) {
    if (x[j] == 0) continue;
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) {
      y[size(pattern.row[size(p)])] += values[size(p)] * x[j];
    }
  }
}

}  // namespace

ResidualDerivative::ResidualDerivative(Dynamics& dynamics, bool sparse)
    : dynamics_(dynamics),
      sparse_(sparse ? dynamics.system().sparse_form() : nullptr),
      none_(size(dynamics.n())),
      q_shift_(none_),
      v_shift_(none_),
      a_shift_(q_shift_),
      a_typ_(q_shift_),
      r_(q_shift_),
      c_(size(dynamics.m())),
      before_r_(r_),
      before_c_(c_) {
  for (std::size_t i = 0; i < a_typ_.size(); ++i) {
    a_typ_[i] = dynamics.v_typ()[i] * dynamics.v_typ()[i] / dynamics.q_typ()[i];
  }
  if (sparse_ == nullptr) return;
  for (auto& values : by_) values.resize(size(sparse_->pattern().nonzeros()));
}

Status ResidualDerivative::move(double t, In q, In v, In a, In lambda) noexcept {
  t_ = t;
  q_ = q;
  v_ = v;
  a_ = a;
  lambda_ = lambda;
  if (sparse_ == nullptr) return Status::ok;
  constexpr Weights weights[] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  for (std::size_t k = 0; k < by_.size(); ++k) {
    const Status s = sparse_->values(t, q, v, a, weights[k], by_[k]);
    if (s != Status::ok) return s;
  }
  if (dynamics_.m() == 0) return Status::ok;
  return dynamics_.constraints()->add_curvature(t, q, lambda, -1, by_[0]);
}

Status ResidualDerivative::along(In dq, In dv, In da, Out dr, Out dc) noexcept {
  if (sparse_ == nullptr) return differences(dq, dv, da, dr, dc);
  if (dynamics_.m() > 0) {
    const Status s = differences(dq, dv, da, dr, dc);
    if (s != Status::ok) return s;
  }
  std::ranges::fill(dr, 0.0);
  const Pattern& pattern = sparse_->pattern();
  add_product(pattern, by_[0], dq, dr);
  add_product(pattern, by_[1], dv, dr);
  add_product(pattern, by_[2], da, dr);
  return Status::ok;
}

/// The residual is affine in accelerations, which may therefore be as large as they are.
Status ResidualDerivative::differences(In dq, In dv, In da, Out dr, Out dc) noexcept {
  std::ranges::fill(dr, 0.0);
  std::ranges::fill(dc, 0.0);
  const double slow = scaled_norm(dq, dynamics_.q_typ());
  const double fast = scaled_norm(dv, dynamics_.v_typ());
  if (slow == 0 || fast <= most_faster * slow) {
    return add_difference(std::max(slow, fast), dq, dv, da, dr, dc);
  }
  const Status s = add_difference(slow, dq, none_, none_, dr, dc);
  return s == Status::ok ? add_difference(fast, none_, dv, da, dr, dc) : s;
}

Status ResidualDerivative::add_difference(double length, In dq, In dv, In da, InOut dr,
                                          InOut dc) noexcept {
  if (length == 0) length = scaled_norm(da, a_typ_);
  if (length == 0) return Status::ok;
  const double e = distance / length;
  const auto at = [&](double s, Out r, Out c) {
    shifted(q_shift_, q_, s, dq);
    shifted(v_shift_, v_, s, dv);
    shifted(a_shift_, a_, s, da);
    return dynamics_.residual(t_, q_shift_, v_shift_, a_shift_, lambda_, r, c);
  };
  if (const Status s = at(-e, before_r_, before_c_); s != Status::ok) return s;
  if (const Status s = at(e, r_, c_); s != Status::ok) return s;
  for (std::size_t i = 0; i < r_.size(); ++i) dr[i] += (r_[i] - before_r_[i]) / (2 * e);
  for (std::size_t k = 0; k < c_.size(); ++k) dc[k] += (c_[k] - before_c_[k]) / (2 * e);
  return Status::ok;
}

}  // namespace tress::integrators
