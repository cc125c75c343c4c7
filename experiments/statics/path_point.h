#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/statics/path_newton.h"
#include "experiments/statics/stability.h"
#include "experiments/statics/static_strand.h"

namespace tress::experiments::statics {

/// Kind of a point of a path.
enum class Event {
  none,         // an equilibrium between others
  start,        // the first value of the parameter
  limit_point,  // the parameter turns back: no equilibrium near by beyond it
  bifurcation,  // another path crosses, or a second eigenvalue crosses 0
  branch,       // the path leaves a bifurcation along the other branch
  closed,       // the path has come back to its first point on this branch
  end           // the last value of the parameter, or the end of the search
};

/// One equilibrium of a path, verified after it was found.
struct PathPoint {
  Balance at;
  Event event = Event::none;
  Stability stability;
  int crossing = 0;         // number of eigenvalues that cross 0 here
  double arclength = 0;     // from the start, in the metric of EquilibriumPath
  int iterations = 0;       // of Newton's method
  double correction = 0;    // last correction of Newton's method, over typical sizes
  double residual = 0;      // largest |R_i| in the units of residuals
  double gap = 0;           // largest |g_i| over its size
  std::vector<double> x;    // places of the ends of all elements, m
  double energy = 0;        // elastic energy and potential of loads, J
  std::vector<Vec> forces;  // of the supports on the strand, N
  std::string failure;      // why it is no equilibrium; empty: it is verified
};

/// Returns the name of an event; empty for none.
std::string_view name(Event event);

/// Measures a state that Newton's method found, and verifies that it is an equilibrium.
/// `neutral_modes`: as in stability().
PathPoint measured_point(StaticStrand& strand, const Balance& at, const Newton& newton,
                         int neutral_modes);

}  // namespace tress::experiments::statics
