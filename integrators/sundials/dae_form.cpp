#include "integrators/sundials/dae_form.h"

#include <algorithm>
#include <cmath>

namespace tress::integrators {
namespace {

/// For Dynamics, GGL is index 3: its constraint row is g; the row of g' is added here.
Options for_dynamics(Options options) {
  if (options.formulation == Formulation::index2_ggl) {
    options.formulation = Formulation::index3;
  }
  return options;
}

}  // namespace

DaeForm::DaeForm(System& system, const Options& options)
    : dynamics(system, for_dynamics(options)),
      sparse(dynamics.m() > 0 ? system.sparse_form() : nullptr),
      formulation(options.formulation),
      n(size(dynamics.n())),
      m(size(dynamics.m())) {
  if (m == 0) return;
  gt_.resize(size(dynamics.constraints()->pattern().nonzeros()));
  mass_.resize(size(sparse->pattern().nonzeros()));
}

int DaeForm::multipliers(System& system, Formulation formulation) {
  const int m = system.layout().constraints;
  return formulation == Formulation::index2_ggl ? 2 * m : m;
}

DaeForm::Parts DaeForm::parts(In y) const noexcept {
  return {y.first(n), y.subspan(n, n), y.subspan(2 * n, m), y.subspan(2 * n + m)};
}

Status DaeForm::residual(double t, In y, In y_dot, Out f) noexcept {
  const auto [q, v, lambda, mu] = parts(y);
  const Out f_q = f.first(n), f_v = f.subspan(n, n), rows = f.subspan(2 * n, m);
  const Out g_rows = mu.empty() ? rows : f.last(m);
  const Status s = dynamics.residual(t, q, v, y_dot.subspan(n, n), lambda, f_v, g_rows);
  if (s != Status::ok) return s;
  for (std::size_t i = 0; i < n; ++i) f_q[i] = y_dot[i] - v[i];
  if (mu.empty()) return Status::ok;

  ConstraintForm& form = *dynamics.constraints();
  if (const Status g = form.gradient(t, q, gt_); g != Status::ok) return g;
  const Pattern& pattern = form.pattern();
  for (std::size_t k = 0; k < m; ++k) {
    for (int p = pattern.start[k]; p < pattern.start[k + 1]; ++p) {
      f_q[size(pattern.row[size(p)])] -= gt_[size(p)] * mu[k];
    }
  }
  return form.rate(t, q, v, rows);
}

Status DaeForm::consistent(double t, InOut y, Out y_dot) noexcept {
  std::ranges::fill(y.subspan(2 * n), 0.0);
  std::ranges::fill(y_dot, 0.0);
  std::ranges::copy(y.subspan(n, n), y_dot.begin());
  return dynamics.accelerate(t, y.first(n), y.subspan(n, n), y_dot.subspan(n, n),
                             y.subspan(2 * n, m));
}

Status DaeForm::multiplier_scale(double t, In y, Out typ) noexcept {
  if (m == 0) return Status::ok;
  const auto [q, v, lambda, mu] = parts(y);
  ConstraintForm& form = *dynamics.constraints();
  if (const Status s = form.gradient(t, q, gt_); s != Status::ok) return s;
  const Status s = sparse->values(t, q, v, v, {1, 0, 0}, mass_);  // M, independent of a
  if (s != Status::ok) return s;

  const auto mass = [&](int i) {  // the diagonal of M
    const Pattern& pattern = sparse->pattern();
    for (int p = pattern.start[size(i)]; p < pattern.start[size(i) + 1]; ++p) {
      if (pattern.row[size(p)] == i) return std::abs(mass_[size(p)]);
    }
    return 0.0;
  };
  const Pattern& pattern = form.pattern();
  const In q_typ = dynamics.q_typ(), v_typ = dynamics.v_typ();
  for (std::size_t k = 0; k < m; ++k) {
    double squares = 0, force = 0, speed = 0;
    for (int p = pattern.start[k]; p < pattern.start[k + 1]; ++p) {
      const int row = pattern.row[size(p)];
      const std::size_t i = size(row);
      squares += gt_[size(p)] * gt_[size(p)];
      force = std::max(force, mass(row) * v_typ[i] * v_typ[i] / q_typ[i]);
      speed = std::max(speed, v_typ[i]);
    }
    const double length = squares > 0 ? std::sqrt(squares) : 1;
    typ[k] = std::max(std::abs(lambda[k]), force / length);
    if (!mu.empty()) typ[m + k] = speed / length;
  }
  return Status::ok;
}

void DaeForm::differential(Out id) const {
  std::ranges::fill(id.first(2 * n), 1.0);
  std::ranges::fill(id.subspan(2 * n), 0.0);
}

}  // namespace tress::integrators
