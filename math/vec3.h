#pragma once

#include <cmath>
#include <concepts>

namespace tress {

/// Three numbers over any scalar (double, or a dual number).
template <class T>
struct Vec3 {
  T x{};  // first component
  T y{};  // second component
  T z{};  // third component

  constexpr Vec3() = default;
  /// Makes the vector (x0, y0, z0).
  constexpr Vec3(T x0, T y0, T z0) : x(x0), y(y0), z(z0) {}
  /// Converts from components of another type, such as numbers to dual numbers.
  template <class U>
  requires(!std::same_as<U, T> &&
           std::convertible_to<U, T>) constexpr Vec3(const Vec3<U>& u)
      : x(u.x), y(u.y), z(u.z) {}

  friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Vec3 operator*(const T& s, const Vec3& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
  /// Returns the scalar product.
  friend constexpr T dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  /// Returns the vector product.
  friend constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

/// Vector in double precision.
using Vec = Vec3<double>;

/// Returns the Euclidean length.
inline double norm(const Vec& a) { return std::sqrt(dot(a, a)); }

/// Returns true if all components are finite.
inline bool is_finite(const Vec& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Reads three numbers.
template <class T>
Vec3<T> load3(const T* p) {
  return {p[0], p[1], p[2]};
}

/// Writes three numbers.
template <class T>
void store3(const Vec3<T>& a, T* p) {
  p[0] = a.x;
  p[1] = a.y;
  p[2] = a.z;
}

}  // namespace tress
