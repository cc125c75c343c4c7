#include "integrators/control/impulse_response.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tress::integrators {
ImpulseResponse::ImpulseResponse(System& strand, const Integrator& method,
                                 const Options& options, std::size_t first)
    : system_(strand),
      method_(method),
      first_(first),
      dynamics_(strand, options),
      linear_(true),
      a_(static_cast<std::size_t>(dynamics_.n())),
      lambda_(static_cast<std::size_t>(dynamics_.m())),
      r_(a_.size()),
      c_(lambda_.size()),
      q_(a_.size()),
      v_(a_.size()) {
  MaterialPoints& points = *strand.material_points();
  for (int i = 0; i < points.count(); ++i) {
    means_.push_back(points.mean(i));
    if (!means_.back()) linear_ = false;
  }
  u_.resize(3 * means_.size());
  u_rest_.resize(u_.size());
}

Status ImpulseResponse::prepare(double h, In v_before) noexcept {
  h_ = h;
  std::ranges::copy(q_alone(), q_.begin());
  std::ranges::copy(v_alone(), v_.begin());
  for (std::size_t i = 0; i < a_.size(); ++i) a_[i] = (v_[i] - v_before[i]) / h;
  differentiated_ = false;
  return dynamics_.linearize(method_.time(), q_, v_, a_, lambda_, {1, h, h * h});
}

/// u = J v + what the root prescribes.
void ImpulseResponse::differentiate() noexcept {
  if (linear_ || std::exchange(differentiated_, true)) return;
  MaterialPoints& points = *system_.material_points();
  const std::size_t n = a_.size();
  jacobian_.resize(u_.size() * n);
  if (points.jacobian(method_.time(), q_, jacobian_)) return;
  std::ranges::fill(r_, 0.0);
  points.velocities(method_.time(), q_, r_, u_rest_);
  for (std::size_t k = 0; k < n; ++k) {
    r_[k] = 1;
    points.velocities(method_.time(), q_, r_, u_);
    r_[k] = 0;
    for (std::size_t i = 0; i < u_.size(); ++i) jacobian_[i * n + k] = u_[i] - u_rest_[i];
  }
}

/// r += J^T force
void ImpulseResponse::pull_back(int point, const double* force, InOut r) const noexcept {
  const auto i = static_cast<std::size_t>(point);
  if (!linear_) {
    const double* row = &jacobian_[3 * i * r.size()];
    for (std::size_t d = 0; d < 3; ++d, row += r.size()) {
      if (force[d] == 0) continue;
      for (std::size_t k = 0; k < r.size(); ++k) r[k] += row[k] * force[d];
    }
    return;
  }
  const MaterialPoints::Mean& mean = *means_[i];
  for (std::size_t k = 0; k < static_cast<std::size_t>(mean.count); ++k) {
    double* to = &r[static_cast<std::size_t>(mean.coordinate[k])];
    for (std::size_t d = 0; d < 3; ++d) to[d] += mean.weight[k] * force[d];
  }
}

/// u = J v
void ImpulseResponse::velocity(int point, In v, double* u) const noexcept {
  const auto i = static_cast<std::size_t>(point);
  std::fill(u, u + 3, 0.0);
  if (!linear_) {
    const double* row = &jacobian_[3 * i * v.size()];
    for (std::size_t d = 0; d < 3; ++d, row += v.size()) {
      for (std::size_t k = 0; k < v.size(); ++k) u[d] += row[k] * v[k];
    }
    return;
  }
  const MaterialPoints::Mean& mean = *means_[i];
  for (std::size_t k = 0; k < static_cast<std::size_t>(mean.count); ++k) {
    const double* from = &v[static_cast<std::size_t>(mean.coordinate[k])];
    for (std::size_t d = 0; d < 3; ++d) u[d] += mean.weight[k] * from[d];
  }
}

Status ImpulseResponse::compliance(std::span<const int> points,
                                   std::vector<double>& blocks) {
  blocks.resize(9 * points.size() * points.size());
  if (dynamics_.m() == 0 &&
      system_.material_points()->responses(method_.time(), q_alone(), points, blocks)) {
    for (double& entry : blocks) entry *= h_;
    return Status::ok;
  }
  differentiate();
  for (std::size_t of = 0; of < points.size(); ++of) {
    for (std::size_t d = 0; d < 3; ++d) {
      std::ranges::fill(r_, 0.0);
      std::ranges::fill(c_, 0.0);
      const std::array<double, 3> force{d == 0 ? 1.0 : 0, d == 1 ? 1.0 : 0,
                                        d == 2 ? 1.0 : 0};
      pull_back(points[of], force.data(), r_);
      const Status s = dynamics_.solve(r_, c_);
      if (s != Status::ok) return s;
      for (std::size_t on = 0; on < points.size(); ++on) {
        std::array<double, 3> u;
        velocity(points[on], r_, u.data());
        double* block = &blocks[9 * (of * points.size() + on)];
        for (std::size_t k = 0; k < 3; ++k) block[3 * k + d] = h_ * u[k];
      }
    }
  }
  return Status::ok;
}

Status ImpulseResponse::respond(std::span<const int> points, In forces) noexcept {
  std::ranges::fill(r_, 0.0);
  std::ranges::fill(c_, 0.0);
  if (!system_.material_points()->pull_back(method_.time(), q_alone(), points, forces,
                                            r_)) {
    differentiate();
    for (std::size_t i = 0; i < points.size(); ++i) {
      pull_back(points[i], &forces[3 * i], r_);
    }
  }
  const Status s = dynamics_.solve(r_, c_);
  if (s != Status::ok) return s;
  const In q = q_alone(), v = v_alone();
  for (std::size_t k = 0; k < r_.size(); ++k) {
    v_[k] = v[k] + h_ * r_[k];
    q_[k] = q[k] + h_ * h_ * r_[k];
  }
  return Status::ok;
}

}  // namespace tress::integrators
