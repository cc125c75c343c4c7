#pragma once

#include "math/frame.h"
#include "math/vec3.h"

namespace tress {

/// A 3x3 matrix, stored by rows.
struct Mat3 {
  Vec r0, r1, r2;

  friend constexpr Mat3 operator+(const Mat3& a, const Mat3& b) {
    return {a.r0 + b.r0, a.r1 + b.r1, a.r2 + b.r2};
  }
  friend constexpr Mat3 operator-(const Mat3& a, const Mat3& b) {
    return {a.r0 - b.r0, a.r1 - b.r1, a.r2 - b.r2};
  }
  friend constexpr Mat3 operator*(double s, const Mat3& a) {
    return {s * a.r0, s * a.r1, s * a.r2};
  }
  friend constexpr Vec operator*(const Mat3& a, const Vec& x) {
    return {dot(a.r0, x), dot(a.r1, x), dot(a.r2, x)};
  }
  /// x^T a
  friend constexpr Vec operator*(const Vec& x, const Mat3& a) {
    return x.x * a.r0 + x.y * a.r1 + x.z * a.r2;
  }
  friend constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
    return {a.r0 * b, a.r1 * b, a.r2 * b};
  }
};

constexpr Mat3 diagonal(const Vec& d) { return {{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}; }
constexpr Mat3 identity() { return diagonal({1, 1, 1}); }
constexpr double trace(const Mat3& a) { return a.r0.x + a.r1.y + a.r2.z; }

/// a b^T
constexpr Mat3 outer(const Vec& a, const Vec& b) { return {a.x * b, a.y * b, a.z * b}; }
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
