#include "integrators/error_norm.h"

#include <algorithm>
#include <limits>

#include "integrators/vector_ops.h"

namespace tress::integrators {
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
  if (norm_.length() == 0) {
    const double of_q = scaled_norm(dq, dynamics_.q_typ());
    const double of_v = scaled_norm(dv, dynamics_.v_typ());
    velocity_ = of_v > of_q;
    return std::max(of_q, of_v);
  }
  shifted(q_, q, -1, dq);
  shifted(v_, v, -1, dv);
  points_->positions(t, q, x_);
  points_->positions(t, q_, shifted_x_);
  points_->velocities(t, q, v, u_);
  points_->velocities(t, q_, v_, shifted_u_);
  return norm_.of(x_, u_, shifted_x_, shifted_u_);
}

std::string ErrorNorm::where() const {
  return norm_.length() > 0 ? norm_.where() : velocity_ ? "velocity" : "position";
}

}  // namespace tress::integrators
