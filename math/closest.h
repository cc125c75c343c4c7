#pragma once

#include <algorithm>

#include "math/vec3.h"

namespace tress {

/// A straight segment from `start` to start + edge.
struct StraightPiece {
  Vec start, edge;
  double inverse = 0;  // 1/|edge|^2; 0 for zero length: the segment is its start

  StraightPiece() = default;
  StraightPiece(const Vec& from, const Vec& to) : start(from), edge(to - from) {
    const double square = dot(edge, edge);
    inverse = square > 0 ? 1 / square : 0;
  }

  Vec at(double s) const { return start + s * edge; }
  /// Parameter in [0, 1] of the point nearest to x.
  double nearest(const Vec& x) const {
    // Two instructions without a branch, where std::clamp has two branches.
    return std::max(0.0, std::min(1.0, inverse * dot(x - start, edge)));
  }
};

}  // namespace tress
