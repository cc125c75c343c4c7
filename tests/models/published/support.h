#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "contract/pattern.h"
#include "contract/system.h"
#include "experiments/numerics/dense_algebra.h"
#include "models/catalogue.h"

namespace tress {

using namespace experiments;

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

inline In in(const Vector& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }
inline Out out(Vector& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }
inline Vector vector_of(In x) {
  return Eigen::Map<const Vector>(x.data(), static_cast<Eigen::Index>(x.size()));
}

inline std::unique_ptr<System> make_model(
    std::string_view id,
    std::initializer_list<std::pair<std::string_view, std::string_view>> settings = {}) {
  const ModelEntry& entry = find_model(id);
  Parameters parameters(setup_parameters(entry), "model " + std::string(id));
  for (const auto& [key, value] : settings) parameters.set(key, value);
  return entry.make(parameters);
}

struct DenseState {
  double t = 0;
  Vector q, v, a;
};

inline DenseState start_of(const System& system) {
  const int n = system.layout().coordinates;
  DenseState s{0, Vector(n), Vector(n), Vector::Zero(n)};
  system.initial_state(out(s.q), out(s.v));
  return s;
}

/// A state away from the start by the model's typical sizes; t inside the load's pulse.
inline DenseState random_state(const System& system, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const int n = system.layout().coordinates;
  Vector q_typ(n), v_typ(n);
  system.scale(out(q_typ), out(v_typ));
  DenseState s = start_of(system);
  s.t = 0.7;
  for (int i = 0; i < n; ++i) {
    s.q[i] += 0.3 * std::min(1.0, q_typ[i]) * normal(engine);
    s.v[i] += 0.5 * v_typ[i] * normal(engine);
    s.a[i] = v_typ[i] * v_typ[i] * normal(engine);
  }
  return s;
}

inline Vector random_vector(int n, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Vector x(n);
  for (double& entry : x) entry = normal(engine);
  return x;
}

inline Matrix dense(const Pattern& pattern, In values) {
  Matrix m = Matrix::Zero(pattern.rows, pattern.cols);
  for (int j = 0; j < pattern.cols; ++j) {
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) {
      m(pattern.row[p], j) = values[p];
    }
  }
  return m;
}

/// Derivative of f at 0: central differences at h and h/2, extrapolated; error O(h^4).
template <class F>
Vector derivative(F f, double h) {
  const Vector coarse = (f(h) - f(-h)) / (2 * h);
  const Vector fine = (f(h / 2) - f(-h / 2)) / h;
  return (4 * fine - coarse) / 3;
}

inline Vector residual_of(System& system, const DenseState& s) {
  Vector r(s.q.size());
  EXPECT_EQ(system.residual(s.t, in(s.q), in(s.v), in(s.a), out(r)), Status::ok);
  return r;
}

/// S(w) column by column, by solving for unit right-hand sides and inverting.
inline Matrix tangent_of(System& system, const DenseState& s, Weights w) {
  const Eigen::Index n = s.q.size();
  EXPECT_EQ(system.linearize(s.t, in(s.q), in(s.v), in(s.a), w), Status::ok);
  Matrix inverse(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Vector unit = Vector::Unit(n, j);
    Vector x(n);
    EXPECT_EQ(system.solve(in(unit), out(x)), Status::ok);
    inverse.col(j) = x;
  }
  return solution(inverse, Matrix::Identity(n, n));
}

/// Correct digits of the worst entry: error over its size, or over `typical` if that is
/// larger.
inline double digits(const Vector& actual, In published, const Vector& typical) {
  const Vector expected = vector_of(published);
  const Vector size = expected.cwiseAbs().cwiseMax(typical);
  return -std::log10((actual - expected).cwiseQuotient(size).lpNorm<Eigen::Infinity>());
}

/// |S x - b| / (|S| |x|) with x = solve(b) and S x the derivative of the residual along
/// (w.acc x, w.vel x, w.pos x), by differences. The step moves no argument by more than a
/// thousandth of its typical size: truncation 1e-12, rounding 1e-16 / 1e-3.
inline double tangent_error(System& system, const DenseState& s, Weights w,
                            unsigned seed) {
  const int n = system.layout().coordinates;
  Vector q_typ(n), v_typ(n), x(n);
  system.scale(out(q_typ), out(v_typ));
  const Matrix matrix = tangent_of(system, s, w);
  const Vector b = matrix * random_vector(n, seed).cwiseProduct(q_typ);
  EXPECT_EQ(system.linearize(s.t, in(s.q), in(s.v), in(s.a), w), Status::ok);
  EXPECT_EQ(system.solve(in(b), out(x)), Status::ok);
  double reach = (w.pos * x).cwiseQuotient(q_typ).lpNorm<Eigen::Infinity>();
  reach = std::max(reach, (w.vel * x).cwiseQuotient(v_typ).lpNorm<Eigen::Infinity>());
  const Vector a_typ = s.a.cwiseAbs() + v_typ.cwiseAbs2();
  reach = std::max(reach, (w.acc * x).cwiseQuotient(a_typ).lpNorm<Eigen::Infinity>());
  const Vector difference = derivative(
      [&](double h) {
        return residual_of(
            system, {s.t, s.q + h * w.pos * x, s.v + h * w.vel * x, s.a + h * w.acc * x});
      },
      1e-3 / reach);
  return (difference - b).norm() / (matrix.norm() * x.norm());
}

}  // namespace tress
