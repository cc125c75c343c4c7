#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/run/command_line.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

/// Error and cost of a step of descent by blocks of nodes.
namespace tress::experiments::block_descent {

inline constexpr double wanted_error = 0.01;  // of the tip, over the length
inline constexpr double substep = 1.0 / 300;  // s
inline constexpr int tried_sweeps = 20;

/// One strand by one method with the options that are its own.
struct Trial {
  std::string part;  // "sweeps", "order", "penalty", "rods"
  std::string scene;
  std::string model, integrator;
  std::vector<std::pair<std::string, std::string>> model_settings, options;
  int elements = 20;
  double dt = substep;
};

/// Error against sweeps and the size of blocks, order 1 compared with order 2, and the
/// window of penalties, on the swinging strand.
std::vector<Trial> descent_trials(const CommandLine& line);
/// Stable Cosserat rods on the swinging strand, as it is and softened, and on the
/// cantilever of their authors.
std::vector<Trial> rod_trials(const CommandLine& line);

/// One row for each, with the references that they are compared with.
std::vector<Case> cases_of(const std::vector<Trial>& trials, const CommandLine& line);

/// The claims about a finished table.
void judge(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::block_descent
