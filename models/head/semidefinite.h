#pragma once

#include <limits>

#include "math/lane_choice.h"
#include "models/head/point_loads.h"

namespace tress::models {

/// Returns b without its negative eigenvalues, in the lanes where `some` > 0: the nearest
/// positive semidefinite matrix [Higham 1988]. Lanes whose b is definite return b. The
/// iteration count does not depend on the numbers. Let b = q + p c with tr c = 0 and
/// |c|^2 = 6. The eigenvalue of c that is farther from the others, 2 cos(arccos(|det
/// c|/2)/3), comes from three Newton steps. Its vector comes from a cross product [Eberly
/// 2014, A Robust Eigensolver for 3x3 Symmetric Matrices]. In the plane normal to it the
/// other two follow from a square root, and their projection from Cayley and Hamilton.
/// Error: a few eps of the largest entry.
template <class T>
Symmetric3<T> semidefinite(const Symmetric3<T>& b, const T& some) {
  const T o(0), one(1);
  const auto minor = [](const Symmetric3<T>& m) { return m.xx * m.yy - m.xy * m.xy; };
  const auto determinant = [&](const Symmetric3<T>& m) {
    return m.zz * minor(m) + m.yz * (m.xy * m.xz - m.xx * m.yz) +
           m.xz * (m.xy * m.yz - m.xz * m.yy);
  };
  // Least leading minor: positive if definite.
  const T least =
      where_less(o, some, smaller(b.xx, smaller(minor(b), determinant(b))), one);
  constexpr double zero = std::numeric_limits<typename T::Scalar>::min();
  if (!any_less(least, T(zero))) return b;

  const T q = T(1.0 / 3) * (b.xx + b.yy + b.zz);
  const T x = b.xx - q, y = b.yy - q, z = b.zz - q;
  const T square = T(1.0 / 6) * (x * x + y * y + z * z +
                                 T(2) * (b.xy * b.xy + b.xz * b.xz + b.yz * b.yz));
  const T p = square_root(square);
  const T by = where_less(o, p, one, o) / where_less(o, p, p, one);
  const Symmetric3<T> c{by * x, by * y, by * z, by * b.xy, by * b.xz, by * b.yz};
  const T r = T(0.5) * determinant(c), size = smaller(magnitude(r), one);
  // x^3 - 3 x = 2 size, from a parabola through both ends.
  T far = T(1.7320508075688772) + size * (T(0.3215) - T(0.0536) * size);
  for (int k = 0; k < 3; ++k) {
    const T s = far * far;
    far = far - (far * (s - T(3)) - T(2) * size) / (T(3) * (s - one));
  }
  far = where_less(r, o, -far, far);
  // Columns of the adjugate of c - far: multiples of the vector.
  const T cx = c.xx - far, cy = c.yy - far, cz = c.zz - far;
  const T ax = cy * cz - c.yz * c.yz, ay = cx * cz - c.xz * c.xz,
          az = cx * cy - c.xy * c.xy, axy = c.xz * c.yz - c.xy * cz,
          axz = c.xy * c.yz - c.xz * cy, ayz = c.xy * c.xz - c.yz * cx;
  const T sx = magnitude(ax), sy = magnitude(ay), sz = magnitude(az);
  const auto longest = [&](const T& of_x, const T& of_y, const T& of_z) {
    return where_less(sx, larger(sy, sz), where_less(sy, sz, of_z, of_y), of_x);
  };
  Vec3<T> v{longest(ax, axy, axz), longest(axy, ay, ayz), longest(axz, ayz, az)};
  v = (one / square_root(dot(v, v))) * v;

  // b = alone v v + middle (1 - v v) + d, where d has the eigenvalues +apart and -apart.
  const T alone = q + p * far, middle = q - T(0.5) * p * far, both = alone - middle;
  const Vec3<T> w = both * v;
  const Symmetric3<T> d{b.xx - middle - w.x * v.x, b.yy - middle - w.y * v.y,
                        b.zz - middle - w.z * v.z, b.xy - w.x * v.y,
                        b.xz - w.x * v.z,          b.yz - w.y * v.z};
  const T apart = square_root(T(0.5) * (d.xx * d.xx + d.yy * d.yy + d.zz * d.zz) +
                              (d.xy * d.xy + d.xz * d.xz + d.yz * d.yz));
  const T upper = larger(o, middle + apart), lower = middle - apart;
  // Across v, d + middle if both are positive, else the part of the upper one.
  const T kappa =
      where_less(lower, o, upper / where_less(o, apart, T(2) * apart, one), one);
  const T flat = where_less(lower, o, kappa * apart, middle);
  const T along = larger(o, alone) - flat;
  const auto entry = [&](const T& own, const T& project, const T& vi, const T& vj) {
    return kappa * own + project + along * (vi * vj);
  };
  const Symmetric3<T> nearest{entry(d.xx, flat, v.x, v.x), entry(d.yy, flat, v.y, v.y),
                              entry(d.zz, flat, v.z, v.z), entry(d.xy, o, v.x, v.y),
                              entry(d.xz, o, v.x, v.z),    entry(d.yz, o, v.y, v.z)};
  return where_less(o, least, b, nearest);
}

}  // namespace tress::models
