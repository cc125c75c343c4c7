#include "integrators/formulation/projection.h"

#include <algorithm>
#include <limits>

namespace tress::integrators {
namespace {

// Simplified Newton steps gain at least two digits each near the manifold; a state that
// needs more than this is outside the basin.
constexpr int most_iterations = 30;

// g of size g_typ cannot be evaluated more accurately than to a few units in the last
// place of the coordinates it depends on.
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

/// Repeats `correct` (which returns the violation it met) until the violation reaches
/// rounding level or stops falling; the latter counts as success when it is small.
template <class Correct>
Status iterate(Correct correct) {
  double previous = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_iterations; ++i) {
    const auto [status, violation] = correct();
    if (status != Status::ok) return status;
    if (violation <= rounding) return Status::ok;
    if (!(violation < previous)) {
      return violation <= 1e3 * rounding ? Status::ok : Status::retry;
    }
    previous = violation;
  }
  return Status::retry;
}

struct Iteration {
  Status status;
  double violation;
};

}  // namespace

Projection::Projection(Dynamics& dynamics)
    : dynamics_(dynamics),
      step_(static_cast<std::size_t>(dynamics.n())),
      g_(static_cast<std::size_t>(dynamics.m())),
      zero_(step_.size()) {}

Status Projection::project(double t, InOut q, InOut v) noexcept {
  const Status s = dynamics_.linearize(t, q, v, zero_, g_, {1, 0, 0});
  if (s != Status::ok) return s;
  if (const Status p = positions(t, q); p != Status::ok) return p;
  return velocities(t, q, v);
}

Status Projection::positions(double t, InOut q) noexcept {
  return iterate([&]() -> Iteration {
    Status s = dynamics_.constraints()->value(t, q, g_);
    const double violation = scaled_norm(g_, dynamics_.g_typ());
    if (s != Status::ok || violation <= rounding) return {s, violation};
    std::fill(step_.begin(), step_.end(), 0.0);
    s = dynamics_.solve(step_, g_);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] -= step_[i];
    return {s, violation};
  });
}

Status Projection::velocities(double t, In q, InOut v) noexcept {
  // g' is compared with the speed that moves g by its own size in the system's time unit.
  const double rate_unit = std::max(
      1.0, *std::max_element(dynamics_.v_typ().begin(), dynamics_.v_typ().end()));
  return iterate([&]() -> Iteration {
    Status s = dynamics_.constraints()->rate(t, q, v, g_);
    const double violation = scaled_norm(g_, dynamics_.g_typ()) / rate_unit;
    if (s != Status::ok || violation <= rounding) return {s, violation};
    std::fill(step_.begin(), step_.end(), 0.0);
    s = dynamics_.solve(step_, g_);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] -= step_[i];
    return {s, violation};
  });
}

}  // namespace tress::integrators
