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

/// One row: an attempt, and which reference it is compared with.
struct Cell {
  Attempt attempt;
  Subject compared;       // whose reference: the subject with its whole tangent
  std::size_t reference;  // number of it, of those that the cells name

  Row identity() const;
};

struct Grid {
  std::vector<Cell> cells;
  std::size_t references = 0;
};

/// Keys of --set that choose rows.
std::span<const Parameter> hard_case_settings();

// What the command line leaves of what is tried; hard_grid() says which.
std::vector<std::string_view> tried_integrators(const CommandLine& line);
/// s
std::vector<double> tried_steps(const CommandLine& line);
/// Of this model with this integrator; one empty word: the model has no choice.
std::vector<std::string_view> tried_tangents(const CommandLine& line,
                                             const ModelEntry& model,
                                             std::string_view integrator);

/// Every case on every model of a strand, and the systems of particles that it names, by
/// every integrator and at every step that the command line leaves; what cannot be is a
/// cell too.
///
/// --quick: semi_implicit_euler, backward_euler and implicit_midpoint, models as they
/// come, at 1/300 and 1/30 s. Else more integrators, models by every way of keeping
/// lengths, and 1 ms; --full: every fixed-step integrator, and both tangents.
/// semi_implicit_euler has the tangent of the seed's papers where there is one.
Grid hard_grid(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::hard_cases
