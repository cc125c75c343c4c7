#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/gradient/gradient_run.h"
#include "simulation/scene/scene.h"

/// Error and cost of the derivatives of a run.
namespace tress::experiments::cost_of_gradient {

/// Parameters of the study, and the columns with their errors.
struct ByParameter {
  std::string_view name, column;
};
inline constexpr ByParameter parameters[] = {
    {"youngs_modulus_pa", "modulus_error_rel"},
    {"internal_friction_kg_m3_s", "friction_error_rel"},
    {"linear_drag.drag_kg_m_s", "drag_error_rel"},
    {"natural_curvature_per_m", "curvature_error_rel"}};

inline constexpr double strand_length = 0.1;  // m, of all strands
inline constexpr int usual_elements = 10;     // number of elements where it does not vary

/// A curl whose clamp swings, and straight hair that falls on a plane 30 mm below. A body
/// of that scene is given as the lines of its table.
simulation::Scene curl();
simulation::Scene fall(std::string_view body);
/// Returns the scene with this model, its exact Jacobian, this method and the formulation
/// index3 where the model has constraints.
simulation::Scene with(const simulation::Scene& scene, std::string_view model,
                       std::string_view integrator, int elements);

std::unique_ptr<System> system_of(const simulation::Scene& scene);

/// Selects how derivatives are computed.
struct Way {
  integrators::GradientStart start = integrators::GradientStart::damped;
  /// Uses the model's elastic Jacobian in place of the exact one, in the run and in its
  /// variational equations.
  bool elastic = false;
};

/// A run with the derivatives of its tip by `parameters`.
struct Course {
  std::vector<double> tips;             // m, three at every frame
  std::vector<std::vector<double>> by;  // m over a unit of each parameter
  long linearizations = 0;              // of the run and of its derivatives
  double time_s = 0;
  std::string failure;  // empty: it reached the end
};

/// Runs one strand with `steps` equal steps.
Course course(const simulation::Scene& scene, int steps, const Way& way = {});

/// Root mean square distance of the tips (m).
double tip_distance(const Course& one, const Course& other);
/// Root mean square of the difference over that of `reference`, of parameter k.
double relative_error(const Course& one, const Course& reference, std::size_t k);
/// The largest over all parameters.
double relative_error(const Course& one, const Course& reference);
/// Returns the limit of runs with errors of second order, of which `fine` has twice the
/// elements.
Course extrapolated(const Course& coarse, const Course& fine);

}  // namespace tress::experiments::cost_of_gradient
