#pragma once

#include <cmath>

#include "math/vec3.h"
#include "models/constrained/constraint.h"
#include "models/constrained/joints.h"

namespace tress::models {

/// Fixed angle theta0 at b between u = a - b and v = c - b:
///     C = (cos theta0 - cos theta) / sin theta0,   cos theta = u.v / (|u| |v|),
/// which is theta - theta0 (rad) to first order for any lengths. Regular for theta in
/// (0, pi); at 0 and pi no single equation is regular.
struct Angle {
  static constexpr int node_count = 3;   // number of nodes
  static constexpr int inputs = 9;       // length of z
  static constexpr int rows = 1;         // length of C
  static constexpr bool linear = false;  // whether H = 0
  double cosine, sine;                   // of theta0
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double) const { return 1; }

  /// Evaluates C at z.
  template <class T>
  void value(const T* z, T* c) const {
    using std::sqrt;
    const Vec3<T> u = load3(z) - load3(z + 3);
    const Vec3<T> v = load3(z + 6) - load3(z + 3);
    c[0] = (T(cosine) - dot(u, v) / sqrt(dot(u, u) * dot(v, v))) / T(sine);
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* z, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* z, const double* w, double* h) const;
};

/// Three distances at once (3 rows, m): edges ab, bc, ca.
struct Triangle {
  static constexpr int node_count = 3;   // number of nodes
  static constexpr int inputs = 9;       // length of z
  static constexpr int rows = 3;         // length of C
  static constexpr bool linear = false;  // whether H = 0
  std::array<double, 3> length;          // m
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double) const { return length[0]; }

  /// Evaluates C at z.
  template <class T>
  void value(const T* z, T* c) const {
    for (int k = 0; k < 3; ++k) {
      T d[3];
      store3(load3(z + 3 * k) - load3(z + 3 * ((k + 1) % 3)), d);
      FixedDistance{length[static_cast<std::size_t>(k)]}.value(d, c + k);
    }
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* z, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* z, const double* w, double* h) const;
};

/// Angle (rad, at least 1e-3 away from 0 and pi) at `vertex` between `a` and `c`.
std::unique_ptr<Constraint> angle(Node a, Node vertex, Node c, double theta);
/// Edges ab, bc, ca (m); they must satisfy the strict triangle inequality.
std::unique_ptr<Constraint> rigid_triangle(Node a, Node b, Node c,
                                           std::array<double, 3> edges);

}  // namespace tress::models
