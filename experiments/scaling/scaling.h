#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/run/command_line.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"
#include "simulation/head/head_device.h"

namespace tress::experiments::scaling {

/// Name of a straight strand in the column `structure`; other names are trees.
inline constexpr std::string_view straight = "straight";

/// s; the cost of a step does not depend on it: short enough for models that diverge.
inline constexpr double timed_step = 1e-4;

/// One row of scaling: the strand or tree, and how its model solves S x = b.
struct ScalingCase {
  std::string_view structure;
  const ModelEntry* model;
  std::string_view solver, jacobian, modes;
  int elements;

  Row identity() const;
  /// The model's: defaults, then the user's, those of the released strand or of the tree
  /// with its material, and this row's.
  Parameters parameters(const Settings& settings) const;
  /// Whether frames per second are reported: sizes of the published table, all unknowns.
  bool in_seed_table() const;
  /// Published frames per second at 30 a second [Bertails-Descoubes 2010, "Performance
  /// results"], on hardware of 2008; empty where not given.
  std::optional<double> published_fps() const;
};

/// --set keys that select rows.
std::span<const Parameter> scaling_settings();

/// Returns the rows that the command line and its settings select. They are every solver,
/// Jacobian and set of modes over the sizes, dense matrices up to a size limit, and the
/// five trees.
std::vector<ScalingCase> scaling_cases(const CommandLine& line, const Settings& settings);

/// Returns rows for scene files: the cost of a linearly implicit step by every selected
/// strand model. One series is against the number of elements (of one typical strand; of
/// all, where they touch each other), one against the number of strands with the file's
/// discretisation. Throws InputError on scenes without strands and on two of one name.
std::vector<Case> scene_costs(const CommandLine& line,
                              const std::vector<std::string>& files);

/// `first`, and `factor` times the one before, while below `all`; and all.
std::vector<std::size_t> growing(std::size_t first, std::size_t factor, std::size_t all);

/// Sets the cost of a step (s), and the cost per element of all strands of the row.
void set_cost(double per_step, Row& row);

/// Returns rows for scene files as batches, by a device or the CPU in its place. The cost
/// is that of a step of the scene's own model, all strands in one batch, against their
/// number. Throws InputError on a scene that cannot run as a batch.
std::vector<Case> head_costs(const CommandLine& line,
                             const std::vector<std::string>& files, DeviceChoice device);

/// Fills `exponent` of every series of straight strands (same model, solver, Jacobian and
/// modes) and of scene files. It is p of cost ~ N^p, fitted to the measurements from 20
/// elements on, or to all numbers of strands, with at least three sizes.
void add_exponents(std::vector<Row>& rows);

/// Figures of this machine for the super-helix with the elastic Jacobian: growth of the
/// recursion's cost and cost per element, cost ratio of the composite, and savings from
/// fewer unknowns.
void tell_scaling_figures(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::scaling
