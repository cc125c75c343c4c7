#include "models/supports/dense_tangent.h"

#include <algorithm>
#include <cmath>

namespace tress::models {

Pattern full_pattern(int n) {
  Pattern full;
  full.rows = full.cols = n;
  full.start.clear();
  for (int k = 0; k <= n; ++k) full.start.push_back(n * k);
  for (int k = 0; k < n * n; ++k) full.row.push_back(k % n);
  return full;
}

DenseTangent::DenseTangent(System& system)
    : system_(system),
      full_(full_pattern(system.layout().coordinates)),
      lu_(system.layout().coordinates) {
  const int n = system.layout().coordinates;
  const auto count = static_cast<std::size_t>(n);
  for (auto* x : {&a_typ_, &zero_, &unit_, &ahead_}) x->assign(count, 0.0);
  typical_.resize(n);
  system.scale({typical_.data(), count}, a_typ_);
  for (std::size_t i = 0; i < count; ++i) {
    const double rate = a_typ_[i] / typical_[static_cast<Eigen::Index>(i)];
    rate_ = std::max(rate_, rate);
    a_typ_[i] *= rate;
  }
  compliance_.resize(n, n);
}

/// Forces cancel in the difference of two residuals. Accelerations of 1e9 times their
/// typical size leave them below the rounding of the inertia.
Status DenseTangent::mass(double t, In q, double factor, Out s) noexcept {
  const std::size_t n = q.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double size = 1e9 * a_typ_[k];
    const Out column = s.subspan(n * k, n);
    unit_[k] = size;
    Status status = system_.residual(t, q, zero_, unit_, column);
    unit_[k] = -size;
    if (status == Status::ok) status = system_.residual(t, q, zero_, unit_, ahead_);
    unit_[k] = 0;
    if (status != Status::ok) return status;
    for (std::size_t i = 0; i < n; ++i) {
      column[i] = factor * (column[i] - ahead_[i]) / (2 * size);
    }
  }
  return Status::ok;
}

/// A free strand has no stiffness against motions as one body: its matrix without inertia
/// has no inverse. Inertia as large as the stiffness at the typical rate is added, and
/// taken away from the entries.
Status DenseTangent::without_mass(double t, In q, In v, In a, Weights w, Out s) noexcept {
  w.acc = std::abs(w.pos) * rate_ * rate_ + std::abs(w.vel) * rate_;
  if (const Status status = values(t, q, v, a, w, s); status != Status::ok) return status;
  inertia_.resize(s.size());
  if (const Status status = mass(t, q, w.acc, inertia_); status != Status::ok) {
    return status;
  }
  for (std::size_t i = 0; i < s.size(); ++i) s[i] -= inertia_[i];
  return Status::ok;
}

Status DenseTangent::values(double t, In q, In v, In a, Weights w, Out s) noexcept {
  if (w.vel == 0 && w.pos == 0) return mass(t, q, w.acc, s);
  if (w.acc == 0) return without_mass(t, q, v, a, w, s);
  if (const Status status = system_.linearize(t, q, v, a, w); status != Status::ok) {
    return status;
  }
  const Eigen::Index n = typical_.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    unit_[static_cast<std::size_t>(k)] = 1 / typical_[k];
    const Out column(compliance_.col(k).data(), q.size());
    const Status status = system_.solve(unit_, column);
    unit_[static_cast<std::size_t>(k)] = 0;
    if (status != Status::ok) return status;
  }
  // (D^-1 S^-1 D^-1)^-1 = D S D, with D the typical sizes.
  compliance_ = typical_.cwiseInverse().asDiagonal() * compliance_;
  const double least = lu_.factor(compliance_);
  if (!(least > 0) || !std::isfinite(least)) return Status::retry;
  Eigen::Map<Eigen::MatrixXd> matrix(s.data(), n, n);
  matrix.setIdentity();
  for (Eigen::Index k = 0; k < n; ++k) lu_.solve(matrix.col(k));
  matrix = typical_.cwiseInverse().asDiagonal() * matrix *
           typical_.cwiseInverse().asDiagonal();
  return Status::ok;
}

}  // namespace tress::models
