#pragma once

#include <cmath>

#include "contract/layers.h"
#include "math/frame.h"
#include "models/maximal/kernel/spring_joint.h"

/// Strains of the springs of a chain of points, each a function of neighbouring edges e
/// (m). `value` is the definition, for any scalar; `gradient` and `hessian` are its
/// closed-form derivatives, those of Hinge and WallBend by the kernel's joint
/// (kernel/spring_joint.h). A strain that is the length of a vector b also has `metric`,
/// J^T J with J = db/de, the second derivative of |b|^2/2 without that of b.
namespace tress::models {

/// A matrix over edges, row-major in blocks of 3 x 3.
template <int edges>
struct EdgeMatrix {
  static constexpr int size = 3 * edges;  // number of rows
  double m[size][size] = {};              // entries

  /// Adds factor times the identity to block (i, j).
  void add_identity(int i, int j, double factor) {
    for (int k = 0; k < 3; ++k) m[3 * i + k][3 * j + k] += factor;
  }
  /// += factor a b^T.
  void add_outer(int i, int j, double factor, const Vec& a, const Vec& b) {
    const double x[3] = {a.x, a.y, a.z}, y[3] = {b.x, b.y, b.z};
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) m[3 * i + k][3 * j + l] += factor * x[k] * y[l];
    }
  }
  /// += factor [a]x in block (i, j) and its transpose in (j, i).
  void add_cross(int i, int j, double factor, const Vec& a) {
    const double h[3][3] = {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        m[3 * i + k][3 * j + l] += factor * h[k][l];
        m[3 * j + l][3 * i + k] += factor * h[k][l];
      }
    }
  }
  /// += factor (a b^T + b a^T)/2 over all edges.
  void add_product(double factor, const Vec* a, const Vec* b) {
    for (int i = 0; i < edges; ++i) {
      for (int j = 0; j < edges; ++j) {
        add_outer(i, j, factor / 2, a[i], b[j]);
        add_outer(i, j, factor / 2, b[i], a[j]);
      }
    }
  }
};

/// Distance between the ends of one edge, or of the chord over two (m): |sum e|.
template <int n>
struct Chord {
  static constexpr int edges = n;  // number of edges that the strain depends on

  /// Returns the sum of the edges.
  template <class T>
  static Vec3<T> chord(const Vec3<T>* e) {
    Vec3<T> d = e[0];
    for (int k = 1; k < n; ++k) d = d + e[k];
    return d;
  }
  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    using std::sqrt;
    const Vec3<T> d = chord(e);
    return sqrt(dot(d, d));
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const {
    const double length = value(e);
    for (int k = 0; k < n; ++k) g[k] = (1 / length) * chord(e);
    return length;
  }
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<n>& h) const {
    const double length = value(e);
    const Vec t = (1 / length) * chord(e);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        h.add_identity(i, j, 1 / length);
        h.add_outer(i, j, -1 / length, t, t);
      }
    }
  }
  /// Evaluates the product of the first derivatives of the vector whose length is the
  /// strain.
  void metric(const Vec*, EdgeMatrix<n>& m) const {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) m.add_identity(i, j, 1);
    }
  }
};

/// Angle between two edges, as the length of the vector (kb, delta). The curvature
/// binormal is kb = 2 e0 x e1/(|e0| |e1| + e0 . e1), so |kb| = 2 tan(angle/2) [Bergou et
/// al. 2008]. Three points do not define the bending direction of a straight joint. |kb|
/// has a kink there, which delta rounds off. Not defined for antiparallel edges.
struct Hinge {
  static constexpr int edges = 2;  // number of edges that the strain depends on
  static constexpr double delta = hinge_delta;  // delta of the formula

  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    using std::sqrt;
    const Vec3<T> x = cross(e[0], e[1]);
    const T c = sqrt(dot(e[0], e[0]) * dot(e[1], e[1])) + dot(e[0], e[1]);
    return sqrt(4.0 * dot(x, x) / (c * c) + T(delta * delta));
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const;
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<2>& h) const;
  /// Evaluates the product of the first derivatives of the vector whose length is the
  /// strain.
  void metric(const Vec* e, EdgeMatrix<2>& m) const;
};

/// Altitude of the tetrahedron of three edges (m): the signed distance between its
/// diagonals e0 + e1 and e1 + e2, the shortest of its seven for a gently bent strand,
///
///     h = e0 . (e1 x e2)/sqrt(|n|^2 + floor),   n = (e0 + e1) x (e1 + e2);
///
/// `floor` (m^4) > 0 keeps it smooth where the diagonals are parallel.
struct Altitude {
  static constexpr int edges = 3;  // number of edges that the strain depends on
  double floor = 0;                // floor, m^4

  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    using std::sqrt;
    const Vec3<T> n = cross(e[0] + e[1], e[1] + e[2]);
    return dot(e[0], cross(e[1], e[2])) / sqrt(dot(n, n) + T(floor));
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const;
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<3>& h) const;
};

/// Altitude with a wall's tangent of length `length` as the first edge.
struct WallAltitude {
  static constexpr int edges = 2;  // number of edges that the strain depends on
  double floor = 0, length = 0;    // floor (m^4), length of the wall's tangent (m)
  Vec wall;                        // tangent of the wall

  /// Takes the direction of the wall from the clamp.
  void place(const Frame& clamp) { wall = length * clamp.e0; }

  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    const Vec3<T> all[3] = {Vec3<T>(wall), e[0], e[1]};
    return Altitude{floor}.value(all);
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const;
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<2>& h) const;
};

/// Curvature binormal between a wall's tangent t and the first edge, along the wall's
/// axis m = e1 or e2: kappa = 2 m . (t x e)/(|e| + t . e).
struct WallBend {
  static constexpr int edges = 1;  // number of edges that the strain depends on
  /// Axis of the wall: `e1` or `e2`.
  enum class About { e1, e2 };
  About about = About::e1;  // axis of the bend
  Vec t, m;                 // tangent and axis of the wall

  /// Takes the direction of the wall from the clamp.
  void place(const Frame& clamp) {
    t = clamp.e0;
    m = about == About::e1 ? clamp.e1 : clamp.e2;
  }

  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    using std::sqrt;
    const Vec3<T> wall(t);
    return 2.0 * dot(Vec3<T>(m), cross(wall, e[0])) /
           (sqrt(dot(e[0], e[0])) + dot(wall, e[0]));
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const;
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<1>& h) const;
};

}  // namespace tress::models
