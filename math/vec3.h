#pragma once

#include <cmath>
#include <concepts>

namespace tress {

/// Three numbers over any scalar (double, or a dual number).
template <class T>
struct Vec3 {
  T x{};
  T y{};
  T z{};

  constexpr Vec3() = default;
  constexpr Vec3(T x0, T y0, T z0) : x(x0), y(y0), z(z0) {}
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
  friend constexpr T dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  friend constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

using Vec = Vec3<double>;

inline double norm(const Vec& a) { return std::sqrt(dot(a, a)); }

inline bool is_finite(const Vec& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

template <class T>
Vec3<T> load3(const T* p) {
  return {p[0], p[1], p[2]};
}

template <class T>
void store3(const Vec3<T>& a, T* p) {
  p[0] = a.x;
  p[1] = a.y;
  p[2] = a.z;
}

}  // namespace tress
