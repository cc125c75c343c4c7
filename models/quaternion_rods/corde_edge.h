#pragma once

#include <type_traits>

#include "contract/layers.h"
#include "math/lane_choice.h"
#include "math/quaternion.h"

namespace tress::models {

/// Strains of one edge of corde.cpp over x = (e, q), e from node to node (m):
///
///     |e| - l,    e/|e| - t(q),    |q|^2 - 1:
///
/// for stretching, the coupling of quaternion and edge, and the norm of the quaternion.
/// A Part of strained.h.
template <class T>
struct CordeEdgeOf {
  /// Counts of strains, of coordinates in x, and of strains with friction.
  static constexpr int strains = 5, coordinates = 7, with_friction = 1;
  /// Whether the first strain is a length (m).
  static constexpr bool stretch_is_length = true;
  T length;  // l at rest, m
  /// EA/l (N/m); l kappa three times, l nu (J).
  T stiffness[strains];
  T friction[strains];  // stretch only, N s/m

  /// Evaluates the strains at x.
  template <class U>
  void strain(const U* x, U* s) const {
    const Vec3<U> e = load3(x);
    const QuaternionOf<U> q = load_quaternion(x + 3);
    const U now = root(dot(e, e));
    s[0] = now - U(length);
    store3((U(1) / now) * e - first_axis(q), s + 1);
    s[4] = dot(q, q) - U(1);
  }
  /// Computes the gradients of the strains. With t = e/|e|, dt/de = (1 - t t^T)/|e|.
  void gradient(const T* x, T (&g)[strains][coordinates]) const {
    const Edge e(x);
    T t[3], slope[3][4];
    store3(e.t, t);
    axis_gradient(load_quaternion(x + 3), slope);
    for (int k = 0; k < 3; ++k) {
      g[0][k] = t[k];
      g[4][k] = T(0);
      for (int l = 0; l < 3; ++l) {
        g[1 + k][l] = (T(k == l ? 1 : 0) - t[k] * t[l]) * e.inverse;
      }
    }
    for (int l = 0; l < 4; ++l) {
      g[0][3 + l] = T(0);
      for (int k = 0; k < 3; ++k) g[1 + k][3 + l] = -slope[k][l];
      g[4][3 + l] = T(2) * x[3 + l];
    }
  }
  /// Computes the slopes of the rate of stretch.
  void slope_of_speed(const T* x, const T* rate,
                      T (&g)[with_friction][coordinates]) const {
    const Edge e(x);
    const Vec3<T> u = load3(rate);
    store3(e.inverse * (u - dot(u, e.t) * e.t), g[0]);
    for (int l = 3; l < coordinates; ++l) g[0][l] = T(0);
  }
  /// J: the energy is const - pull . t(q) for q of norm 1 and fixed e.
  Vec3<T> pull(const T* x) const { return (stiffness[1] * Edge(x).inverse) * load3(x); }
  /// Adds second derivatives. With P = 1 - t t^T, s . t has the second derivative -(P s
  /// t^T + t (P s)^T + (s . t) P)/|e|^2. That of s . t(q) is twice the matrix of a
  /// quadratic form.
  void add_second(const T* x, const T* stress, T (&h)[coordinates][coordinates]) const {
    const Edge e(x);
    const Vec3<T> s = load3(stress + 1);
    const T along = dot(s, e.t), bent = e.inverse * e.inverse;
    T t[3], off[3];
    store3(e.t, t);
    store3(s - along * e.t, off);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        const T across = T(k == l ? 1 : 0) - t[k] * t[l];
        h[k][l] += stress[0] * e.inverse * across -
                   (off[k] * t[l] + t[k] * off[l] + along * across) * bent;
      }
    }
    for (int k = 0; k < 4; ++k) {
      T slope[3][4];
      axis_gradient(unit_quaternion<T>(k), slope);
      for (int l = 0; l < 4; ++l) {
        const T form = s.x * slope[0][l] + s.y * slope[1][l] + s.z * slope[2][l];
        h[3 + k][3 + l] += (k == l ? T(2) * stress[4] : T(0)) - form;
      }
    }
  }

 private:
  /// Returns the square root, also of dual numbers.
  template <class U>
  static U root(const U& x) {
    if constexpr (std::is_same_v<U, T>) {
      return square_root(x);
    } else {
      return sqrt(x);
    }
  }
  struct Edge {
    explicit Edge(const T* x) {
      const Vec3<T> e = load3(x);
      inverse = T(1) / root(dot(e, e));
      t = inverse * e;
    }
    T inverse;  // 1/|e|
    Vec3<T> t;
  };
};

/// Edge of one rod.
using CordeEdge = CordeEdgeOf<double>;

}  // namespace tress::models
