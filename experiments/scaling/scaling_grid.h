#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"
#include "simulation/files/row.h"

namespace tress::experiments::scaling {

/// Name of a straight strand in the column `structure`; other names are trees.
inline constexpr std::string_view straight = "straight";

/// One row of scaling: the strand or tree, and how its model solves S x = b.
struct ScalingCase {
  std::string_view structure;
  const ModelEntry* model;
  std::string_view solver, tangent, modes;
  int elements;

  Row identity() const;
  /// The model's: defaults, then the user's, those of the released strand or of the tree
  /// with its material, and this row's.
  Parameters parameters(const Settings& settings) const;
  /// Whether frames per second are reported: sizes of the published table, all unknowns.
  bool in_seed_table() const;
  /// Published frames per second at 30 a second [Bertails-Descoubes 2010, "Performance
  /// results"], on hardware of 2008; empty where not given.
  std::optional<double> seed_fps() const;
};

/// --set keys that select rows.
std::span<const Parameter> scaling_settings();

/// The rows that the command line and its settings select: every solver, tangent and set
/// of modes over the sizes, dense matrices up to a size limit, and the five trees.
std::vector<ScalingCase> scaling_cases(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::scaling
