#pragma once

#include "contract/layers.h"
#include "math/mat3.h"

/// Surfaces of bodies in their own frames, given by the signed distance phi(x) (m, < 0
/// inside), its gradient (of length 1) and its second derivatives. All are finite
/// everywhere: if the nearest point is not unique (centre, axis), one is chosen.
namespace tress::models {

struct Distance {
  double value = 0;  // m
  Vec gradient;
};

/// Everything below z = 0 is inside.
struct Plane {
  Distance distance(const Vec& x) const { return {x.z, {0, 0, 1}}; }
  Mat3 curvature(const Vec&) const { return {}; }
};

struct Sphere {
  double radius;  // m
  Distance distance(const Vec& x) const;
  Mat3 curvature(const Vec& x) const;
};

/// All points within `radius` of the segment |z| <= half_length of the z axis.
struct Capsule {
  double radius;       // m
  double half_length;  // m, without the caps
  Distance distance(const Vec& x) const;
  Mat3 curvature(const Vec& x) const;
};

/// sum (x_i/a_i)^2 <= 1. The nearest point y has x - y = tau grad F(y), so that
///
///     y_i = a_i^2 x_i/(a_i^2 + tau),   g(tau) = sum (a_i x_i/(a_i^2 + tau))^2 - 1 = 0
///
/// with the largest root [Eberly 2013, Distance from a point to an ellipse, an ellipsoid,
/// or a hyperellipsoid, section 2.3]. g is decreasing and convex right of its last pole,
/// and g >= 0 at the largest a_i |x_i| - a_i^2, so Newton's method from there approaches
/// the root monotonically. Then phi = tau |y_i/a_i^2|, free of cancellation, with an
/// error of some eps of the largest axis. With the shape operator S = P diag(1/a^2)
/// P/|y_i/a_i^2| at y, grad grad phi = S (1 + phi S)^-1.
class Ellipsoid {
 public:
  explicit Ellipsoid(const Vec& half_axes) : a_(half_axes) {}  // m, > 0
  const Vec& half_axes() const { return a_; }
  Distance distance(const Vec& x) const;
  Mat3 curvature(const Vec& x) const;
  /// A lower bound of phi outside (m), without the search: |x_i/a_i| is 1 on the surface
  /// and changes per length by at most 1 over the least half axis.
  double at_least(const Vec& x) const;

 private:
  struct Nearest {
    double phi;
    Vec normal;     // of length 1
    double length;  // of y_i/a_i^2
  };
  Nearest nearest(const Vec& x) const;

  Vec a_;
};

}  // namespace tress::models
