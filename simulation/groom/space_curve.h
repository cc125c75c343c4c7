#pragma once

#include <span>
#include <string>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Smooth curve through points: the cubic spline over the length u of their polyline, and
/// its arc length s. The second derivative is extrapolated linearly from the two inner
/// knots next to an end (not-a-knot), so that the curve keeps its curvature there. For
/// points of a smooth curve at distances h, positions are exact to O(h^4) and the
/// curvature to O(h^2), ends included. Sources: [de Boor 2001, chapter IV] and [Floater &
/// Surazhsky 2006]. Through two points it is straight, through three a parabola, through
/// four one cubic.
class SpaceCurve {
 public:
  /// Points nearer to each other than this are refused, m.
  static constexpr double least_step = 1e-9;

  /// Arc length by Simpson's rule in `fine` parts between two points. Throws InputError
  /// naming `where` on two points of a row that are nearer than least_step.
  SpaceCurve(std::span<const Vec> points, int fine, const std::string& where);

  /// u of each point (m), and the arc length there.
  std::span<const double> knots() const { return knots_; }
  /// Returns the arc length at point i, m.
  double arc_of_point(std::size_t i) const {
    return arc_[i * static_cast<std::size_t>(fine_)];
  }
  /// Returns the length of the curve, m.
  double length() const { return arc_.back(); }
  /// u where the arc length is s; linear within a part.
  double parameter(double s) const;

  /// Returns the position at u.
  Vec position(double u) const;
  /// Returns the derivative dx/du.
  Vec rate(double u) const;
  /// Returns the unit tangent.
  Vec tangent(double u) const;

  /// u and s at the ends of all parts.
  std::span<const double> parameters() const { return u_; }
  /// Returns s at the ends of all parts, m.
  std::span<const double> arcs() const { return arc_; }

 private:
  /// The piece with u, between knots i and i + 1 that are h apart, and how far along.
  struct Piece {
    std::size_t i;
    double h, t;
  };
  Piece piece(double u) const;
  void interpolate(std::span<const Vec> points);

  int fine_;
  std::vector<double> knots_, u_, arc_;
  std::vector<Vec> places_, bends_;  // at the knots: x and d^2x/du^2
};

}  // namespace tress::simulation
