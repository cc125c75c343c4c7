#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "integrators/integrator.h"

namespace tress {

/// One run of a strand from its initial state, seen at its tip.
struct TipRun {
  Status status;
  std::string failure;
  Stats stats;
  double wall_s;            // of stepping: setting up and reading the tip are not in it
  std::vector<double> tip;  // (3 samples) m; fewer when the run failed
};

/// Runs to t_end and gives the position of the last material point at t_end k / samples,
/// k = 1 .. samples. Steps do not land on these times: in between, the tip is on the
/// cubic through its places and velocities at both ends of a step, whose error falls as
/// the fourth power of the step. repeat = 0, or a failure: one run, not timed; else the
/// median, as time_run.
TipRun run_tip(std::string_view integrator, System& system, const Options& options,
               double t_end, int samples, int repeat = 0);

/// Root mean square distance over the samples, over `length`; infinite when a sample is
/// missing or not finite.
double tip_error(In tip, In reference, double length);

}  // namespace tress
