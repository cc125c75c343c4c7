#pragma once

#include "math/vec3.h"

namespace tress {

/// Nine numbers over any scalar, by rows, for kernels that keep them in registers: all
/// loops have fixed bounds and are unrolled.
template <class T>
struct Matrix3 {
  /// Type of rows and columns.
  using Vec = Vec3<T>;

  Vec row[3];  // rows

  /// Makes the matrix with these columns.
  static Matrix3 columns(const Vec& a, const Vec& b, const Vec& c) {
    return {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
  }
  /// Returns the transpose.
  Matrix3 transposed() const { return columns(row[0], row[1], row[2]); }
  /// Returns column k, 0 to 2.
  Vec column(int k) const {
    if (k == 0) return {row[0].x, row[1].x, row[2].x};
    if (k == 1) return {row[0].y, row[1].y, row[2].y};
    return {row[0].z, row[1].z, row[2].z};
  }
  /// The transpose times x.
  Vec back(const Vec& x) const { return x.x * row[0] + x.y * row[1] + x.z * row[2]; }

  friend Vec operator*(const Matrix3& a, const Vec& x) {
    return {dot(a.row[0], x), dot(a.row[1], x), dot(a.row[2], x)};
  }
  friend Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    return {{b.back(a.row[0]), b.back(a.row[1]), b.back(a.row[2])}};
  }
  friend Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
    return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}};
  }
  friend Matrix3 operator-(const Matrix3& a, const Matrix3& b) {
    return {{a.row[0] - b.row[0], a.row[1] - b.row[1], a.row[2] - b.row[2]}};
  }
  friend Matrix3 operator*(const T& s, const Matrix3& a) {
    return {{s * a.row[0], s * a.row[1], s * a.row[2]}};
  }
};

/// x y^T.
template <class T>
Matrix3<T> dyad(const Vec3<T>& x, const Vec3<T>& y) {
  return {{x.x * y, x.y * y, x.z * y}};
}
/// a [p]x: what a does with cross(p, x).
template <class T>
Matrix3<T> times_cross(const Matrix3<T>& a, const Vec3<T>& p) {
  return {{cross(a.row[0], p), cross(a.row[1], p), cross(a.row[2], p)}};
}
/// [p]x a.
template <class T>
Matrix3<T> cross_times(const Vec3<T>& p, const Matrix3<T>& a) {
  return {{p.y * a.row[2] - p.z * a.row[1], p.z * a.row[0] - p.x * a.row[2],
           p.x * a.row[1] - p.y * a.row[0]}};
}
/// [p]x.
template <class T>
Matrix3<T> cross_matrix(const Vec3<T>& p) {
  const T o(0);
  return {{{o, -p.z, p.y}, {p.z, o, -p.x}, {-p.y, p.x, o}}};
}

/// Returns the inverse by cofactors.
template <class T>
Matrix3<T> inverse(const Matrix3<T>& m) {
  const Vec3<T> x = cross(m.row[1], m.row[2]), y = cross(m.row[2], m.row[0]),
                z = cross(m.row[0], m.row[1]);
  return (T(1) / dot(m.row[0], x)) * Matrix3<T>::columns(x, y, z);
}

/// Symmetric 3x3 matrix over any scalar, by its upper triangle.
template <class T>
struct Symmetric3 {
  /// Type of the vectors that it multiplies.
  using Vec = Vec3<T>;

  T xx{}, yy{}, zz{}, xy{}, xz{}, yz{};  // entries of the upper triangle

  friend Matrix3<T> operator*(const Symmetric3& a, const Matrix3<T>& b) {
    return {{b.back({a.xx, a.xy, a.xz}), b.back({a.xy, a.yy, a.yz}),
             b.back({a.xz, a.yz, a.zz})}};
  }
  friend Vec operator*(const Symmetric3& a, const Vec& x) {
    return {a.xx * x.x + a.xy * x.y + a.xz * x.z, a.xy * x.x + a.yy * x.y + a.yz * x.z,
            a.xz * x.x + a.yz * x.y + a.zz * x.z};
  }
  friend Symmetric3 operator+(const Symmetric3& a, const Symmetric3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  friend Symmetric3 operator-(const Symmetric3& a, const Symmetric3& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
  }
  friend Symmetric3 operator*(const T& s, const Symmetric3& a) {
    return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
  }
};

/// The upper triangle of a b^T, a product that is symmetric but for rounding.
template <class T>
Symmetric3<T> upper(const Matrix3<T>& a, const Matrix3<T>& b) {
  return {dot(a.row[0], b.row[0]), dot(a.row[1], b.row[1]), dot(a.row[2], b.row[2]),
          dot(a.row[0], b.row[1]), dot(a.row[0], b.row[2]), dot(a.row[1], b.row[2])};
}
/// r a r^T.
template <class T>
Symmetric3<T> congruent(const Matrix3<T>& r, const Symmetric3<T>& a) {
  const auto by = [&](const Vec3<T>& row) { return a * row; };
  return upper(Matrix3<T>{{by(r.row[0]), by(r.row[1]), by(r.row[2])}}, r);
}
/// Returns all nine entries.
template <class T>
Matrix3<T> full(const Symmetric3<T>& a) {
  return {{{a.xx, a.xy, a.xz}, {a.xy, a.yy, a.yz}, {a.xz, a.yz, a.zz}}};
}
/// The upper triangle, as it stands.
template <class T>
Symmetric3<T> upper(const Matrix3<T>& a) {
  return {a.row[0].x, a.row[1].y, a.row[2].z, a.row[0].y, a.row[0].z, a.row[1].z};
}

/// Returns the inverse by cofactors; accurate also for graded definite matrices.
template <class T>
Symmetric3<T> inverse(const Symmetric3<T>& h) {
  const T first = h.yy * h.zz - h.yz * h.yz;
  const T second = h.xz * h.yz - h.xy * h.zz, third = h.xy * h.yz - h.xz * h.yy;
  const T by = T(1) / (h.xx * first + h.xy * second + h.xz * third);
  return {first * by,
          (h.xx * h.zz - h.xz * h.xz) * by,
          (h.xx * h.yy - h.xy * h.xy) * by,
          second * by,
          third * by,
          (h.xy * h.xz - h.xx * h.yz) * by};
}

}  // namespace tress
