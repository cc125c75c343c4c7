#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "experiments/hard_cases/survival.h"
#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"
#include "simulation/files/row.h"

namespace tress::experiments::hard_cases {

/// One row: an attempt, and the reference it is compared with.
struct Cell {
  Attempt attempt;
  Subject compared;       // owner of the reference: the subject with its exact tangent
  std::size_t reference;  // index among the references of all cells

  Row identity() const;
};

struct Grid {
  std::vector<Cell> cells;
  std::size_t references = 0;
};

/// --set keys that select rows.
std::span<const Parameter> hard_case_settings();

// The values that the command line selects from those of hard_grid().
std::vector<std::string_view> tried_integrators(const CommandLine& line);
/// s
std::vector<double> tried_steps(const CommandLine& line);
/// For this model and integrator; one empty string: the model has no such option.
std::vector<std::string_view> tried_tangents(const CommandLine& line,
                                             const ModelEntry& model,
                                             std::string_view integrator);

/// Every case on every strand model, and the particle systems that it names, by every
/// integrator and at every step that the command line selects; impossible combinations
/// are cells too.
///
/// --quick: semi_implicit_euler, backward_euler and implicit_midpoint, models with
/// default options, at 1/300 and 1/30 s. Otherwise more integrators, models with every
/// way of keeping lengths, and 1 ms; --full: every fixed-step integrator, and both
/// tangents. semi_implicit_euler has the stiff tangent where available.
Grid hard_grid(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::hard_cases
