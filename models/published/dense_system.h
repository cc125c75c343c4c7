#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "contract/forms/sparse_form.h"
#include "contract/jacobian_choice.h"
#include "contract/pattern.h"
#include "contract/system.h"
#include "math/dual.h"

namespace tress::models {

/// Base of systems with a handful of coordinates: S(w) is a full n x n matrix. The kernel
/// states the mechanics once, for any scalar:
///
///     kernel.residual(t, q, v, a, r)   r = M a - f
///     kernel.inertia(q, x, r)          r = M(q) x
///     kernel.elastic(q, r)             r += dV/dq of its springs (Jacobian::elastic
///     only)
///
/// S(w) follows exactly: column k is the derivative of the residual along (a_k, v_k, q_k)
/// = (w.acc, w.vel, w.pos), taken with derivative numbers. Cost: O(n) residuals to
/// linearize, O(n^3) to factor; no heap memory after construction.
template <int n, class Kernel>
class DenseSystem : public System, public SparseForm {
 public:
  /// Takes the equations.
  explicit DenseSystem(Kernel kernel, Jacobian jacobian = Jacobian::exact)
      : kernel_(std::move(kernel)), jacobian_(jacobian) {
    full_.rows = full_.cols = n;
    for (int k = 0; k <= n; ++k) full_.start.push_back(n * k);
    for (int k = 0; k < n * n; ++k) full_.row.push_back(k % n);
  }

  Layout layout() const override { return {n, 0}; }
  Traits traits() const override {
    return {.constant_mass = false, .regular_mass = true};
  }

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    kernel_.residual(t, q.data(), v.data(), a.data(), r.data());
    return finite(r) ? Status::ok : Status::retry;
  }

  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    if (values(t, q, v, a, w, Out(s_.data(), n * n)) != Status::ok) return Status::retry;
    lu_.compute(s_);
    const double least = lu_.matrixLU().diagonal().cwiseAbs().minCoeff();
    return least > 0 && std::isfinite(least) ? Status::ok : Status::retry;
  }

  Status solve(In b, Out x) noexcept override {
    const Vector right = Eigen::Map<const Vector>(b.data());
    Eigen::Map<Vector>(x.data()) = lu_.solve(right);
    return Status::ok;
  }

  SparseForm* sparse_form() override { return this; }
  const Pattern& pattern() const override { return full_; }

  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override {
    using D = Dual<n>;
    std::array<D, n> r;
    if constexpr (requires(const D* x, D* y) { kernel_.elastic(x, y); }) {
      if (jacobian_ == Jacobian::elastic) {
        std::array<D, n> force;
        kernel_.inertia(q.data(), seeded(a, w.acc).data(), r.data());
        kernel_.elastic(seeded(q, w.pos).data(), force.data());
        for (int i = 0; i < n; ++i) r[i] += force[i];
        return store(r, s);
      }
    }
    kernel_.residual(t, seeded(q, w.pos).data(), seeded(v, w.vel).data(),
                     seeded(a, w.acc).data(), r.data());
    return store(r, s);
  }

 protected:
  using Vector = Eigen::Matrix<double, n, 1>;
  using Matrix = Eigen::Matrix<double, n, n>;

  const Kernel& kernel() const { return kernel_; }

  double kinetic_energy(In q, In v) const {
    Vector momentum;
    kernel_.inertia(q.data(), v.data(), momentum.data());
    return 0.5 * momentum.dot(Eigen::Map<const Vector>(v.data()));
  }

  static bool finite(Out r) {
    return std::all_of(r.begin(), r.end(), [](double x) { return std::isfinite(x); });
  }

 private:
  using Duals = std::array<Dual<n>, n>;

  static Duals seeded(In x, double weight) {
    Duals y;
    for (int k = 0; k < n; ++k) {
      y[k].value = x[k];
      y[k].part[k] = weight;
    }
    return y;
  }

  static Status store(const Duals& r, Out s) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) s[n * j + i] = r[i].part[j];
    }
    return finite(s) ? Status::ok : Status::retry;
  }

  Kernel kernel_;
  Jacobian jacobian_;
  Pattern full_;
  Matrix s_;
  Eigen::PartialPivLU<Matrix> lu_;
};

}  // namespace tress::models
