#pragma once

#include <array>
#include <vector>

#include "models/strand/geometry.h"

namespace tress::models {

/// Cubic B-spline r(s) = sum_k N_k(s) P_k, C^2, over given spans (m, arc length at rest)
/// with fourfold end knots: n spans and n + 3 control points. At an end r and r' depend
/// only on the first two control points. Span i uses control points i to i + 3.
class CubicSpline {
 public:
  /// Takes the lengths of the spans, m.
  explicit CubicSpline(const std::vector<double>& spans);

  /// N, N' and N'' (1, 1/m, 1/m^2) of the control points of a span.
  struct Basis {
    /// Values and derivatives of the four functions.
    std::array<double, 4> value, first, second;
  };
  Basis at(std::size_t span, double along) const;  // along: from the span's start, m

  /// Returns the number of spans.
  std::size_t spans() const { return knots_.size() - 1; }
  /// Returns the number of control points.
  std::size_t controls() const { return knots_.size() + 2; }
  /// Returns the length of a span, m.
  double length(std::size_t span) const { return knots_[span + 1] - knots_[span]; }

  /// Control points of the spline through n + 1 places at the knots, with r' of length 1
  /// along the first and the last tangent; error O(h^4).
  std::vector<Vec> through(const std::vector<StrandPlace>& places) const;

 private:
  std::vector<double> knots_;  // without multiplicity
};

}  // namespace tress::models
