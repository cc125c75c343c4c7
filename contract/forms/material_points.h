#pragma once

#include <array>
#include <optional>
#include <span>

#include "contract/basics.h"

namespace tress {

/// Points of the body in space, for output, error norms and effects.
class MaterialPoints {
 public:
  virtual ~MaterialPoints() = default;
  /// Returns the number of points; fixed for life.
  virtual int count() const = 0;
  /// The point that point i is attached to, always an earlier one; -1: none.
  virtual int before(int i) const { return i - 1; }
  /// Computes the positions of all points, (3 count), m.
  virtual void positions(double t, In q, Out x) = 0;
  /// Computes the velocities of all points, (3 count), m/s.
  virtual void velocities(double t, In q, In v, Out u) = 0;
  /// Computes du/dv, (3 count x n) by rows. False: not known in closed form; use mean()
  /// or velocities().
  virtual bool jacobian(double /*t*/, In /*q*/, Out /*j*/) { return false; }
  /// b += J^T f, J = du/dv, of forces f (3 numbers each, N) on ascending points. False:
  /// as jacobian().
  virtual bool pull_back(double /*t*/, In /*q*/, std::span<const int> /*points*/,
                         In /*f*/, InOut /*b*/) {
    return false;
  }
  /// Computes J S^-1 J^T of ascending points at (t, q), where S is that of the last
  /// linearize(). The 3x3 blocks are stored by rows: the response to the force on the
  /// first point comes first, then the second. False: not available; use jacobian() or
  /// mean() and System::solve().
  virtual bool responses(double /*t*/, In /*q*/, std::span<const int> /*points*/,
                         Out /*blocks*/) {
    return false;
  }
  /// Largest |length/rest - 1| over the segments of the body. Empty: not available.
  virtual std::optional<double> stretch(double /*t*/, In /*q*/) { return {}; }

  /// Point i as a mean of coordinates and a prescribed part,
  /// x_i = prescribed(t) + sum_k weight_k (q[c_k], q[c_k + 1], q[c_k + 2]).
  struct Mean {
    int count = 0;                    // number of terms of the sum
    std::array<int, 4> coordinate{};  // c_k
    std::array<double, 4> weight{};   // weights of the terms
  };
  /// Fixed for life. Empty: points are not linear in the coordinates.
  virtual std::optional<Mean> mean(int /*point*/) { return {}; }

  /// Axes e0 (the tangent), e1, e2 of the section at the last point, row by row in world
  /// components; they turn with the material. Empty: the model has no such frame.
  virtual std::optional<std::array<double, 9>> end_frame(double /*t*/, In /*q*/) {
    return {};
  }
};

}  // namespace tress
