#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "experiments/numerics/tip_track.h"

namespace tress::experiments {

/// One way to meet a wanted error.
struct CheapRun {
  int elements;
  double dt;     // s
  double error;  // of the tip, tip_error; infinite: the run failed
  double work;   // of that one run, total_work()
};

struct CheapSearch {
  double target;  // of the error
  std::span<const int> elements;
  double coarsest, finest;  // s, steps tried, each half the one before
  double most_work = std::numeric_limits<double>::infinity();  // of all runs together
};

struct Cheapest {
  std::optional<CheapRun> run;  // none met the target
  bool complete;                // false: the work was used up before all were tried
};

/// For one model by one integrator, where all are to be compared and the same answer must
/// come on every machine. What beats all others on one machine's clock, robustly, is what
/// cost_of_accuracy's Search looks for.
///
/// The run of least work whose error is at most the target: for every number of elements
/// the longest step that meets it. A number of elements is given up when a step half as
/// long gains less than a fifth of an error near the target (what is left is not of
/// time), or takes more work than the best run so far. Work and not time decides, so that
/// the answer is the same on every machine.
Cheapest cheapest_run(const CheapSearch& search,
                      const std::function<CheapRun(int elements, double dt)>& run);

}  // namespace tress::experiments
