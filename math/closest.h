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

/// Parameters in [0, 1] of the points of two pieces that are nearest to each other; of
/// parallel ones that overlap, the middle of the overlap.
struct NearestPoints {
  double of_first, of_second;
};
inline NearestPoints nearest(const StraightPiece& first, const StraightPiece& second) {
  constexpr double parallel = 1e-9;  // squared sine of an angle
  const Vec between = second.start - first.start;
  const double a = dot(first.edge, first.edge), e = dot(second.edge, second.edge),
               b = dot(first.edge, second.edge), c = dot(first.edge, between);
  const double determinant = a * e - b * b;
  double s = 0;
  if (determinant > parallel * a * e) {
    s = std::clamp((c * e - b * dot(second.edge, between)) / determinant, 0.0, 1.0);
  } else if (a > 0) {
    const double from = c * first.inverse, to = (c + b) * first.inverse;
    s = 0.5 * (std::clamp(from, 0.0, 1.0) + std::clamp(to, 0.0, 1.0));
  }
  const double t = second.nearest(first.at(s));
  // Where t was clamped, s is not the nearest any more.
  s = determinant > parallel * a * e || t == 0 || t == 1 ? first.nearest(second.at(t))
                                                         : s;
  return {s, t};
}

}  // namespace tress
