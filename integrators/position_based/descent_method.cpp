#include "integrators/position_based/descent_method.h"

#include <algorithm>

namespace tress::integrators {

DescentMethod::DescentMethod(System& system, const Options& options,
                             const DescentChoice& choice, Start start)
    : FixedStep(system, options),
      descent_(system, choice),
      form_(*system.compliance_form()),
      start_(start),
      x_(vector_n()),
      target_(vector_n()),
      rest_(vector_n()),
      v_last_(vector_n()) {}

/// Where the equations change on the way, multipliers are still those of the strains.
Status DescentMethod::reset(double t) {
  h_last_ = 0;
  if (!begun_ || t != ended_) descent_.begin(t, q_);
  begun_ = true;
  return Status::ok;
}

double DescentMethod::part(const std::vector<int>& node) const {
  double along = 0, square = 0;
  for (const int k : node) {
    const auto i = static_cast<std::size_t>(k);
    along += rest_[i] * (v_[i] - v_last_[i]);
    square += rest_[i] * rest_[i];
  }
  return square > 0 ? std::clamp(along / (h_last_ * square), 0.0, 1.0) : 0;
}

/// Orientations without inertia start where they are.
void DescentMethod::guess(double h) {
  if (start_ == Start::inertial) {
    x_ = target_;
    return;
  }
  x_ = q_;
  for (const std::vector<int>& node : descent_.nodes()) {
    const double s = h_last_ > 0 ? part(node) : 0;
    for (const int k : node) {
      const auto i = static_cast<std::size_t>(k);
      x_[i] += h * (v_[i] + h * s * rest_[i]);
    }
  }
}

Status DescentMethod::step(double t, double h) {
  if (const Status s = form_.rest(t, q_, v_, rest_); s != Status::ok) return s;
  ++dynamics_.stats.residuals;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    target_[i] = q_[i] + h * (v_[i] + h * rest_[i]);
  }
  guess(h);
  v_last_ = v_;
  h_last_ = h;
  descent_.run(t + h, h, q_, target_, x_, dynamics_.stats);
  for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - q_[i]) / h;
  q_.swap(x_);
  ended_ = t + h;
  return Status::ok;
}

}  // namespace tress::integrators
