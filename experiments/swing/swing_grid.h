#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"
#include "models/catalogue.h"
#include "simulation/files/row.h"

namespace tress {

/// Elements at which other simulators were measured, with their time error.
constexpr int peer_elements = 20;

/// One row of swing: which strand, who steps it and how, and what error is asked for.
struct SwingCase {
  std::string_view error_kind;  // time or total
  const ModelEntry* model;
  std::string_view modes, solver;
  std::string_view tangent;  // empty: the integrator takes none
  std::string_view integrator;
  bool adaptive, newton;  // whether it is driven by rtol, and iterates with `options`
  Options options;
  int elements;
  double grading;

  Row identity() const;
  Parameters parameters(const Settings& settings) const;
};

/// The strand of a row, or of a reference: defaults, the user's, the scene's.
Parameters swing_parameters(const Settings& settings, const ModelEntry& model,
                            int elements);

/// Keys of --set that choose rows.
std::span<const Parameter> swing_settings();

/// The rows that the command line and its settings leave, without those whose model the
/// integrator refuses.
std::vector<SwingCase> swing_cases(const CommandLine& line, const Settings& settings);

}  // namespace tress
