#pragma once

#include <string>
#include <vector>

#include "contract/basics.h"
#include "contract/forms/material_points.h"

namespace tress::integrators {

/// Size of the difference of two states of a body by its material points: the largest of
/// |dx|/L and |du| sqrt(L/g)/L. L is the longest path along the body and g = 9.81 m/s^2.
class PointNorm {
 public:
  /// L from the points at x (3 per point).
  void start(const MaterialPoints& points, In x);

  double length() const { return length_; }  // m, 0: nothing to measure by
  /// Time (s) in which the body falls about its own size.
  double typical_time() const { return time_; }

  /// Positions x, velocities u against y, w. Infinite if a number is not finite.
  double of(In x, In u, In y, In w);
  /// Names the origin of the last value: "velocity of point 7".
  std::string where() const;

 private:
  void look(In x, In y, double factor, bool velocity);

  double length_ = 0, time_ = 0;
  double value_ = 0;
  std::size_t point_ = 0;
  bool velocity_ = false;
};

}  // namespace tress::integrators
