#include "integrators/one_step/radau_newton.h"

#include <algorithm>
#include <cmath>

#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

using Matrix = RadauTable::Matrix;
using Stages = RadauNewton::Stages;
constexpr std::size_t count = RadauTable::stages;

constexpr Matrix squared(const Matrix& x) {
  Matrix y{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      for (std::size_t k = 0; k < count; ++k) y[i][j] += x[i][k] * x[k][j];
    }
  }
  return y;
}

constexpr Matrix t = radau_table().t, t2 = squared(t);

/// Forward differences move the stages by this part of their typical sizes.
constexpr double difference = 1e-7;
/// Residual at which GMRES ends, over that of no correction.
constexpr double forcing = 1e-2;
/// Shortest part of a correction that is tried: a shorter step is cheaper than a shorter
/// correction.
constexpr double shortest = 0.25;

void add(Stages& x, double factor, const Stages& y) noexcept {
  for (std::size_t i = 0; i < count; ++i) x[i].become(x[i], factor, y[i]);
}

void scale(Stages& x, double factor) noexcept {
  for (Unknowns& stage : x) {
    for (double& entry : stage.a) entry *= factor;
    for (double& entry : stage.lambda) entry *= factor;
  }
}

}  // namespace

RadauNewton::RadauNewton(Dynamics& dynamics, const NewtonRules& rules, int iterations)
    : dynamics_(dynamics),
      rules_(rules),
      iterations_(iterations),
      base_(count, Unknowns(dynamics)),
      f_(base_),
      shifted_(base_),
      moved_(base_),
      level_(base_),
      step_(base_),
      basis_(most_vectors + 1, base_) {
  for (Points* points : {&q_, &v_, &q_shift_, &v_shift_}) {
    points->fill(std::vector<double>(size(dynamics.n())));
  }
}

double RadauNewton::time(std::size_t i) const noexcept {
  return start_.t + radau_table().c[i] * h_;
}

void RadauNewton::place(const Stages& x, Points& q, Points& v) const noexcept {
  constexpr RadauTable table = radau_table();
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::copy(start_.v, v[i].begin());
    for (std::size_t j = 0; j < count; ++j) tress::add(v[i], h_ * table.a[i][j], x[j].a);
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::copy(start_.q, q[i].begin());
    for (std::size_t j = 0; j < count; ++j) tress::add(q[i], h_ * table.a[i][j], v[j]);
  }
}

Status RadauNewton::evaluate(const Stages& x, Stages& f) noexcept {
  place(x, q_shift_, v_shift_);
  for (std::size_t i = 0; i < count; ++i) {
    const Status s = dynamics_.residual(time(i), q_shift_[i], v_shift_[i], x[i].a,
                                        x[i].lambda, f[i].a, f[i].lambda);
    if (s != Status::ok) return s;
  }
  return Status::ok;
}

Status RadauNewton::take_base(const Stages& x) noexcept {
  base_ = x;
  const Status s = evaluate(base_, f_);
  std::swap(q_, q_shift_);
  std::swap(v_, v_shift_);
  return s;
}

double RadauNewton::dot(const Stages& x, const Stages& y) const noexcept {
  const In typ = dynamics_.q_typ();
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < typ.size(); ++k) {
      sum += x[i].a[k] * y[i].a[k] / (typ[k] * typ[k]);
    }
  }
  return sum;
}

double RadauNewton::size_of(const Unknowns& y) const noexcept {
  const double g = radau_table().gamma() * h_;
  return std::max(g * g * scaled_norm(y.a, dynamics_.q_typ()),
                  g * scaled_norm(y.a, dynamics_.v_typ()));
}

double RadauNewton::size_of(const Stages& y) const noexcept {
  return std::max({size_of(y[0]), size_of(y[1]), size_of(y[2])});
}

Status RadauNewton::multiply(Stages& y) noexcept {
  const double change = size_of(y), part = difference / (change > 0 ? change : 1);
  for (std::size_t i = 0; i < count; ++i) shifted_[i].become(base_[i], part, y[i]);
  const Status s = evaluate(shifted_, y);
  add(y, -1, f_);
  scale(y, 1 / part);
  return s;
}

/// Changes of stages before i act on it as differences of F_i at fixed a_i, lambda_i.
Status RadauNewton::coupled(std::size_t i, double change, Stages& y) noexcept {
  const double part = difference / change;
  q_shift_[i] = q_[i];
  v_shift_[i] = v_[i];
  for (std::size_t j = 0; j < i; ++j) {
    tress::add(q_shift_[i], part * h_ * h_ * t2[i][j], y[j].a);
    tress::add(v_shift_[i], part * h_ * t[i][j], y[j].a);
  }
  Unknowns& f = shifted_[i];
  const Status s = dynamics_.residual(time(i), q_shift_[i], v_shift_[i], base_[i].a,
                                      base_[i].lambda, f.a, f.lambda);
  f.become(f, -1, f_[i]);
  y[i].become(y[i], -1 / part, f);
  return s;
}

Status RadauNewton::precondition(Stages& y) noexcept {
  const double g = t[0][0] * h_;
  double change = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Status s = change > 0 ? coupled(i, change, y) : Status::ok;
    if (s == Status::ok) {
      s = dynamics_.linearize(time(i), q_[i], v_[i], base_[i].a, base_[i].lambda,
                              {1, g, g * g});
    }
    if (s == Status::ok) s = dynamics_.solve(y[i].a, y[i].lambda);
    if (s != Status::ok) return s;
    change = std::max(change, size_of(y[i]));
  }
  return std::isfinite(change) ? Status::ok : Status::retry;
}

Status RadauNewton::correction(Stages& y) noexcept {
  std::array<std::array<double, most_vectors>, most_vectors + 1> h{};
  std::array<double, most_vectors> cosine{}, sine{};
  std::array<double, most_vectors + 1> rest{};
  rest[0] = std::sqrt(dot(y, y));
  const double enough = forcing * rest[0];
  basis_[0] = y;
  scale(basis_[0], 1 / rest[0]);
  std::size_t k = 0;
  for (; k < most_vectors && std::abs(rest[k]) > enough; ++k) {
    Stages& next = basis_[k + 1];
    next = basis_[k];
    Status s = multiply(next);
    if (s == Status::ok) s = precondition(next);
    if (s != Status::ok) return s;
    ++dynamics_.stats.newton_iterations;
    for (std::size_t j = 0; j <= k; ++j) {
      h[j][k] = dot(next, basis_[j]);
      add(next, -h[j][k], basis_[j]);
    }
    h[k + 1][k] = std::sqrt(dot(next, next));
    if (h[k + 1][k] > 0) scale(next, 1 / h[k + 1][k]);
    for (std::size_t j = 0; j < k; ++j) {
      const double upper = h[j][k], lower = h[j + 1][k];
      h[j][k] = cosine[j] * upper + sine[j] * lower;
      h[j + 1][k] = -sine[j] * upper + cosine[j] * lower;
    }
    const double length = std::hypot(h[k][k], h[k + 1][k]);
    if (!(length > 0)) break;
    cosine[k] = h[k][k] / length;
    sine[k] = h[k + 1][k] / length;
    h[k][k] = length;
    rest[k + 1] = -sine[k] * rest[k];
    rest[k] *= cosine[k];
  }
  for (std::size_t i = k; i-- > 0;) {
    for (std::size_t j = i + 1; j < k; ++j) rest[i] -= h[i][j] * rest[j];
    rest[i] /= h[i][i];
  }
  scale(y, 0);
  for (std::size_t i = 0; i < k; ++i) add(y, rest[i], basis_[i]);
  return std::isfinite(size_of(y)) ? Status::ok : Status::retry;
}

/// Moves x from the base by step_, or by its largest halving after which P^-1 F, level_
/// at the base, is shorter.
Status RadauNewton::damp(Stages& x) noexcept {
  const double size = std::sqrt(dot(level_, level_));
  for (double part = 1; part >= shortest; part /= 2) {
    for (std::size_t i = 0; i < count; ++i) x[i].become(base_[i], -part, step_[i]);
    Status s = evaluate(x, moved_);
    if (s == Status::ok) s = precondition(moved_);
    if (s == Status::fatal) return s;
    if (s == Status::ok && shrinks_enough(std::sqrt(dot(moved_, moved_)), part, size)) {
      return s;
    }
  }
  return Status::retry;
}

Status RadauNewton::solve(double h, Stages& x) noexcept {
  h_ = h;
  for (int i = 0; i < iterations_; ++i) {
    Status s = take_base(x);
    level_ = f_;
    if (s == Status::ok) s = precondition(level_);
    if (s != Status::ok) return s;
    ++dynamics_.stats.newton_iterations;
    const double size = size_of(level_);
    if (size <= rules_.tolerance) {
      add(x, -1, level_);
      return s;
    }
    step_ = level_;
    s = correction(step_);
    if (s != Status::ok) return s;
    s = damp(x);
    if (s == Status::retry && size <= rules_.rounding) {
      x = base_;
      return Status::ok;
    }
    if (s != Status::ok) return s;
  }
  return Status::retry;
}

}  // namespace tress::integrators
