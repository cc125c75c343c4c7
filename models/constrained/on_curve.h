#pragma once

#include <cmath>

#include "math/vec3.h"
#include "models/constrained/constraint.h"
#include "models/constrained/curve.h"

namespace tress::models {

/// Point on the ellipse with semi-axes a, b along unit vectors e1, e2 (2 rows, m):
///
///     C1 = sqrt(ab)/2 ((y1/a)^2 + (y2/b)^2 - 1),   C2 = y3,   y_i = e_i.d, e3 = e1 x e2.
///
/// For a circle C1 = (y1^2 + y2^2 - r^2)/(2 r), the radial error to first order. On an
/// ellipse |dC1/dx| varies between sqrt(b/a) and sqrt(a/b) but never vanishes.
struct OnEllipse {
  static constexpr int rows = 2;         // length of C
  static constexpr bool linear = false;  // whether H = 0
  Vec e1, e2, e3;                        // axes of the ellipse and their normal
  double a, b;                           // m
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double) const { return std::sqrt(a * b); }

  /// Evaluates C at z.
  template <class T>
  void value(const T* d, T* c) const {
    const T y1 = dot(Vec3<T>(e1), load3(d));
    const T y2 = dot(Vec3<T>(e2), load3(d));
    const double size = std::sqrt(a * b) / 2;
    c[0] = T(size / (a * a)) * y1 * y1 + T(size / (b * b)) * y2 * y2 - T(size);
    c[1] = dot(Vec3<T>(e3), load3(d));
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* d, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* d, const double* w, double* h) const;
};

/// Point on the helix of radius r about e3 that rises by p per radian (2 rows, m):
///     C1 = y1 - r cos(y3/p),   C2 = y2 - r sin(y3/p).
struct OnHelix {
  static constexpr int rows = 2;         // length of C
  static constexpr bool linear = false;  // whether H = 0
  Vec e1, e2, e3;                        // axes of the helix; the last one is its own
  double radius;                         // r, m
  double rise;                           // p, m/rad
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double) const { return radius; }

  /// Evaluates C at z.
  template <class T>
  void value(const T* d, T* c) const {
    using std::cos, std::sin;
    const T w = dot(Vec3<T>(e3), load3(d)) / T(rise);
    c[0] = dot(Vec3<T>(e1), load3(d)) - T(radius) * cos(w);
    c[1] = dot(Vec3<T>(e2), load3(d)) - T(radius) * sin(w);
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* d, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* d, const double* w, double* h) const;
};

/// Point on any curve: C = x - c(s) (3 rows, m) with the curve's parameter s as a
/// massless coordinate. The mass matrix is singular but the KKT matrix is not (c' != 0).
struct OnCurve {
  static constexpr int node_count = 2;   // number of nodes
  static constexpr int inputs = 4;       // length of z
  static constexpr int rows = 3;         // length of C
  static constexpr bool linear = false;  // whether H = 0
  std::shared_ptr<const Curve> curve;    // shape of the curve
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double extent) const { return extent; }

  /// Evaluates C at z.
  void value(const double* z, double* c) const;
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* z, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* z, const double* w, double* h) const;
};

/// x on the ellipse about `centre` with semi-axes a, b (m): orthogonal vectors.
std::unique_ptr<Constraint> point_on_ellipse(Node x, Node centre, Vec a, Vec b);
/// x on centre + a cos s + b sin s + rise s: a, b orthogonal and equally long, rise along
/// a x b.
std::unique_ptr<Constraint> point_on_helix(Node x, Node centre, Vec a, Vec b, Vec rise);
/// x on any curve, with its own parameter node.
std::unique_ptr<Constraint> point_on_curve(Node x, Node parameter,
                                           std::shared_ptr<const Curve> curve);

}  // namespace tress::models
