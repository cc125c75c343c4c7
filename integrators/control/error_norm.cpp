#include "integrators/control/error_norm.h"

#include <algorithm>
#include <limits>

#include "integrators/control/step_factors.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
using step_factors::coordinate_weight;

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
  if (points_ != nullptr) {
    points_->positions(t, q, x_);
    norm_.start(*points_, x_);
  }
  if (norm_.length() > 0) {
    time_ = norm_.typical_time();
    return;
  }
  time_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < q_.size(); ++i) {
    time_ = std::min(time_, dynamics_.q_typ()[i] / dynamics_.v_typ()[i]);
  }
}

double ErrorNorm::of(double t, In q, In v, In dq, In dv) {
  const double of_q = scaled_norm(dq, dynamics_.q_typ());
  if (norm_.length() == 0) {
    const double of_v = scaled_norm(dv, dynamics_.v_typ());
    from_ = of_v > of_q ? From::velocities : From::coordinates;
    return std::max(of_q, of_v);
  }
  shifted(q_, q, -1, dq);
  shifted(v_, v, -1, dv);
  // In this order, for models keep what they have computed at the last q.
  points_->positions(t, q, x_);
  points_->velocities(t, q, v, u_);
  points_->positions(t, q_, shifted_x_);
  points_->velocities(t, q_, v_, shifted_u_);
  const double of_points = norm_.of(x_, u_, shifted_x_, shifted_u_);
  const bool by_points = !(coordinate_weight * of_q > of_points);
  from_ = by_points ? From::points : From::coordinates;
  return by_points ? of_points : coordinate_weight * of_q;
}

std::string ErrorNorm::where() const {
  switch (from_) {
    case From::points:
      return norm_.where();
    case From::velocities:
      return "velocity";
    case From::coordinates:
      break;
  }
  return norm_.length() > 0 ? "coordinates" : "position";
}

}  // namespace tress::integrators
