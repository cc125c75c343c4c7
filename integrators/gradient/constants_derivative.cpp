#include <algorithm>
#include <cmath>

#include "contract/forms/moved_clamp.h"
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

/// Of a system whose mu is known. NaN: not available.
double power_of_clamp(System& system, System& other) {
  MovedClamp* const form = moved_clamp(system);
  return form == nullptr ? std::nan("") : form->power_of_clamp(other);
}

/// Whether the parameter moves points at the start, or at the coordinates q.
bool moves_points(System& system, System& far, In q) {
  std::vector<double> q_here(q.size()), v_here(q_here), q_far(q_here), v_far(q_here);
  system.initial_state(q_here, v_here);
  far.initial_state(q_far, v_far);
  return q_here != q_far || v_here != v_far || points_at(system, q) != points_at(far, q);
}

/// Derivatives of the constants. Their sizes differ by many orders.
std::vector<double> by_constants(const std::vector<double>& here, const Distances& at) {
  const std::vector<double> far = constants_of(*at.far),
                            middle = constants_of(*at.middle);
  std::vector<double> by(here.size());
  for (std::size_t i = 0; i < at.near.size(); ++i) {
    add(by, central_stencil.weight[i], constants_of(*at.near[i]));
  }
  for (std::size_t j = 0; j < here.size(); ++j) {
    if (!affine({here[j]}, {middle[j]}, {far[j]})) continue;
    by[j] = affine_stencil.base * here[j] + affine_stencil.weight[0] * far[j];
  }
  return by;
}

/// The sum over central_stencil.
template <class Power>
double slope_of(const std::vector<std::unique_ptr<System>>& near, Power power) {
  double by = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    by += central_stencil.weight[i] * power(*near[i]);
  }
  return by;
}

}  // namespace

std::optional<ConstantsDerivative> constants_derivative(System& system,
                                                        const RunParameter& parameter,
                                                        KnownForces forces) {
  TransposedForm* const form = transposed_form(system);
  if (form == nullptr || system.layout().constraints > 0) return {};
  const std::vector<double> here = form->constants();
  if (here.empty()) return {};
  Distances distances(parameter);
  const std::vector<double> far = constants_of(*distances.far);
  if (far.size() != here.size()) return {};
  const Probe probe(system);
  std::vector<double> q(probe.q.size()), v(q);
  system.initial_state(q, v);
  ConstantsDerivative found;
  found.by = by_constants(here, distances);
  found.loads.stencil = affine_stencil;
  found.moves_points = moves_points(system, *distances.far, probe.q);
  // Rounding of residuals, 1e-16, over the distance of the stencil, 3e-6.
  constexpr double rounding = 1e-9;
  bool loaded = false, straight = true, clamped = false;
  for (int k = 0; k < 3; ++k) {
    const Trial trial(probe, q, k);
    const Slope slope(trial, distances.near);
    form->place_transposed(trial.t, trial.q, trial.v, trial.a, trial.mu);
    std::vector<double> products(here.size());
    form->add_by_constants(products);
    const auto load_of = [&](System& of) { return form->power_of_loads(of); };
    const double load = load_of(system), load_far = load_of(*distances.far),
                 load_middle = load_of(*distances.middle);
    double by = scalar_product(found.by, products);
    if (load != load_far) by -= slope_of(distances.near, load_of);
    loaded = loaded || load != load_far;
    straight = straight && affine({load}, {load_middle}, {load_far});
    const auto clamp_of = [&](System& of) { return power_of_clamp(system, of); };
    const double clamp_far = clamp_of(*distances.far);
    if (!std::isnan(clamp_far)) {
      by += slope_of(distances.near, clamp_of);
      // What places may move the clamp later.
      clamped = clamped || clamp_far != 0 || parameter.places;
    }
    if (!slope.ok || !(std::abs(by - slope.by) <= rounding * slope.size)) return {};
  }
  if (here == far && !loaded && !clamped) return {};  // here: it may act elsewhere
  if (found.moves_points && !clamped) return {};
  const bool unknown = parameter.law == ParameterLaw::unknown;
  if ((unknown || parameter.places || clamped) && (loaded || !forces.quadratic)) {
    found.loads.stencil = placed_stencil(parameter);
    for (const double s : found.loads.stencil.at) {
      found.loads.systems.push_back(parameter(s));
    }
  } else if (loaded && straight) {
    found.loads.systems.push_back(std::move(distances.far));
  } else if (loaded) {
    found.loads.stencil = central_stencil;
    for (const double s : central_stencil.at) {
      found.loads.systems.push_back(parameter(s));
    }
  }
  if (clamped) {
    found.clamp.stencil = central_stencil;
    found.clamp.systems = std::move(distances.near);
  }
  return found;
}

}  // namespace tress::integrators
