#pragma once

#include <array>
#include <optional>

#include "math/closest.h"

namespace tress::models {

/// Two straight pieces, x_0 x_1 and x_2 x_3, whose ends move straight on during a step.
struct MovingPieces {
  std::array<Vec, 4> from, to;  // m
};

/// Contact points of two pieces, and the direction from the second to the first one
/// there.
struct PieceTouch {
  double s, t;  // of the first, of the second piece, in [0, 1]
  Vec normal;   // of length 1

  /// Weights of the four ends in the vector from the second to the first point.
  std::array<double, 4> weights() const { return {1 - s, s, t - 1, -t}; }
};

/// Between pieces with these ends, m.
double distance(const std::array<Vec, 4>& ends);

/// Returns the points where the pieces are first nearer to each other than `reach` in the
/// step, or those at its end. Advances by steps in which they cannot come so near
/// [Mirtich 1996, conservative advancement].
PieceTouch first_touch(const MovingPieces& pieces, double reach);

/// Returns the place and the side of origin if one piece passes through the other during
/// the step. Axes without thickness that cross are coplanar at that time, which is a root
/// of a cubic polynomial [Provot 1997]. Otherwise returns the nearest points at the end
/// of the step, if they are closer than `reach`. Empty: neither.
std::optional<PieceTouch> touch(const MovingPieces& pieces, double reach);

}  // namespace tress::models
