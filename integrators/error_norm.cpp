#include "integrators/error_norm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/vector_ops.h"

namespace tress::integrators {
namespace {

constexpr double gravity = 9.81;  // m/s^2
// Of coordinates, whose error may be larger than that of points.
constexpr double coordinate_weight = 1. / 15;

constexpr std::string_view position = "position", velocity = "velocity",
                           coordinates = "coordinates";

double distance(In x, std::size_t i, In y, std::size_t j) {
  return std::hypot(x[3 * i] - y[3 * j], x[3 * i + 1] - y[3 * j + 1],
                    x[3 * i + 2] - y[3 * j + 2]);
}

}  // namespace

ErrorNorm::ErrorNorm(Dynamics& dynamics)
    : dynamics_(dynamics),
      points_(dynamics.system().material_points()),
      q_(static_cast<std::size_t>(dynamics.n())),
      v_(q_) {
  const auto count =
      points_ == nullptr ? 0 : 3 * static_cast<std::size_t>(points_->count());
  for (auto* values : {&x_, &shifted_x_, &u_, &shifted_u_}) values->resize(count);
}

void ErrorNorm::start(double t, In q) {
  length_ = 0;
  if (points_ != nullptr) {
    points_->positions(t, q, x_);
    std::vector<double> way(x_.size() / 3);
    for (std::size_t i = 0; i < way.size(); ++i) {
      const int before = points_->before(static_cast<int>(i));
      if (before < 0) continue;
      const auto j = static_cast<std::size_t>(before);
      way[i] = way[j] + distance(x_, i, x_, j);
      length_ = std::max(length_, way[i]);
    }
  }
  if (length_ > 0) {
    time_ = std::sqrt(length_ / gravity);
    return;
  }
  time_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < q_.size(); ++i) {
    time_ = std::min(time_, dynamics_.q_typ()[i] / dynamics_.v_typ()[i]);
  }
}

/// A number that is not finite makes the value infinite.
void ErrorNorm::look(const std::vector<double>& x, const std::vector<double>& shifted,
                     double factor, std::string_view what) {
  for (std::size_t i = 0; i < x.size() / 3; ++i) {
    const double error = factor * distance(x, i, shifted, i);
    if (error <= value_) continue;
    value_ = std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    point_ = i;
    what_ = what;
  }
}

double ErrorNorm::of(double t, In q, In v, In dq, In dv) {
  value_ = 0;
  if (length_ == 0) {
    value_ = scaled_norm(dq, dynamics_.q_typ());
    const double of_v = scaled_norm(dv, dynamics_.v_typ());
    what_ = of_v > value_ ? velocity : position;
    return value_ = std::max(value_, of_v);
  }
  shifted(q_, q, -1, dq);
  shifted(v_, v, -1, dv);
  // In this order, for models keep what they have computed at the last q.
  points_->positions(t, q, x_);
  points_->velocities(t, q, v, u_);
  points_->positions(t, q_, shifted_x_);
  points_->velocities(t, q_, v_, shifted_u_);
  look(x_, shifted_x_, 1 / length_, position);
  look(u_, shifted_u_, time_ / length_, velocity);
  const double of_q = coordinate_weight * scaled_norm(dq, dynamics_.q_typ());
  if (of_q > value_) {
    value_ = of_q;
    what_ = coordinates;
  }
  return value_;
}

std::string ErrorNorm::where() const {
  std::string where(what_);
  if (length_ > 0 && what_ != coordinates) where += " of point " + std::to_string(point_);
  return where;
}

}  // namespace tress::integrators
