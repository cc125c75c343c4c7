#pragma once

#include "models/maximal/spring_strain.h"

/// Angles between neighbouring edges as strains (spring_strain.h).
namespace tress::models {

/// Angle between two edges (rad), 2 atan(h/2) of Hinge's h: rounded off where it is
/// straight, not defined for antiparallel edges.
struct BendAngle {
  static constexpr int edges = 2;  // number of edges that the strain depends on

  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    using std::atan2;
    return T(2) * atan2(Hinge{}.value(e), T(2));
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const;
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<2>& h) const;
};

/// Angle by which edge e2 is turned about e1 out of the plane of e0 and e1 (rad), less
/// `rest`, in (-pi, pi]. With m = e0 x e1 and n = e1 x e2,
///
///     psi = atan2(|e1| e0.n, m.n),   s = (psi - rest) m^2/(m^2 + floor0) n^2/(n^2 +
///     floor1):
///
/// three edges of which two are parallel have no such angle; the floors (m^4) take s to
/// zero there.
struct Dihedral {
  static constexpr int edges = 3;           // number of edges that the strain depends on
  double rest = 0, floor0 = 0, floor1 = 0;  // rest value (rad) and the floors (m^4)

  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    using std::atan2, std::sqrt;
    const Vec3<T> m = cross(e[0], e[1]), n = cross(e[1], e[2]);
    const T sine = sqrt(dot(e[1], e[1])) * dot(e[0], n), cosine = dot(m, n);
    const double c = std::cos(rest), s = std::sin(rest);
    const T mm = dot(m, m), nn = dot(n, n);
    return atan2(T(c) * sine - T(s) * cosine, T(c) * cosine + T(s) * sine) *
           (mm / (mm + T(floor0))) * (nn / (nn + T(floor1)));
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const;
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<3>& h) const;
};

/// Dihedral with a wall's tangent of length `length` as the first edge.
struct WallDihedral {
  static constexpr int edges = 2;  // number of edges that the strain depends on
  Dihedral dihedral;               // angle with the wall as the first edge
  double length = 0;               // length of the wall's tangent, m
  Vec wall;                        // tangent of the wall

  /// Takes the direction of the wall from the clamp.
  void place(const Frame& clamp) { wall = length * clamp.e0; }

  /// Evaluates the strain of the edges e.
  template <class T>
  T value(const Vec3<T>* e) const {
    const Vec3<T> all[3] = {Vec3<T>(wall), e[0], e[1]};
    return dihedral.value(all);
  }
  /// Evaluates the strain and its derivatives by the edges; returns the strain.
  double gradient(const Vec* e, Vec* g) const;
  /// Evaluates the second derivatives by the edges.
  void hessian(const Vec* e, EdgeMatrix<2>& h) const;
};

}  // namespace tress::models
