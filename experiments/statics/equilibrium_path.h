#pragma once

#include <functional>
#include <vector>

#include "experiments/statics/path_point.h"
#include "experiments/statics/static_strand.h"

namespace tress::experiments::statics {

/// Options of a path.
struct PathOptions {
  double resolution = 0.04;  // largest step: of the parameter over its range, and of a
                             // place over the length of the strand
  int points = 400;          // largest number of points
  int limit_points = 0;      // number of limit points after which the path ends; 0: none
  int branch = 0;            // bifurcation at which the path leaves along the other
                             // branch, from 1; 0: none; negative: to the other side
  std::function<bool()> over = [] { return false; };  // true: the time is over
};

/// Follows equilibria by continuation with pseudo-arclength [Keller 1977; Riks 1979;
/// Seydel 2010, Practical Bifurcation and Stability Analysis]. The metric of a step is
///
///     ds^2 = sum_i (dq_i/D_i)^2/n + (dp/range)^2,
///
/// with D the typical sizes of the n coordinates and p the parameter. A step predicts
/// along the tangent of the path, then corrects by Newton's method in the plane across
/// the tangent. The matrix with that row is regular at limit points. Neutral modes are
/// left where they are by a row each.
///
/// A limit point lies between two points where dp/ds changes sign, a bifurcation where
/// another eigenvalue does. Both are located on the path by the regula falsi (Illinois).
///
/// The path ends where p leaves the range at its end, or by the length of the range at
/// its beginning. Over supports it ends at the beginning itself, for supports rest before
/// their first row. Where the step vanishes, the last point has the reason.
std::vector<PathPoint> equilibrium_path(StaticStrand& strand, const PathOptions& options);

}  // namespace tress::experiments::statics
