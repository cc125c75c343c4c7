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
struct CosseratEdge {
  static constexpr int strains = 4, coordinates = 7;
  double length;              // l at rest, m
  double stiffness[strains];  // l EA, l k GA twice, l nu (J)
  double friction[strains];   // J s

  template <class T>
  void strain(const T* x, T* s) const {
    const QuaternionOf<T> q = load_quaternion(x + 3);
    const T square = dot(q, q);
    store3((T(1) / (T(length) * square)) * axes(q).back(load3(x)), s);
    s[0] = s[0] - T(1);
    s[3] = square - T(1);
  }
  void gradient(const double* x, double (&g)[strains][coordinates]) const;
  /// J: for q of norm 1, fixed e and d = e/l, the energy is
  /// l (kGA |d|^2 - 2 EA d . t + (EA - kGA) (d . t)^2)/2 + const with t = t(q), whose
  /// derivative by t at x is -pull. Shear is the same along both axes.
  Vec pull(const double* x) const {
    const Vec d = (1 / length) * load3(x);
    const double along = dot(d, first_axis(load_quaternion(x + 3)));
    return (stiffness[0] + (stiffness[1] - stiffness[0]) * along) * d;
  }
  void add_second(const double* x, const double* stress,
                  double (&h)[coordinates][coordinates]) const;
};

}  // namespace tress::models
