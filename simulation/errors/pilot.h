#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Numbers of elements that keep the tolerances of [strand] tables in motion, found by
/// trial. The scene runs with the numbers for its shapes at rest and with twice these
/// numbers. Where the estimated error in space (error_bars.h) is above a strand's
/// tolerance at some frame, the strand gets more, up to its `elements`.
struct Pilot {
  /// Result for one strand.
  struct OfStrand {
    std::size_t strand;       // index of the strand
    int at_rest, elements;    // elements for its shape at rest, and those it gets
    double tolerance, error;  // m; the error is estimated
  };

  Scene scene;                    // with these elements, and no tolerance
  std::vector<OfStrand> strands;  // results of all strands
  int tries = 0;                  // pairs of runs
  long elements = 0;              // of all their runs
  double wall_s = 0;              // that they took
  std::string
      missing;  // why there is no estimate: a run failed; `scene` is the given one

  /// Returns the strand whose error is largest relative to its tolerance.
  const OfStrand& worst() const;
};

/// Whether a [strand] has a tolerance.
bool wants_pilot(const Scene& scene);

/// Runs the trials. Throws InputError, naming the tolerance, where no estimate is
/// possible. That is the case for models whose points are not compared, and for chaotic
/// motion, which differs from a finer run for every number of elements.
Pilot pilot(const Scene& scene, int threads);

}  // namespace tress::simulation
