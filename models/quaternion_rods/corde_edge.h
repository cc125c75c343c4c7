#pragma once

#include <cmath>

#include "contract/layers.h"
#include "math/quaternion.h"

namespace tress::models {

/// Strains of one edge of corde.cpp over x = (e, q), e from node to node (m):
///
///     |e| - l,    e/|e| - t(q),    |q|^2 - 1:
///
/// for stretching, the coupling of quaternion and edge, and the norm of the quaternion.
/// A Part of strained.h.
struct CordeEdge {
  static constexpr int strains = 5, coordinates = 7;
  double length;  // l at rest, m
  /// EA/l (N/m); l kappa three times, l nu (J).
  double stiffness[strains];
  double friction[strains];  // stretch only, N s/m

  template <class T>
  void strain(const T* x, T* s) const {
    using std::sqrt;
    const Vec3<T> e = load3(x);
    const QuaternionOf<T> q = load_quaternion(x + 3);
    const T now = sqrt(dot(e, e));
    s[0] = now - T(length);
    store3((T(1) / now) * e - first_axis(q), s + 1);
    s[4] = dot(q, q) - T(1);
  }
  void gradient(const double* x, double (&g)[strains][coordinates]) const;
  /// J: the energy is const - pull . t(q) for q of norm 1 and fixed e.
  Vec pull(const double* x) const {
    const Vec e = load3(x);
    return (stiffness[1] / norm(e)) * e;
  }
  void add_second(const double* x, const double* stress,
                  double (&h)[coordinates][coordinates]) const;
};

}  // namespace tress::models
