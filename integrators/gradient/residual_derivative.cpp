#include "integrators/gradient/residual_derivative.h"

#include <algorithm>

#include "integrators/gradient/varied_system.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Of a direction's length over System::scale. At fixed q the residual is quadratic in
/// velocities but for laws of friction and drag. What does not depend on them cancels in
/// a difference but for its last digit. A surface whose friction turns at 1e-3 of the
/// typical velocity bends it by 1e-4 within this distance, and needs order 4.
constexpr double distance = 1e-5;
/// Likewise of dq in reduced coordinates: of order 4, its error is 1e-18 f'''''' and
/// 5e-12 f from rounding, which the smallest inertia enlarges in accelerations.
constexpr double distance_along = 3e-5;
/// The same next to forces of surfaces, into which hair at rest sinks by 6e-5 of its
/// length.
constexpr double short_distance_along = 1e-6;
/// Copies are worthwhile where their state serves more than one direction.
constexpr std::size_t fewest_for_copies = 2;

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

ResidualDerivative::ResidualDerivative(Dynamics& dynamics, KnownForces forces,
                                       System* copies)
    : dynamics_(dynamics),
      sparse_(forces.sparse ? dynamics.system().sparse_form() : nullptr),
      copies_(sparse_ == nullptr ? copies : nullptr),
      by_rates_(forces.quadratic ? placing_differences(1) : central_differences(1)),
      distance_along_(forces.quadratic ? distance_along : short_distance_along),
      none_(size(dynamics.n())),
      q_shift_(none_),
      v_shift_(none_),
      a_shift_(none_),
      a_typ_(none_),
      r_(none_),
      c_(size(dynamics.m())) {
  for (std::size_t i = 0; i < a_typ_.size(); ++i) {
    a_typ_[i] = dynamics.v_typ()[i] * dynamics.v_typ()[i] / dynamics.q_typ()[i];
  }
  if (sparse_ != nullptr) {
    by_v_.resize(size(sparse_->pattern().nonzeros()));
    by_q_ = by_a_ = by_v_;
  }
  if (copies_ == nullptr) return;
  q_copies_.resize(size(copies_->layout().coordinates));
  v_copies_ = a_copies_ = r_copies_ = q_copies_;
  count_ = q_copies_.size() / none_.size();
  e_.resize(count_ / by_rates_.at.size());
}

Status ResidualDerivative::move(double t, In q, In v, In a, In lambda) noexcept {
  t_ = t;
  q_ = q;
  v_ = v;
  a_ = a;
  lambda_ = lambda;
  known_by_q_ = false;
  for (std::size_t k = 0; k < count_; ++k) {
    std::ranges::copy(q, Out(q_copies_).subspan(k * q.size()).begin());
  }
  if (sparse_ == nullptr) return Status::ok;
  if (!constant_by_a_) {
    const Status s = sparse_->values(t, q, v, a, {1, 0, 0}, by_a_);
    if (s != Status::ok) return s;
    constant_by_a_ = dynamics_.system().traits().constant_mass;
  }
  return sparse_->values(t, q, v, a, {0, 1, 0}, by_v_);
}

Status ResidualDerivative::at_fixed_q(In dv, In da, Out dr) noexcept {
  const std::size_t n = q_.size();
  if (!e_.empty() && dv.size() >= fewest_for_copies * n) {
    return differences_of_copies(dv, da, dr);
  }
  if (sparse_ != nullptr) std::ranges::fill(dr, 0.0);
  for (std::size_t at = 0; at < dv.size(); at += n) {
    const In by_v = dv.subspan(at, n), by_a = da.subspan(at, n);
    const Out to = dr.subspan(at, n);
    if (sparse_ != nullptr) {
      add_product(sparse_->pattern(), by_v_, by_v, to);
      add_product(sparse_->pattern(), by_a_, by_a, to);
      continue;
    }
    const Status s = difference(by_v, by_a, to, c_);
    if (s != Status::ok) return s;
  }
  return Status::ok;
}

/// The residual is affine in accelerations, which may therefore be as large as they are.
double ResidualDerivative::length(In dv, In da) const noexcept {
  const double fast = scaled_norm(dv, dynamics_.v_typ());
  return fast > 0 ? fast : scaled_norm(da, a_typ_);
}

Status ResidualDerivative::difference(In dv, In da, Out dr, Out dc) noexcept {
  std::ranges::fill(dr, 0.0);
  std::ranges::fill(dc, 0.0);
  const double of_direction = length(dv, da);
  if (of_direction == 0) return Status::ok;
  const double e = distance / of_direction;
  for (std::size_t i = 0; i < by_rates_.at.size(); ++i) {
    shifted(v_shift_, v_, e * by_rates_.at[i], dv);
    shifted(a_shift_, a_, e * by_rates_.at[i], da);
    const Status s = dynamics_.residual(t_, q_, v_shift_, a_shift_, lambda_, r_, c_);
    if (s != Status::ok) return s;
    add(dr, by_rates_.weight[i] / e, r_);
    add(dc, by_rates_.weight[i] / e, c_);
  }
  return Status::ok;
}

/// A copy for each term of the stencil and each direction.
Status ResidualDerivative::differences_of_copies(In dv, In da, Out dr) noexcept {
  const std::size_t n = q_.size();
  const auto part = [n](auto all, std::size_t k) { return all.subspan(k * n, n); };
  const std::size_t directions = dv.size() / n, terms = by_rates_.at.size();
  for (std::size_t from = 0; from < directions; from += e_.size()) {
    const std::size_t some = std::min(e_.size(), directions - from);
    for (std::size_t k = 0; k < e_.size(); ++k) {
      const std::size_t of = from + std::min(k, some - 1);
      const In by_v = part(dv, of), by_a = part(da, of);
      const double of_direction = length(by_v, by_a);
      e_[k] = of_direction > 0 ? distance / of_direction : 1;
      for (std::size_t i = 0; i < terms; ++i) {
        const double e = e_[k] * by_rates_.at[i];
        shifted(part(Out(v_copies_), terms * k + i), v_, e, by_v);
        shifted(part(Out(a_copies_), terms * k + i), a_, e, by_a);
      }
    }
    const Status s = copies_->residual(t_, q_copies_, v_copies_, a_copies_, r_copies_);
    if (s != Status::ok) return s;
    for (std::size_t k = 0; k < some; ++k) {
      const Out to = part(dr, from + k);
      std::ranges::fill(to, 0.0);
      for (std::size_t i = 0; i < terms; ++i) {
        add(to, by_rates_.weight[i] / e_[k], part(In(r_copies_), terms * k + i));
      }
    }
  }
  return Status::ok;
}

Status ResidualDerivative::along(In dq, In dv, In da, Out dr, Out dc) noexcept {
  if (sparse_ == nullptr || dynamics_.m() > 0) {
    const Status s = differences(dq, dv, da, dr, dc);
    if (s != Status::ok) return s;
  }
  if (sparse_ == nullptr) return Status::ok;
  const Status s = known_by_q_ ? Status::ok : find_by_q();
  std::ranges::fill(dr, 0.0);
  add_product(sparse_->pattern(), by_a_, da, dr);
  add_product(sparse_->pattern(), by_v_, dv, dr);
  add_product(sparse_->pattern(), by_q_, dq, dr);
  return s;
}

/// At the state of move(), once for all directions.
Status ResidualDerivative::find_by_q() noexcept {
  Status s = sparse_->values(t_, q_, v_, a_, {0, 0, 1}, by_q_);
  if (s == Status::ok && dynamics_.m() > 0) {
    s = dynamics_.constraints()->add_curvature(t_, q_, lambda_, -1, by_q_);
  }
  known_by_q_ = s == Status::ok;
  return s;
}

Status ResidualDerivative::differences(In dq, In dv, In da, Out dr, Out dc) noexcept {
  if (const Status s = difference(dv, da, dr, dc); s != Status::ok) return s;
  const double of_direction = scaled_norm(dq, dynamics_.q_typ());
  if (of_direction == 0) return Status::ok;
  const double longer = distance_along_ / central_distance / of_direction;
  for (std::size_t i = 0; i < central_stencil.at.size(); ++i) {
    shifted(q_shift_, q_, longer * central_stencil.at[i], dq);
    const Status s = dynamics_.residual(t_, q_shift_, v_, a_, lambda_, r_, c_);
    if (s != Status::ok) return s;
    add(dr, central_stencil.weight[i] / longer, r_);
    add(dc, central_stencil.weight[i] / longer, c_);
  }
  return Status::ok;
}

}  // namespace tress::integrators
