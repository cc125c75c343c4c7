#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/run/command_line.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

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

/// Returns the table of constraint_drift:
///
/// - formulation: four constrained systems by every integrator in every form it supports.
/// - grid: a bead on a circle by explicit methods over Baumgarte's gains.
/// - recovery: the same bead, displaced off its circle, pulled back by feedback of
///   various damping.
/// - strands: lengths of a shaken hair by every strand model and the usual methods.
std::vector<DriftStudy> drift_studies(const CommandLine& line, const Settings& user);

/// The study `limit`: the largest Baumgarte gains before the feedback itself diverges,
/// compared with the prediction from the method's step matrix (amplification.h). The
/// prediction covers the whole map of gains; it is measured where the feedback is
/// useful, on a bead that swings gently at the bottom of a circle.
std::vector<Case> feedback_limits(const CommandLine& line, const Settings& user);

/// Checks the claims about the table of constraint_drift. Feedback helps symplectic
/// Euler, projection and RATTLE are at rounding level, and index 2 is near its tolerance.
/// Parametric forms do not drift, and critical damping is fastest without overshoot.
/// Limits of the gains are as predicted. Lengths of shaken strands are corrected.
void check_drift_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::constraint_drift
