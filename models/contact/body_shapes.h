#pragma once

#include <limits>

#include "contract/layers.h"
#include "math/lane_choice.h"
#include "math/lanes.h"
#include "math/mat3.h"

/// Surfaces of bodies in their own frames, given by the signed distance phi(x) (m, < 0
/// inside), its gradient (of length 1) and its second derivatives. All are finite
/// everywhere: if the nearest point is not unique (centre, axis), one is chosen. Over
/// doubles, or packs of one place a lane; a lane's result does not depend on the others.
namespace tress::models {

/// Signed distance to the surface, negative inside, and its gradient.
template <class T>
struct DistanceOf {
  T value{};         // m
  Vec3<T> gradient;  // derivative by the place, of length 1
};
/// Distance of one place.
using Distance = DistanceOf<double>;

/// Result of a search for the nearest point.
template <class T>
struct NearestOf {
  DistanceOf<T> to;  // distance to the nearest point
  T length{};        // of an ellipsoid, of y_i/a_i^2
};

/// Functions of all shapes that follow from nearest() and curvature(x, nearest(x)).
template <class Shape>
struct DistanceByNearest {
  /// Returns the distance of a place, m.
  Distance distance(const Vec& x) const { return self().nearest(x).to; }
  /// Returns the second derivatives of the distance at a place, 1/m.
  Mat3 curvature(const Vec& x) const { return self().curvature(x, self().nearest(x)); }

 private:
  const Shape& self() const { return static_cast<const Shape&>(*this); }
};

/// The distance from a point, and upwards at the point itself.
template <class T>
NearestOf<T> around_point(const Vec3<T>& arm, double radius) {
  const T r = square_root(dot(arm, arm)), o(0);
  const T by = T(1) / where_less(o, r, r, T(1));
  return {{r - T(radius), {by * arm.x, by * arm.y, where_less(o, r, by * arm.z, T(1))}}};
}
/// Returns the second derivatives of the distance to a ball of this radius.
template <class T>
Mat3Of<T> curvature_around_point(const NearestOf<T>& at, double radius) {
  const T r = at.to.value + T(radius), o(0);
  const T by = where_less(o, r, T(1), o) / where_less(o, r, r, T(1));
  return by * (identity<T>() - outer(at.to.gradient, at.to.gradient));
}

/// Everything below z = 0 is inside.
struct Plane : DistanceByNearest<Plane> {
  /// Curvature at a place.
  using DistanceByNearest::curvature;
  /// Finds the nearest point.
  template <class T>
  NearestOf<T> nearest(const Vec3<T>& x) const {
    return {{x.z, {T(0), T(0), T(1)}}};
  }
  /// Returns 0: the plane is flat.
  template <class T>
  Mat3Of<T> curvature(const Vec3<T>&, const NearestOf<T>&) const {
    return {};
  }
};

/// All points within `radius` of the origin.
struct Sphere : DistanceByNearest<Sphere> {
  double radius;  // m

  /// Makes a sphere of this radius, m.
  explicit Sphere(double r) : radius(r) {}
  /// Curvature at a place.
  using DistanceByNearest::curvature;
  /// Finds the nearest point.
  template <class T>
  NearestOf<T> nearest(const Vec3<T>& x) const {
    return around_point(x, radius);
  }
  /// Returns the second derivatives of the distance, 1/m.
  template <class T>
  Mat3Of<T> curvature(const Vec3<T>&, const NearestOf<T>& at) const {
    return curvature_around_point(at, radius);
  }
};

/// All points within `radius` of the segment |z| <= half_length of the z axis.
struct Capsule : DistanceByNearest<Capsule> {
  double radius;       // m
  double half_length;  // m, without the caps

  /// Makes a capsule of this radius and half length, m.
  Capsule(double r, double half) : radius(r), half_length(half) {}
  /// Curvature at a place.
  using DistanceByNearest::curvature;
  /// Finds the nearest point.
  template <class T>
  NearestOf<T> nearest(const Vec3<T>& x) const {
    // From the nearest point of the axis.
    const T end(half_length);
    const Vec3<T> arm{x.x, x.y, x.z - larger(-end, smaller(x.z, end))};
    NearestOf<T> at = around_point(arm, radius);
    const T o(0), off = dot(arm, arm);  // on the axis, sideways
    at.to.gradient.x = where_less(o, off, at.to.gradient.x, T(1));
    at.to.gradient.z = where_less(o, off, at.to.gradient.z, o);
    return at;
  }
  /// Returns the second derivatives of the distance, 1/m.
  template <class T>
  Mat3Of<T> curvature(const Vec3<T>& x, const NearestOf<T>& at) const {
    Mat3Of<T> all = curvature_around_point(at, radius);
    const T end(half_length), o(0), height = magnitude(x.z);
    for (T* along : {&all.r0.z, &all.r1.z, &all.r2.x, &all.r2.y, &all.r2.z}) {
      *along = where_less(end, height, *along, o);  // none along the axis
    }
    return all;
  }
};

/// Ellipsoid sum (x_i/a_i)^2 <= 1. The nearest point y has x - y = tau grad F(y), so that
///
///     y_i = a_i^2 x_i/(a_i^2 + tau),   g(tau) = sum (a_i x_i/(a_i^2 + tau))^2 - 1 = 0
///
/// with the largest root [Eberly 2013, Distance from a point to an ellipse, an ellipsoid,
/// or a hyperellipsoid, section 2.3]. g is decreasing and convex right of its last pole.
/// At the largest a_i |x_i| - a_i^2, g >= 0, so Newton's method from there approaches the
/// root monotonically. Then phi = tau |y_i/a_i^2|, free of cancellation, with an error of
/// a few eps of the largest axis. With the shape operator S = P diag(1/a^2) P/|y_i/a_i^2|
/// at y, grad grad phi = S (1 + phi S)^-1.
///
/// Packs take a few Newton steps from tau = 0, the root on the surface. Lanes far from
/// the surface, which need more steps, are searched one by one.
class Ellipsoid : public DistanceByNearest<Ellipsoid> {
 public:
  /// Constructs an ellipsoid with these half axes, m, > 0.
  explicit Ellipsoid(const Vec& half_axes);
  /// Returns the half axes, m.
  const Vec& half_axes() const { return a_; }

  /// Curvature at a place.
  using DistanceByNearest::curvature;
  /// Finds the nearest point.
  NearestOf<double> nearest(const Vec& x) const;
  /// Finds the nearest points of a pack of places.
  template <class Number, int width>
  NearestOf<PackOf<Number, width>> nearest(const Vec3<PackOf<Number, width>>& x) const;
  /// Returns the second derivatives of the distance, 1/m.
  template <class T>
  Mat3Of<T> curvature(const Vec3<T>& x, const NearestOf<T>& at) const;
  /// A lower bound of phi outside (m), without the search: |x_i/a_i| is 1 on the surface
  /// and changes per length by at most 1 over the least half axis.
  template <class T>
  T at_least(const Vec3<T>& x) const {
    return T(least_) * (size(x) - T(1));
  }
  /// Returns the lower bound of phi with its gradient.
  template <class T>
  DistanceOf<T> below(const Vec3<T>& x) const {
    const T r = size(x), by = T(least_) / where_less(T(0), r, r, T(1));
    return {
        T(least_) * (r - T(1)),
        {(by * T(inverse_.x * inverse_.x)) * x.x, (by * T(inverse_.y * inverse_.y)) * x.y,
         (by * T(inverse_.z * inverse_.z)) * x.z}};
  }

 private:
  template <class T>
  T size(const Vec3<T>& x) const {  // |x_i/a_i|
    const Vec3<T> scaled{T(inverse_.x) * x.x, T(inverse_.y) * x.y, T(inverse_.z) * x.z};
    return square_root(dot(scaled, scaled));
  }

  Vec a_, inverse_;  // half axes, 1 over them
  double least_;     // of them
  Vec above_;        // a_i^2 - least^2 >= 0
};

template <class Number, int width>
NearestOf<PackOf<Number, width>> Ellipsoid::nearest(
    const Vec3<PackOf<Number, width>>& x) const {
  using T = PackOf<Number, width>;
  constexpr int steps = 4;
  // A step so short leaves an error of its square.
  constexpr double short_step = sizeof(Number) == sizeof(double) ? 1e-9 : 1e-5;
  const T shift(least_ * least_);
  const Vec3<T> above(above_);
  const Vec3<T> ax{T(a_.x) * x.x, T(a_.y) * x.y, T(a_.z) * x.z};
  // s = tau + shift, and a bound of its root from below.
  const T bound = larger(larger(magnitude(ax.x) - above.x, magnitude(ax.y) - above.y),
                         magnitude(ax.z) - above.z);
  T s = larger(shift, bound), step(0);
  Vec3<T> by;
  for (int k = 0; k <= steps; ++k) {
    const Vec3<T> d{s + above.x, s + above.y, s + above.z};
    const T xy = d.x * d.y, inverse = T(1) / (xy * d.z);
    by = {inverse * (d.y * d.z), inverse * (d.x * d.z), inverse * xy};
    if (k == steps) break;
    const Vec3<T> ratio{ax.x * by.x, ax.y * by.y, ax.z * by.z};
    const Vec3<T> square{ratio.x * ratio.x, ratio.y * ratio.y, ratio.z * ratio.z};
    const T g = square.x + square.y + square.z - T(1), slope = dot(square, by);
    const T next = larger(s + T(0.5) * g / slope, bound);
    step = magnitude(next - s);
    s = next;
  }
  const Vec3<T> n{x.x * by.x, x.y * by.y, x.z * by.z};
  const T length = square_root(dot(n, n));
  NearestOf<T> at{{(s - shift) * length, (T(1) / length) * n}, length};
  const T enough = T(short_step) * s;
  if (all_up_to(step - enough, 0)) return at;
  for (int lane = 0; lane < width; ++lane) {
    if (step[lane] <= enough[lane]) continue;
    const NearestOf<double> one = nearest(lane_of(x, lane));
    set_lane(at.to.value, lane, one.to.value);
    set_lane(at.to.gradient, lane, one.to.gradient);
    set_lane(at.length, lane, one.length);
  }
  return at;
}

template <class T>
Mat3Of<T> Ellipsoid::curvature(const Vec3<T>& /*x*/, const NearestOf<T>& at) const {
  const Vec3<T>& n = at.to.gradient;
  const T& phi = at.to.value;
  const Vec3<T> k{T(inverse_.x * inverse_.x), T(inverse_.y * inverse_.y),
                  T(inverse_.z * inverse_.z)};
  // P diag(k) P, P = 1 - n n^T.
  const Vec3<T> kn{k.x * n.x, k.y * n.y, k.z * n.z};
  const T along = dot(n, kn), by = T(1) / at.length;
  const Vec3<T> half = kn - (T(0.5) * along) * n;
  const auto entry = [&](const T& ni, const T& hi, const T& nj, const T& hj) {
    return -(ni * hj + hi * nj);
  };
  const T xx = by * (k.x + entry(n.x, half.x, n.x, half.x)),
          yy = by * (k.y + entry(n.y, half.y, n.y, half.y)),
          zz = by * (k.z + entry(n.z, half.z, n.z, half.z)),
          xy = by * entry(n.x, half.x, n.y, half.y),
          xz = by * entry(n.x, half.x, n.z, half.z),
          yz = by * entry(n.y, half.y, n.z, half.z);
  // S (1 + phi S)^-1 in the tangent plane by Cayley and Hamilton; the denominator is 0 on
  // focal lines, where the derivative does not exist.
  const T mean = xx + yy + zz;
  const T square = xx * xx + yy * yy + zz * zz + T(2) * (xy * xy + xz * xz + yz * yz);
  const T gauss = T(0.5) * (mean * mean - square);
  const T under = T(1) / larger(T(1) + phi * (mean + phi * gauss), T(1e-12));
  const T more = phi * gauss;
  const auto all = [&](const T& own, const T& ni, const T& nj, double same) {
    return under * (own + more * (T(same) - ni * nj));
  };
  const T a = all(xy, n.x, n.y, 0), b = all(xz, n.x, n.z, 0), c = all(yz, n.y, n.z, 0);
  return {{all(xx, n.x, n.x, 1), a, b},
          {a, all(yy, n.y, n.y, 1), c},
          {b, c, all(zz, n.z, n.z, 1)}};
}

/// Returns a lower bound of the distance where it is positive, without a search: a convex
/// function with a gradient of length 1 at most. Where the distance needs no search, the
/// bound is the distance itself. All shapes but grids are convex.
template <class T, class Shape>
DistanceOf<T> below(const Shape& shape, const Vec3<T>& x) {
  if constexpr (requires { shape.below(x); }) {
    return shape.below(x);
  } else {
    return shape.nearest(x).to;
  }
}

}  // namespace tress::models
