#include "integrators/formulation/relaxation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "integrators/formulation/dynamics.h"

namespace tress::integrators {
namespace {

// Reduction of g before g and G are re-evaluated: their change is of second order in the
// step.
constexpr double reduction = 0.1;

// Near g = 0 each digit costs m sweeps; a state that needs more is not near.
constexpr long sweeps_per_constraint = 100;

}  // namespace

std::optional<std::vector<double>> diagonal_mass(System& system) {
  SparseForm& form = *system.sparse_form();
  const Pattern& pattern = form.pattern();
  const std::size_t n = size(pattern.cols);
  std::vector<double> q(n), v(n), a(n), diagonal(n), mass(size(pattern.nonzeros()));
  system.initial_state(q, v);
  if (form.values(0, q, v, a, {1, 0, 0}, mass) != Status::ok) return {};
  for (std::size_t j = 0; j < n; ++j) {
    for (auto at = size(pattern.start[j]); at < size(pattern.start[j + 1]); ++at) {
      if (size(pattern.row[at]) == j) {
        diagonal[j] = mass[at];
      } else if (mass[at] != 0) {
        return {};
      }
    }
  }
  return diagonal;
}

Relaxation::Relaxation(System& system, double tolerance)
    : constraints_(*system.constraint_form()),
      tolerance_(tolerance),
      inverse_mass_(size(system.layout().coordinates)),
      step_(inverse_mass_.size()),
      g_(size(system.layout().constraints)),
      g_typ_(g_.size()),
      stiffness_(g_.size()),
      values_(size(constraints_.pattern().nonzeros())) {
  const double m = static_cast<double>(g_.size());
  factor_ = 2 / (1 + std::sin(std::numbers::pi / (2 * m + 1)));
  constraints_.scale(g_typ_);
  // A coordinate without mass is held fixed.
  const std::vector<double> mass = diagonal_mass(system).value_or(inverse_mass_);
  for (std::size_t j = 0; j < mass.size(); ++j) {
    if (mass[j] > 0) inverse_mass_[j] = 1 / mass[j];
  }
}

Status Relaxation::linearize(double t, In q) noexcept {
  const Pattern& pattern = constraints_.pattern();
  if (const Status s = constraints_.gradient(t, q, values_); s != Status::ok) return s;
  for (std::size_t k = 0; k < g_.size(); ++k) {
    stiffness_[k] = 0;
    for (auto at = size(pattern.start[k]); at < size(pattern.start[k + 1]); ++at) {
      stiffness_[k] += values_[at] * values_[at] * inverse_mass_[size(pattern.row[at])];
    }
  }
  std::ranges::fill(step_, 0.0);
  return Status::ok;
}

double Relaxation::sweep() noexcept {
  ++sweeps_;
  const Pattern& pattern = constraints_.pattern();
  double most = 0;
  for (std::size_t k = 0; k < g_.size(); ++k) {
    const auto begin = size(pattern.start[k]), end = size(pattern.start[k + 1]);
    double left = g_[k];
    for (auto at = begin; at < end; ++at)
      left += values_[at] * step_[size(pattern.row[at])];
    most = std::max(most, std::abs(left) / g_typ_[k]);
    if (stiffness_[k] == 0) continue;
    const double impulse = factor_ * left / stiffness_[k];
    for (auto at = begin; at < end; ++at) {
      const auto i = size(pattern.row[at]);
      step_[i] -= inverse_mass_[i] * values_[at] * impulse;
    }
  }
  return most;
}

Status Relaxation::positions(double t, InOut q) noexcept {
  const long most = sweeps_ + sweeps_per_constraint * static_cast<long>(g_.size() + 1);
  while (true) {
    if (const Status s = constraints_.value(t, q, g_); s != Status::ok) return s;
    const double violation = scaled_norm(g_, g_typ_);
    if (violation <= tolerance_) return Status::ok;
    if (!std::isfinite(violation)) return Status::retry;
    if (const Status s = linearize(t, q); s != Status::ok) return s;
    const double enough = std::max(reduction * violation, tolerance_ / 2);
    while (sweep() > enough) {
      if (sweeps_ > most) return Status::retry;
    }
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += step_[i];
    if (sweeps_ > most) return Status::retry;
  }
}

}  // namespace tress::integrators
