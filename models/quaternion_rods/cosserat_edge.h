#pragma once

#include "contract/layers.h"
#include "math/quaternion.h"

namespace tress::models {

/// Strains of one edge of xpbd_cosserat.cpp over x = (e, q), e from node to node (m):
///
///     R(q)^T e/l - e0,    |q|^2 - 1:
///
/// for stretch, shear along the two axes of the section, and the norm of the quaternion.
/// R is the frame of q/|q|, so norm and shear are independent. A Part of strained.h.
template <class T>
struct CosseratEdgeOf {
  /// Counts of strains, of coordinates in x, and of strains with friction.
  static constexpr int strains = 4, coordinates = 7, with_friction = 0;
  /// Whether the first strain is a length (m).
  static constexpr bool stretch_is_length = false;
  T length;              // l at rest, m
  T stiffness[strains];  // l EA, l k GA twice, l nu (J)
  T friction[strains];   // J s: none

  /// Evaluates the strains at x.
  template <class U>
  void strain(const U* x, U* s) const {
    const QuaternionOf<U> q = load_quaternion(x + 3);
    const U square = dot(q, q);
    store3((U(1) / (U(length) * square)) * axes(q).back(load3(x)), s);
    s[0] = s[0] - U(1);
    s[3] = square - U(1);
  }
  /// (N/D)' = (N' - 2 (N/D) q)/D with D = |q|^2.
  void gradient(const T* x, T (&g)[strains][coordinates]) const {
    const Vec3<T> e = load3(x);
    const QuaternionOf<T> q = load_quaternion(x + 3);
    const T inverse = T(1) / dot(q, q), scale = inverse / length;
    const FrameOf<T> frame = axes(q);
    const Vec3<T> rows[3] = {frame.e0, frame.e1, frame.e2};
    T turned[3], slope[3][4];
    store3((T(2) * inverse) * frame.back(e), turned);
    turned_gradient(e, q, slope);
    for (int k = 0; k < 3; ++k) {
      store3(scale * rows[k], g[k]);
      for (int l = 0; l < 4; ++l) {
        g[k][3 + l] = scale * (slope[k][l] - turned[k] * x[3 + l]);
      }
      g[3][k] = T(0);
    }
    for (int l = 0; l < 4; ++l) g[3][3 + l] = T(2) * x[3 + l];
  }
  /// Returns the pull, J. For q of norm 1, fixed e and d = e/l, the energy is
  ///
  ///     l (kGA |d|^2 - 2 EA d . t + (EA - kGA) (d . t)^2)/2 + const,   t = t(q).
  ///
  /// Its derivative by t at x is -pull. Shear is the same along both axes.
  Vec3<T> pull(const T* x) const {
    const Vec3<T> d = (T(1) / length) * load3(x);
    const T along = dot(d, first_axis(load_quaternion(x + 3)));
    return (stiffness[0] + (stiffness[1] - stiffness[0]) * along) * d;
  }
  /// Adds second derivatives. With f = s . N/D and B the matrix of the form s . N, that
  /// by q is
  ///
  ///     2 (B - f)/D - 2 (q f'^T + f' q^T)/D,
  ///
  /// and that by e and q is f' of a unit vector.
  void add_second(const T* x, const T* stress, T (&h)[coordinates][coordinates]) const {
    const Vec3<T> e = load3(x), s = load3(stress);
    const QuaternionOf<T> q = load_quaternion(x + 3);
    const T inverse = T(1) / dot(q, q), scale = inverse / length;
    const FrameOf<T> frame = axes(q);
    const auto along_stress = [&](const T(&g)[3][4], int l) {
      return s.x * g[0][l] + s.y * g[1][l] + s.z * g[2][l];
    };
    const auto first = [&](const Vec3<T>& edge, T(&f)[4]) {
      T g[3][4];
      turned_gradient(edge, q, g);
      const T turned = T(2) * inverse * dot(s, frame.back(edge));
      for (int l = 0; l < 4; ++l) f[l] = along_stress(g, l) - turned * x[3 + l];
    };
    T by_q[4];
    first(e, by_q);
    const T turned = T(2) * inverse * dot(s, frame.back(e));
    for (int k = 0; k < 4; ++k) {
      T form[3][4];
      turned_gradient(e, unit_quaternion<T>(k), form);
      for (int l = 0; l < 4; ++l) {
        const T product = x[3 + k] * by_q[l] + by_q[k] * x[3 + l];
        h[3 + k][3 + l] += scale * (along_stress(form, l) - (k == l ? turned : T(0)) -
                                    T(2) * inverse * product) +
                           (k == l ? T(2) * stress[3] : T(0));
      }
    }
    for (int k = 0; k < 3; ++k) {
      first({T(k == 0 ? 1 : 0), T(k == 1 ? 1 : 0), T(k == 2 ? 1 : 0)}, by_q);
      for (int l = 0; l < 4; ++l) {
        h[k][3 + l] += scale * by_q[l];
        h[3 + l][k] += scale * by_q[l];
      }
    }
  }

 private:
  /// N = vec(conj(q) e q) = |q|^2 R^T e is a quadratic form of q; dN/dq, linear in both.
  static void turned_gradient(const Vec3<T>& e, const QuaternionOf<T>& q, T (&g)[3][4]) {
    turn_slope(T(-1) * (QuaternionOf<T>{T(0), e} * q), g);
  }
};

/// Edge of one rod.
using CosseratEdge = CosseratEdgeOf<double>;

}  // namespace tress::models
