#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "contract/basics.h"
#include "math/vec3.h"

namespace tress::models {

/// Positions and velocities of points, as seen by other strands that do not wait for
/// them.
class PointMotion {
 public:
  /// The points stay; who wants to know where has to ask another.
  void hold() { moves_ = 0; }
  /// Extrapolates uniformly from x (3 each) and v at time t (s).
  void extrapolate(double t, In x, In v);
  /// Interpolates by cubics from (x, v) at t to (y, w) at `end`.
  void interpolate(double t, double end, In x, In v, In y, In w);

  /// Time since the start, 0 for points that stay.
  double elapsed(double t) const { return moves_ * (t - t_); }
  /// Returns the position of a point, m.
  Vec place(std::size_t point, double elapsed) const {
    const Cubic& p = at_[point];
    return p.x + elapsed * (p.v + elapsed * (p.square + elapsed * p.cube));
  }
  /// Returns the velocity of a point, m/s.
  Vec velocity(std::size_t point, double elapsed) const {
    const Cubic& p = at_[point];
    return p.v + elapsed * (2 * p.square + (3 * elapsed) * p.cube);
  }
  /// A bound on how far any point moves in the first `elapsed` seconds, m.
  double range(double elapsed) const;

 private:
  /// x + v s + square s^2 + cube s^3 at s seconds after the start.
  struct Cubic {
    Vec x, v, square, cube;
  };

  double t_ = 0, moves_ = 0;  // moves_: 0 or 1
  std::vector<Cubic> at_;
};

}  // namespace tress::models
