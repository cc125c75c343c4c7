#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/run/simulation.h"

namespace tress::experiments {

struct ProblemError {
  double relative;  // largest error over the scale of its entry
  double scd;       // -log10 of the largest entry-wise relative error; of velocities,
                    // of `relative`
  /// Largest distance of a material point over the length of the body, as error control
  /// measures it, but for velocities; coordinates over System::scale where there is no
  /// length.
  double of_body;
};

/// Compared quantities: material points are independent of the formulation; velocities
/// are the state of an equation of first order. Of coordinates, those of the reference.
enum class Compared { coordinates, velocities, points };

/// The state at one time of a run.
struct Checkpoint {
  double t;
  std::vector<double> values;  // the compared quantities
};

/// A problem whose end state is known: exactly, as published, or from two integrators of
/// different families whose disagreement is stored as the reference's own error.
struct Problem {
  std::string_view name;
  std::string_view model;
  ModelSettings settings;
  double t_end;                       // s
  double coarse_step;                 // s, the loosest fixed step worth trying
  std::vector<double> scale;          // of the compared values: one each, or one for all
  std::vector<Checkpoint> reference;  // the last one at t_end
  double reference_gap;               // relative to scale

  Compared compared;

  std::unique_ptr<System> make() const;
};

/// The material points of a state, three coordinates each.
std::vector<double> points(System& system, const State& state);

/// A run that is compared at every checkpoint, so that errors which happen to cancel at
/// one time do not pass for accuracy.
struct ProblemRun {
  Simulation end;
  ProblemError error;  // over all checkpoints reached
};
ProblemRun run_problem(const Problem& problem, std::string_view integrator,
                       const Options& options);

/// The problem with reference values from an explicit Runge-Kutta method and their
/// distance from those of an Adams method, both at 1e-13, with constraints as given.
Problem computed(Problem problem, Formulation runge_kutta, Formulation adams);

/// t_end k / count for k = 1 .. count, without values.
std::vector<Checkpoint> checkpoints(double t_end, int count);

/// Built on the first call; the doubly computed references take about a second.
std::span<const Problem> problems();

}  // namespace tress::experiments
