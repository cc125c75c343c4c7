#pragma once

#include <algorithm>

/// When Newton's iterations go on and end, of one strand (integrators/stage/stage.h) and
/// of strands in lanes (integrators/block/newton_course.h).
namespace tress::integrators {

/// After this many growing corrections the iteration counts as not converging.
inline constexpr int most_grown = 2;

/// Factor on the allowed number of corrections when they are damped, since these are
/// smaller. A fraction of a correction below the shortest makes no progress.
inline constexpr int damped_patience = 3;
/// Shortest part of a damped correction that is tried.
inline constexpr double shortest_damped = 1e-4;

/// Whether a part of a correction of a size is good enough: the next one with the same
/// matrix must be smaller [Deuflhard 2011, section 3.3].
inline bool shrinks_enough(double next, double part, double size) {
  return next <= (1 - part / 4) * size;
}

/// Tolerances of Newton's method, and the decision after each correction.
struct NewtonRules {
  double tolerance;  // of a correction
  double left;       // of the error, by the rate at which corrections shrink
  double rounding;   // below it corrections that stop shrinking are rounding errors

  /// Margin of a tolerance without a margin of its own: the error left is a tenth of the
  /// tolerance.
  static constexpr double margin = 0.1;

  /// `left`: the part of the tolerance that may be left. Numbers resolve corrections of a
  /// size `resolved` only.
  static NewtonRules of(double tolerance, double left, double resolved = 0) {
    const double seen = std::max(tolerance, resolved / 2);
    return {seen, left * seen,
            std::max({tolerance, std::min(stagnation * tolerance, largest_rounding),
                      4 * resolved})};
  }

  /// The error that a correction of this size leaves if the next ones shrink at this
  /// rate: the sum of those.
  static double error_left(double size, double rate) { return size * rate / (1 - rate); }
  /// Tests whether a correction stagnates: `done` others came before, the last one
  /// smaller by 1/`rate`.
  bool stagnates(double size, double rate, int done) const {
    return rate > 0.5 && done >= 2 && size <= rounding;
  }

 private:
  // Corrections that stop shrinking are rounding errors within this factor of a tight
  // tolerance, and below this size under a loose one.
  static constexpr double stagnation = 1e4, largest_rounding = 1e-6;
};

}  // namespace tress::integrators
