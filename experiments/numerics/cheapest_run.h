#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "experiments/numerics/tip_track.h"

namespace tress::experiments {

/// One way to meet a target error.
struct CheapRun {
  int elements;
  double dt;     // s
  double error;  // tip_error; infinite: the run failed
  double work;   // of this run, total_work()
};

struct CheapSearch {
  double target;  // of the error
  std::span<const int> elements;
  double coarsest, finest;  // s; tried steps halve from coarsest to finest
  double most_work = std::numeric_limits<double>::infinity();  // of all runs together
};

struct Cheapest {
  std::optional<CheapRun> run;  // empty: no run met the target
  bool complete;                // false: the work ran out before all were tried
};

/// Finds the run of least work whose error is at most the target: for every number of
/// elements the longest step that meets it. For one model and one integrator, when all
/// combinations are compared and the answer must be the same on every machine. For the
/// method that is robustly fastest on one machine's clock see cost_of_accuracy's Search.
///
/// A number of elements is abandoned when halving the step reduces an error near the
/// target by less than a fifth: the remaining error is not temporal. It is also abandoned
/// when halving takes more work than the best run so far. Work decides rather than time,
/// so that the answer is the same on every machine. `run` may stop at most_work: beyond
/// it the run cannot be the best, or the search is over.
Cheapest cheapest_run(
    const CheapSearch& search,
    const std::function<CheapRun(int elements, double dt, double most_work)>& run);

}  // namespace tress::experiments
