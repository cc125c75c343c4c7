#include <algorithm>
#include <cmath>

#include "contract/forms/transposed_form.h"
#include "integrators/gradient/probe.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// A system at the distances of the central stencil and at those of the affine one.
struct Distances {
  explicit Distances(const RunParameter& parameter)
      : far(parameter(affine_stencil.at[0])),
        middle(parameter(affine_stencil.at[0] / 2)) {
    for (const double s : central_stencil.at) near.push_back(parameter(s));
  }
  std::unique_ptr<System> far, middle;
  std::vector<std::unique_ptr<System>> near;
};

/// State and velocities of trial k. The first one is at the initial state, where large
/// forces do not hide others.
struct Trial {
  Trial(const Probe& probe, In q0, int k)
      : t(probed_times[k]), q(q0.begin(), q0.end()), v(probe.v), a(probe.a), mu(probe.q) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double x = static_cast<double>(i + 1) * (k + 1);
      q[i] += 0.05 * k * std::cos(1.9 * x) * probe.q_typ[i];
      v[i] += 0.05 * std::sin(2.3 * x) * probe.v_typ[i];
      mu[i] = std::cos(3.1 * x + k) * probe.q_typ[i];
    }
  }
  double t;
  std::vector<double> q, v, a, mu;
};

/// mu . dr/ds by residuals, and the size of its terms.
struct Slope {
  Slope(const Trial& at, const std::vector<std::unique_ptr<System>>& near) {
    std::vector<double> r(at.q.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
      ok = ok && near[i]->residual(at.t, at.q, at.v, at.a, r) == Status::ok;
      by += central_stencil.weight[i] * scalar_product(r, at.mu);
      double terms = 0;
      for (std::size_t k = 0; k < r.size(); ++k) terms += std::abs(r[k] * at.mu[k]);
      size = std::max(size, terms);
    }
  }
  double by = 0, size = 0;
  bool ok = true;
};

std::vector<double> constants_of(System& system) {
  TransposedForm* const form = transposed_form(system);
  return form == nullptr ? std::vector<double>{} : form->constants();
}

}  // namespace

std::optional<ConstantsDerivative> constants_derivative(System& system,
                                                        const RunParameter& parameter) {
  TransposedForm* const form = transposed_form(system);
  // Forces that depend on a place may begin to act later.
  if (parameter.places) return {};
  if (form == nullptr || system.layout().constraints > 0) return {};
  const std::vector<double> here = form->constants();
  if (here.empty()) return {};
  Distances distances(parameter);
  const Probe probe(system);
  std::vector<double> q(probe.q.size()), v(q), q_far(q), v_far(q);
  system.initial_state(q, v);
  distances.far->initial_state(q_far, v_far);
  const std::vector<double> far = constants_of(*distances.far),
                            middle = constants_of(*distances.middle);
  if (far.size() != here.size() || q != q_far || v != v_far ||
      points_at(system, probe.q) != points_at(*distances.far, probe.q)) {
    return {};
  }
  ConstantsDerivative found{std::vector<double>(here.size()), {affine_stencil, {}, {}}};
  for (std::size_t i = 0; i < distances.near.size(); ++i) {
    add(found.by, central_stencil.weight[i], constants_of(*distances.near[i]));
  }
  for (std::size_t j = 0; j < here.size(); ++j) {  // their sizes differ by many orders
    if (!affine({here[j]}, {middle[j]}, {far[j]})) continue;
    found.by[j] = affine_stencil.base * here[j] + affine_stencil.weight[0] * far[j];
  }
  // Rounding of residuals, 1e-16, over the distance of the stencil, 3e-6.
  constexpr double rounding = 1e-9;
  bool loaded = false, straight = true, acts = here != far;
  for (int k = 0; k < 3; ++k) {
    const Trial trial(probe, q, k);
    const Slope slope(trial, distances.near);
    form->place_transposed(trial.t, trial.q, trial.v, trial.a, trial.mu);
    std::vector<double> by_constants(here.size());
    form->add_by_constants(by_constants);
    const double load = form->power_of_loads(system),
                 load_far = form->power_of_loads(*distances.far),
                 load_middle = form->power_of_loads(*distances.middle);
    double by = scalar_product(found.by, by_constants), by_loads = 0;
    for (std::size_t i = 0; i < distances.near.size(); ++i) {
      by_loads += central_stencil.weight[i] * form->power_of_loads(*distances.near[i]);
    }
    loaded = loaded || load != load_far;
    straight = straight && affine({load}, {load_middle}, {load_far});
    if (load != load_far) by -= by_loads;
    acts = acts || load != load_far;
    if (!slope.ok || !(std::abs(by - slope.by) <= rounding * slope.size)) return {};
  }
  if (!acts) return {};  // here: it may act elsewhere
  if (loaded && straight) found.loads.systems.push_back(std::move(distances.far));
  if (loaded && !straight) {
    found.loads.stencil = central_stencil;
    found.loads.systems = std::move(distances.near);
  }
  return found;
}

}  // namespace tress::integrators
