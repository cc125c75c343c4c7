#pragma once

#include "math/vec3.h"
#include "models/constrained/constraint.h"

namespace tress::models {

/// C = d (3 rows, m).
struct Coincidence {
  static constexpr int rows = 3;        // length of C
  static constexpr bool linear = true;  // whether H = 0
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double extent) const { return extent; }

  /// Evaluates C at z.
  template <class T>
  void value(const T* d, T* c) const {
    for (int k = 0; k < 3; ++k) c[k] = d[k];
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* d, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* d, const double* w, double* h) const;
};

/// C = (|d|^2 - l^2) / (2 l) (m): the length error to first order, without square root.
struct FixedDistance {
  static constexpr int rows = 1;         // length of C
  static constexpr bool linear = false;  // whether H = 0
  double length;                         // l, m
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double) const { return length; }

  /// Evaluates C at z.
  template <class T>
  void value(const T* d, T* c) const {
    const T two_l(2 * length);
    c[0] = (dot(load3(d), load3(d)) - T(length * length)) / two_l;
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* d, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* d, const double* w, double* h) const;
};

/// C = normal.d (m), with a unit normal.
struct OnPlane {
  static constexpr int rows = 1;        // length of C
  static constexpr bool linear = true;  // whether H = 0
  Vec normal;                           // unit normal
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double extent) const { return extent; }

  /// Evaluates C at z.
  template <class T>
  void value(const T* d, T* c) const {
    c[0] = dot(Vec3<T>(normal), load3(d));
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* d, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* d, const double* w, double* h) const;
};

/// C = (x - b).(c - b)/l (m): 0 if x - b is orthogonal to c - b. For l = |c - b|, C is
/// the component of x - b along c - b.
struct Across {
  static constexpr int node_count = 3;   // x, b, c
  static constexpr int inputs = 9;       // length of z
  static constexpr int rows = 1;         // length of C
  static constexpr bool linear = false;  // whether H = 0
  double length;                         // l, m
  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double extent) const { return extent; }

  /// Evaluates C at z.
  template <class T>
  void value(const T* z, T* c) const {
    c[0] = dot(load3(z) - load3(z + 3), load3(z + 6) - load3(z + 3)) / T(length);
  }
  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* z, double* g) const;
  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* z, const double* w, double* h) const;
};

/// Holds point x at `where`: an anchor (fixed or moving) or another particle.
std::unique_ptr<Constraint> fixed_point(Node x, Node where);
/// |a - b| = length (m, > 0). Either end may be an anchor.
std::unique_ptr<Constraint> distance(Node a, Node b, double length);
/// x - vertex orthogonal to c - vertex, which is about `length` (m, > 0) long.
std::unique_ptr<Constraint> across(Node x, Node vertex, Node c, double length);
/// normal.(x - origin) = 0; the normal is normalised here.
std::unique_ptr<Constraint> point_on_plane(Node x, Node origin, Vec normal);

}  // namespace tress::models
