#pragma once

#include "math/matrix3.h"

/// Operations of this folder's kernels on 3 x 3 matrices beyond math/matrix3.h.
namespace tress::models {

/// s += w x x^T.
template <class T>
void add_square(Symmetric3<T>& s, const T& w, const Vec3<T>& x) {
  const Vec3<T> y = w * x;
  s.xx += y.x * x.x;
  s.yy += y.y * x.y;
  s.zz += y.z * x.z;
  s.xy += y.x * x.y;
  s.xz += y.x * x.z;
  s.yz += y.y * x.z;
}
/// s += w (x y^T + y x^T)/2.
template <class T>
void add_product(Symmetric3<T>& s, const T& w, const Vec3<T>& x, const Vec3<T>& y) {
  const Vec3<T> z = (T(0.5) * w) * x;
  s.xx += T(2) * z.x * y.x;
  s.yy += T(2) * z.y * y.y;
  s.zz += T(2) * z.z * y.z;
  s.xy += z.x * y.y + z.y * y.x;
  s.xz += z.x * y.z + z.z * y.x;
  s.yz += z.y * y.z + z.z * y.y;
}
/// Returns s - w x x^T.
template <class T>
Symmetric3<T> less_square(const Symmetric3<T>& s, const T& w, const Vec3<T>& x) {
  Symmetric3<T> all = s;
  add_square(all, -w, x);
  return all;
}

/// Takes no notice of pivots. The System of one strand has Pivots that do
/// (strand_elimination.h): it can solve its equations in another way.
struct AnyPivots {
  /// Accepts the pivot.
  template <class T>
  void operator()(const T& /*pivot*/, const T& /*entries*/) const {}
};

/// The pivots of inverse().
template <class T, class Pivots>
void check(const Matrix3<T>& m, Pivots&& pivots) {
  const Vec3<T> minors = cross(m.row[1], m.row[2]);
  pivots(minors.x, m.row[1].y * m.row[2].z);
  pivots(dot(m.row[0], minors), m.row[0].x * minors.x);
}

}  // namespace tress::models
