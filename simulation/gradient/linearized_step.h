#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// One step of a strand's run, linearized in its state and in parameters s:
///
///     (dq, dv) at t_next = A (dq, dv) at t + B ds.
///
/// The parameters act during the step alone. A product of the A of successive steps is
/// the derivative of a run by its initial state.
struct LinearizedStep {
  double t = 0, t_next = 0;                  // s
  std::vector<double> q, v, q_next, v_next;  // coordinates and rates (n) at t and t_next
  std::vector<double> by_state;              // A (2n x 2n), row-major
  std::vector<double> by_parameters;         // B (2n x P), row-major, per unit of each
  std::string unfinished;  // why the run failed, with no matrices; empty: not
};

/// Runs a strand to `t` and linearizes the step that follows, of length `step`. Throws
/// InputError where the method's step depends on more than (q, v), where the model has
/// constraints, and as check_derivatives().
LinearizedStep linearized_step(const Scene& scene, std::size_t strand, double t,
                               double step, std::span<const SceneParameter> parameters);

}  // namespace tress::simulation
