// The border of the matrix of a strand with turning bodies.
#include <algorithm>
#include <cmath>

#include "models/turning/turning_system.h"

namespace tress::models {
namespace {

/// Step of differences along a motion, over the typical coordinates: the cube root of the
/// rounding.
constexpr double motion_step = 6e-6;

double largest_load(In x) {
  double most = 0;
  for (const double one : x) most = std::max(most, std::abs(one));
  return most;
}

}  // namespace

/// Residuals are affine in the loads. Small loads next to large elastic forces would lose
/// their digits in a difference: this factor lifts them above all forces.
double TurningSystem::lift(In loads) const {
  const double size = largest_load(loads);
  return size > 0 ? 1e3 * std::max(1.0, largest_load(base_) / size) : 1;
}

/// to = J^T loads, which replace those of body k. base_ has the residual without any.
Status TurningSystem::pull(double t, In q, std::size_t k, In loads, Out to) noexcept {
  const double factor = lift(loads);
  bodies_[k]->replace(loads, factor);
  const Status s = strand_->residual(t, q, zero_, zero_, to);
  bodies_[k]->replace({}, 0);
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = (base_[i] - to[i]) / factor;
  return s;
}

/// Adds (d(J v)/dq)^T h to the row of body k, with h = slopes_.rate. It is the change of
/// J^T h along the motion, since J is dx/dq.
Status TurningSystem::add_turning_points(double t, In q, In v, std::size_t k) noexcept {
  double fastest = 0;
  for (std::size_t i = 0; i < strand_size_; ++i) {
    fastest = std::max(fastest, std::abs(v[i]) / q_typ_[i]);
  }
  if (fastest == 0) return Status::ok;
  const double step = motion_step / fastest, factor = lift(slopes_.rate);
  const InOut to = column(row_, k);
  for (const double side : {-1.0, 1.0}) {
    for (std::size_t i = 0; i < strand_size_; ++i) {
      shifted_[i] = q[i] + side * step * v[i];
    }
    for (const double sign : {-1.0, 1.0}) {
      bodies_[k]->replace(slopes_.rate, sign * factor);
      const Status s = strand_->residual(t, shifted_, zero_, zero_, r_);
      if (s != Status::ok) return s;
      for (std::size_t i = 0; i < strand_size_; ++i) {
        to[i] -= side * sign * r_[i] / (4 * step * factor);
      }
    }
  }
  bodies_[k]->replace({}, 0);
  return Status::ok;
}

/// Computes the border at this state.
Status TurningSystem::border(double t, In q, In v, Weights w) noexcept {
  const In q_s = of_strand(q), v_s = of_strand(v);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Bearing& bearing = bodies_[k]->bearing();
    own_[static_cast<Eigen::Index>(k)] =
        w.acc * bearing.inertia + w.vel * bearing.damping;
  }
  bordered_ = false;
  if (w.vel == 0 && w.pos == 0) return Status::ok;
  Status s = recorded([&] { return strand_->residual(t, q_s, v_s, zero_, r_); });
  bordered_ = std::ranges::any_of(bodies_, &TurningBody::touched);
  if (s != Status::ok || !bordered_) return s;
  column_.setZero();
  row_.setZero();
  for (const TurningBody* body : bodies_) body->replace({}, 0);
  s = strand_->residual(t, q_s, zero_, zero_, base_);
  for (std::size_t k = 0; k < bodies_.size() && s == Status::ok; ++k) {
    if (!bodies_[k]->touched()) continue;
    bodies_[k]->slopes(t, w, slopes_);
    own_[static_cast<Eigen::Index>(k)] += slopes_.own;
    s = pull(t, q_s, k, slopes_.by_turn, column(column_, k));
    column_.col(static_cast<Eigen::Index>(k)) *= -1;
    if (s == Status::ok) s = pull(t, q_s, k, slopes_.moment, column(row_, k));
    if (s == Status::ok && w.pos != 0 && !linear_points_) {
      s = add_turning_points(t, q_s, v_s, k);
    }
  }
  for (const TurningBody* body : bodies_) body->act();
  return s;
}

}  // namespace tress::models
