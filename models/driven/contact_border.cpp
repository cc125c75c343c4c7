// The derivatives of the contact forces between strands and the bodies that they drive.
#include <algorithm>
#include <cmath>

#include "linear/largest_size.h"
#include "models/driven/driven_system.h"

namespace tress::models {
namespace {

/// Step of differences along a motion, over the typical coordinates: the cube root of the
/// rounding.
constexpr double motion_step = 6e-6;

}  // namespace

/// Residuals are affine in the loads. Small loads next to large elastic forces would lose
/// their digits in a difference: this factor lifts them above all forces.
double DrivenSystem::lift(In loads) const {
  const double size = largest_size(loads);
  return size > 0 ? 1e3 * std::max(1.0, largest_size(base_) / size) : 1;
}

/// to += J^T loads, which replace those of body k. base_ has the residual without any.
Status DrivenSystem::pull(double t, In q, std::size_t k, In loads, InOut to) noexcept {
  const double factor = lift(loads);
  bodies_[k].effect->replace(loads, factor);
  const Status s = strand_->residual(t, q, zero_, zero_, pulled_);
  bodies_[k].effect->replace({}, 0);
  for (std::size_t i = 0; i < strand_size_; ++i) {
    to[i] += (base_[i] - pulled_[i]) / factor;
  }
  return s;
}

/// to += (d(J v)/dq)^T rate. It is the change of J^T rate along the motion, since J is
/// dx/dq.
Status DrivenSystem::add_turning_points(double t, In q, In v, std::size_t k, In rate,
                                        InOut to) noexcept {
  double fastest = 0;
  for (std::size_t i = 0; i < strand_size_; ++i) {
    fastest = std::max(fastest, std::abs(v[i]) / q_typ_[i]);
  }
  if (fastest == 0) return Status::ok;
  const double step = motion_step / fastest, factor = lift(rate);
  for (const double side : {-1.0, 1.0}) {
    for (std::size_t i = 0; i < strand_size_; ++i) {
      shifted_[i] = q[i] + side * step * v[i];
    }
    for (const double sign : {-1.0, 1.0}) {
      bodies_[k].effect->replace(rate, sign * factor);
      const Status s = strand_->residual(t, shifted_, zero_, zero_, r_);
      if (s != Status::ok) return s;
      for (std::size_t i = 0; i < strand_size_; ++i) {
        to[i] -= side * sign * r_[i] / (4 * step * factor);
      }
    }
  }
  bodies_[k].effect->replace({}, 0);
  return Status::ok;
}

/// Writes the columns of body k, which is touched.
Status DrivenSystem::border_of(std::size_t k, double t, In q, In v, Weights w) noexcept {
  const Driven& body = bodies_[k];
  screws_.resize(body.size);
  body.system->screws(of_body(q, k), of_body(v, k), screws_);
  body.effect->slopes(t, w, screws_, slopes_);
  body.system->hang(body.effect->recorded(), slopes_.own);
  const auto half = static_cast<std::size_t>(u_.cols()) / 2;
  const In q_s = of_strand(q), v_s = of_strand(v);
  for (std::size_t j = 0; j < body.size; ++j) {
    const auto& [by_motion, load, rate] = slopes_.of[j];
    const InOut force = column(u_, body.column + j),
                row = column(v_, half + body.column + j);
    Status s = pull(t, q_s, k, by_motion, force);
    for (double& one : force) one = -one;
    if (s == Status::ok) s = pull(t, q_s, k, load, row);
    if (s == Status::ok && w.pos != 0 && !linear_points_) {
      s = add_turning_points(t, q_s, v_s, k, rate, row);
    }
    if (s != Status::ok) return s;
    column(v_, body.column + j)[body.first + j] = 1;
    column(u_, half + body.column + j)[body.first + j] = 1;
  }
  return Status::ok;
}

/// Computes the derivatives of the contact forces at this state.
Status DrivenSystem::border(double t, In q, In v, Weights w) noexcept {
  coupled_ = false;
  for (const Driven& body : bodies_) body.system->hang({}, {});
  if (w.vel == 0 && w.pos == 0) return Status::ok;
  const In q_s = of_strand(q), v_s = of_strand(v);
  Status s = recorded([&] { return strand_->residual(t, q_s, v_s, zero_, r_); });
  coupled_ = std::ranges::any_of(
      bodies_, [](const Driven& body) { return body.effect->touched(); });
  if (s != Status::ok || !coupled_) return s;
  u_.setZero();
  v_.setZero();
  for (const Driven& body : bodies_) body.effect->replace({}, 0);
  s = strand_->residual(t, q_s, zero_, zero_, base_);
  for (std::size_t k = 0; k < bodies_.size() && s == Status::ok; ++k) {
    if (bodies_[k].effect->touched()) s = border_of(k, t, q, v, w);
  }
  for (const Driven& body : bodies_) body.effect->act();
  return s;
}

/// Prepares the solution with the derivatives of the contact forces.
Status DrivenSystem::couple() noexcept {
  responses_ = u_;
  const auto half = static_cast<std::size_t>(u_.cols()) / 2;
  for (const Driven& body : bodies_) {
    if (!body.effect->touched()) continue;
    for (std::size_t j = body.column; j < body.column + body.size; ++j) {
      for (const std::size_t k : {j, half + j}) {
        if (const Status s = solve_parts(column(responses_, k)); s != Status::ok)
          return s;
      }
    }
  }
  inner_.noalias() = v_.transpose() * responses_;
  inner_.diagonal().array() += 1;
  return inner_.allFinite() && lu_.factor(inner_) > 0 ? Status::ok : Status::retry;
}

}  // namespace tress::models
