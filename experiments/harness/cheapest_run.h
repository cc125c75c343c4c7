#pragma once

#include <functional>
#include <optional>
#include <span>

#include "experiments/harness/tip_track.h"

namespace tress {

/// One way to meet a wanted error.
struct CheapRun {
  int elements;
  double dt;      // s
  double error;   // of the tip, tip_error
  double wall_s;  // of that one run
};

struct CheapSearch {
  double target;  // of the error
  std::span<const int> elements;
  double coarsest, finest;  // s, steps tried, each half the one before
};

/// The cheapest run whose error is at most the target: for every number of elements the
/// longest step that meets it. A number of elements is given up when a step half as long
/// gains less than a fifth of an error near the target (what is left is not of time),
/// costs more than the cheapest run so far, or `stop` says so. Nothing when none meets
/// it.
///
/// `run(elements, dt)`: a run with its error and its wall time; no value when it fails.
std::optional<CheapRun> cheapest_run(
    const CheapSearch& search,
    const std::function<std::optional<CheapRun>(int elements, double dt)>& run,
    const std::function<bool()>& stop);

}  // namespace tress
