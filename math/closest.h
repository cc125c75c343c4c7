#pragma once

#include <algorithm>
#include <array>

#include "math/vec3.h"

namespace tress {

/// A straight segment from `start` to start + edge.
struct StraightPiece {
  Vec start, edge;     // one end, and the vector from there to the other
  double inverse = 0;  // 1/|edge|^2; 0 for zero length: the segment is its start

  StraightPiece() = default;
  /// Makes the segment between two points.
  StraightPiece(const Vec& from, const Vec& to) : start(from), edge(to - from) {
    const double square = dot(edge, edge);
    inverse = square > 0 ? 1 / square : 0;
  }

  /// Returns the point at the parameter s, 0 at the start and 1 at the other end.
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
  double of_first, of_second;  // parameters of the two points
};
/// Finds the points of two segments that are nearest to each other.
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

/// Weights (>= 0, sum 1) of the corners of a triangle in its point nearest to x [Ericson
/// 2005, section 5.1.5]. One without area counts as its edges.
inline std::array<double, 3> nearest(const std::array<Vec, 3>& corner, const Vec& x) {
  const Vec ab = corner[1] - corner[0], ac = corner[2] - corner[0];
  const Vec ax = x - corner[0], bx = x - corner[1], cx = x - corner[2];
  const double d1 = dot(ab, ax), d2 = dot(ac, ax);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, bx), d4 = dot(ac, bx);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double of_c = d1 * d4 - d3 * d2;
  if (of_c <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = dot(ab, cx), d6 = dot(ac, cx);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double of_b = d5 * d2 - d1 * d6;
  if (of_b <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double of_a = d3 * d6 - d5 * d4;
  const double from_b = d4 - d3, from_c = d5 - d6;
  if (of_a <= 0 && from_b >= 0 && from_c >= 0) {
    const double s = from_b / (from_b + from_c);
    return {0, 1 - s, s};
  }
  const double sum = of_a + of_b + of_c;
  return {1 - (of_b + of_c) / sum, of_b / sum, of_c / sum};
}

}  // namespace tress
