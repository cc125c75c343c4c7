#pragma once

#include "simulation/fit/fit_search.h"

namespace tress::simulation {

/// Interval of an unknown u by its profile; NaN: no end.
struct ProfileInterval {
  double low, high;  // ends of the interval, in u
};

/// Asks for the interval of free parameter k of a search that has ended. `half` is half
/// its linear interval, in u. The sum of squares, `least` where the search ended, rises
/// by the square of `deviation` to the ends of the interval.
struct ProfileTask {
  std::size_t k;     // free parameter
  double half;       // half its linear interval, in u
  double least;      // sum of squares where the search ended
  double deviation;  // square root of the rise at the ends of the interval
};

/// Returns where the sum of squares has risen by deviation^2 if parameter k is held there
/// and the others are fitted again [Bates, Watts 1988, Nonlinear Regression Analysis,
/// section 6.1]. Each fit starts from the one before. A bound ends the interval. There is
/// no end where the sum does not rise so far within ten linear intervals, or a run fails.
/// Leaves the search where it was.
ProfileInterval profile_interval(FitSearch& search, const ProfileTask& task);

}  // namespace tress::simulation
