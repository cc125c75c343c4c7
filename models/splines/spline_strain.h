#pragma once

#include "math/dual.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/rod_edge.h"

/// Strains of a span of a spline with material frames at its knots (framed_spline.h),
/// each a Part of strained.h. With - the knot before and + the one behind, the frames are
/// edge_frame (rod_edge.h) of r' and the angle theta at the knot.
namespace tress::models {

/// Returns the number.
inline double value_of(double x) { return x; }
/// Returns the value without derivatives.
template <int n, class T>
double value_of(const Dual<n, T>& x) {
  return value_of(x.value);
}

/// Twist over the span (rad): that of joint_strain.h between the frames of its knots,
/// less `rest`. The whole turns are those that bring it nearest to `near`. x = (r'-,
/// theta-, r'+, theta+).
struct SplineTwist {
  static constexpr int strains = 1, coordinates = 8;  // numbers of both
  const Frame* reference = nullptr;                   // of the knots, two
  /// Coefficients and rest value.
  double stiffness[1] = {}, friction[1] = {}, rest[1] = {};
  double near = 0;  // after the last accepted step

  /// Evaluates the strains at x.
  template <class T>
  void strain(const T* x, T* s) const {
    s[0] = joint_strain(edge_frame(reference[0], load3(x), x[3]),
                        edge_frame(reference[1], load3(x + 4), x[7]))
               .x -
           T(rest[0]);
    const double now = value_of(s[0]);
    s[0] += T(wound(now, near) - now);
  }
  /// Evaluates the first derivatives of the strains by x.
  void gradient(const double* x, double (&g)[1][8]) const;
  /// Adds the second derivatives of the strains, weighted with `stress`.
  void add_second(const double* x, const double* stress, double (&h)[8][8]) const;
};

/// Curvatures (1/m) at a point of the span about the axes e1 and e2, interpolated between
/// those of the knots: with kappa = r' x r''/|r'|^2,
///
///     kappa_j = kappa . ((1 - part) e_j- + part e_j+).
///
/// Rotation about a normal to the curve's plane has no effect, so this is exact for plane
/// bending. Otherwise the error is the squared rotation between the frames. x = (r'-,
/// theta-, r'+, theta+, r', r'').
struct SplineBend {
  static constexpr int strains = 2, coordinates = 14;  // numbers of both
  const Frame* reference = nullptr;                    // of the knots, two
  double part = 0;  // fraction of the span before the point
  /// Coefficients and rest values.
  double stiffness[2] = {}, friction[2] = {}, rest[2] = {};

  /// Evaluates the strains at x.
  template <class T>
  void strain(const T* x, T* s) const {
    const FrameOf<T> before = edge_frame(reference[0], load3(x), x[3]);
    const FrameOf<T> behind = edge_frame(reference[1], load3(x + 4), x[7]);
    const Vec3<T> a = load3(x + 8), b = load3(x + 11);
    const Vec3<T> kappa = (T(1) / dot(a, a)) * cross(a, b);
    s[0] = dot(kappa, T(1 - part) * before.e1 + T(part) * behind.e1) - T(rest[0]);
    s[1] = dot(kappa, T(1 - part) * before.e2 + T(part) * behind.e2) - T(rest[1]);
  }
  /// Evaluates the first derivatives of the strains by x.
  void gradient(const double* x, double (&g)[2][14]) const;
  /// Adds the second derivatives of the strains, weighted with `stress`.
  void add_second(const double* x, const double* stress, double (&h)[14][14]) const;
};

}  // namespace tress::models
