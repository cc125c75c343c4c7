#pragma once

#include <span>
#include <vector>

#include "simulation/run/readout.h"

namespace tress::simulation {

/// Lines drawn as curves through their points x_i instead of polygons. For points evenly
/// spaced on a helix (a super-helix element, a curl, a circle) the curve is that helix.
/// Between x_i and x_{i+1}, with u = 0 .. 1 and h the chord,
///
///     x(u) = (1 - u) x_i + u x_{i+1} - h^2 (w(1 - u) a_i + w(u) a_{i+1})
///     w(u) = (sin(theta u)/sin(theta) - u) / (2 - 2 cos(theta)),  u (1 - u^2)/6 at 0
///
/// where a_i is the second divided difference at x_i, h^2 a_i = x_{i+1} - 2 x_i + x_{i-1}
/// for equal chords. On a helix of theta per element it points to the axis, and x(u) is
/// the interpolant by (1, u, cos, sin)(theta u). The angle theta is determined from the
/// points, as a_{i-1} + a_{i+1} = 2 cos(theta) a_i there, limited to [0, 150 degrees].
///
/// An element is divided into pieces so that no chord is farther from the curve than a
/// thousandth of the line's length, half a pixel if that fills 500 pixels. With k pieces
/// the distance is at most max |x''| / (8 k^2) [error of linear interpolation], and
///
///     |x''| <= h^2 max(|a_i|, |a_{i+1}|) theta^2 / ((2 - 2 cos(theta)) cos(theta/2)),
///
/// since sin(theta (1 - u)) + sin(theta u) <= 2 sin(theta/2). The pieces of an element
/// are the same in all frames, and 32 at most.
class SmoothLines {
 public:
  /// `lines`: number of points of each line, in the order of the frames.
  SmoothLines(std::span<const int> lines, std::span<const Frame3d> frames);

  /// Number of points of each line, including intermediate ones.
  const std::vector<int>& lines() const { return smooth_; }
  /// Returns the number of points of all lines.
  std::size_t points() const { return points_; }
  /// Returns the positions of the drawn points, (3 points), m.
  std::vector<float> positions(const Frame3d& frame) const;
  /// (points) of the first channel, of the second ...; linear between a line's points.
  std::vector<float> channels(const Frame3d& frame) const;

 private:
  void cut(const Frame3d& frame, std::span<const double> longest_error);

  std::vector<int> lines_, smooth_;
  std::vector<int> pieces_;  // of each element, line after line
  std::size_t points_ = 0;
};

}  // namespace tress::simulation
