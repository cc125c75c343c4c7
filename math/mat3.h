#pragma once

#include "math/frame.h"
#include "math/vec3.h"

namespace tress {

/// A 3x3 matrix over any scalar, stored by rows.
template <class T>
struct Mat3Of {
  Vec3<T> r0, r1, r2;  // rows

  friend constexpr Mat3Of operator+(const Mat3Of& a, const Mat3Of& b) {
    return {a.r0 + b.r0, a.r1 + b.r1, a.r2 + b.r2};
  }
  friend constexpr Mat3Of operator-(const Mat3Of& a, const Mat3Of& b) {
    return {a.r0 - b.r0, a.r1 - b.r1, a.r2 - b.r2};
  }
  friend constexpr Mat3Of operator*(const T& s, const Mat3Of& a) {
    return {s * a.r0, s * a.r1, s * a.r2};
  }
  friend constexpr Vec3<T> operator*(const Mat3Of& a, const Vec3<T>& x) {
    return {dot(a.r0, x), dot(a.r1, x), dot(a.r2, x)};
  }
  /// Returns the product x^T a.
  friend constexpr Vec3<T> operator*(const Vec3<T>& x, const Mat3Of& a) {
    return x.x * a.r0 + x.y * a.r1 + x.z * a.r2;
  }
  friend constexpr Mat3Of operator*(const Mat3Of& a, const Mat3Of& b) {
    return {a.r0 * b, a.r1 * b, a.r2 * b};
  }
};
/// Matrix in double precision.
using Mat3 = Mat3Of<double>;

/// Returns the diagonal matrix of these entries.
constexpr Mat3 diagonal(const Vec& d) { return {{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}; }
/// Returns the identity matrix.
template <class T = double>
constexpr Mat3Of<T> identity() {
  return {{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}};
}
/// Returns the sum of the diagonal entries.
template <class T>
constexpr T trace(const Mat3Of<T>& a) {
  return a.r0.x + a.r1.y + a.r2.z;
}

/// a b^T
template <class T>
constexpr Mat3Of<T> outer(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x * b, a.y * b, a.z * b};
}
/// cross_matrix(w) x = w cross x
constexpr Mat3 cross_matrix(const Vec& w) {
  return {{0, -w.z, w.y}, {w.z, 0, -w.x}, {-w.y, w.x, 0}};
}
/// R a R^T: transforms a matrix from components in the frame R to outer components.
constexpr Mat3 turned(const Frame& r, const Mat3& a) {
  const auto outside = [&](const Vec& left, const Vec& inside) {
    return outer(left, inside.x * r.e0 + inside.y * r.e1 + inside.z * r.e2);
  };
  return outside(r.e0, a.r0) + outside(r.e1, a.r1) + outside(r.e2, a.r2);
}

/// block += a, the block in row-major order.
inline void add9(const Mat3& a, double* block) {
  store3(load3(block) + a.r0, block);
  store3(load3(block + 3) + a.r1, block + 3);
  store3(load3(block + 6) + a.r2, block + 6);
}

}  // namespace tress
