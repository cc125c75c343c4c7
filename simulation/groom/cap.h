#pragma once

#include <vector>

#include "contract/layers.h"
#include "math/vec3.h"

namespace tress::simulation {

/// The part of an ellipsoid x = centre + diag(half) u, |u| = 1, where u is within `angle`
/// (rad, in (0, pi]) of a unit vector.
class Cap {
 public:
  /// Takes lengths in m; `axis` is the unit vector in the space of u.
  Cap(Vec centre, Vec half_axes, Vec axis, double angle);

  double area() const { return area_; }  // m^2, by the midpoint rule

  /// Point of the cap.
  struct Place {
    Vec x, normal;  // point (m), and the unit normal there
  };
  /// Returns a place by shares of area: the share `along` lies nearer to the axis, and
  /// the share `around` of the area equally near lies before the place. Both in [0, 1).
  Place place(double along, double around) const;

 private:
  static constexpr int cells = 256;
  /// u at polar angle and azimuth about the axis.
  Vec unit(double polar, double azimuth) const;
  /// Local ratio of the ellipsoid's area to that of the unit sphere.
  double stretch(const Vec& u) const;

  Vec centre_, half_, axis_, first_, second_;
  double angle_, area_ = 0;
  std::vector<double> below_;   // (cells + 1) area nearer to the axis than each ring
  std::vector<double> before_;  // (cells (cells + 1)) the same within a ring
};

}  // namespace tress::simulation
