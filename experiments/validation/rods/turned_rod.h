#pragma once

#include <vector>

#include "experiments/problems/strand_models.h"
#include "simulation/run/world.h"

namespace tress::experiments::validation {

/// A straight rubber thread between a clamp at its root and a clamped support at its tip.
/// The support turns about the axis of the thread and moves along it. No spring holds
/// it. Density, drag and times set how close to equilibrium the thread stays. Results are
/// ratios, so that the rest only sets units.
struct TurnedRod {
  static constexpr double length = 0.5, radius = 5e-4;  // m
  static constexpr double twist_over_bend = 2.0 / 3;    // GJ/EI

  /// Shortening of the distance of the ends (m over the length) at a time (s).
  struct Push {
    double time, shortening;
  };

  double turns;                  // of the support, from rest at t = 0 ...
  double turning;                // ... to rest at this time, s
  std::vector<Push> pushes;      // of the support, which rests at each of them
  double density;                // kg/m^3
  double drag;                   // kg/(m s)
  double internal_friction = 0;  // kg m^3/s
  double contact_radius = 0;     // m; of self-contact, 0: none
  double step;                   // s

  static double bending();     // EI, N m^2
  static double separation();  // m along the thread, between parts that touch

  /// The scene of a model with n elements. Its integrator is linearly_implicit_euler.
  /// Throws InputError where the model refuses the support.
  simulation::Scene scene(const ModelVariant& variant, int elements) const;
};

/// Load of the support on the tip, in the thread's units.
struct TipLoad {
  double tension;  // T L^2/EI
  double moment;   // M L/EI, about the axis
};
TipLoad tip_load(simulation::World& world);

/// Largest angle (rad) of a chord of the points against x.
double largest_tilt(simulation::World& world);

}  // namespace tress::experiments::validation
