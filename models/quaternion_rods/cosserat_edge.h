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
  void add_second(const double* x, const double* stress,
                  double (&h)[coordinates][coordinates]) const;
};

}  // namespace tress::models
