#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"

namespace tress::experiments::constraint_drift {

/// One row of the table.
struct DriftStudy {
  std::string_view study;
  std::string_view system;
  const ModelEntry* model;
  Parameters parameters;
  std::string_view integrator;
  Options options;
  double t_end;              // s
  double violation = 0;      // m, of the initial state
  std::string variant = {};  // of a strand model
};

/// The table of constraint_drift:
///
/// formulation: four constrained systems by every integrator in every form it supports.
/// grid: a bead on a circle by explicit methods over Baumgarte's gains.
/// recovery: the same bead, displaced off its circle, pulled back by feedback of various
///   damping.
/// strands: lengths of a shaken hair by every strand model and the usual methods.
std::vector<DriftStudy> drift_studies(const CommandLine& line, const Settings& user);

}  // namespace tress::experiments::constraint_drift
