#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include "math/vec3.h"

namespace tress {

/// Forward-mode dual number: a value with its derivatives along n directions. A kernel
/// that is generic in the scalar, called with Dual, returns the exact directional
/// derivatives of its result. Over Pack: four at once. Over another Dual: second
/// derivatives, x.part[i].part[j]. Cost: 2 n + 1 multiplications for one.
template <int n, class T = double>
struct Dual {
  T value{};                // value of the function
  std::array<T, n> part{};  // derivative along direction k

  Dual() = default;
  // Implicit, so that kernels can mix constants and dual numbers.
  template <std::convertible_to<T> C>
  Dual(const C& constant) : value(constant) {}  // NOLINT(google-explicit-constructor)

  /// f(x) by the chain rule, from f and f' at x.value.
  Dual chain(const T& f, const T& slope) const {
    Dual y(f);
    for (int k = 0; k < n; ++k) y.part[k] = slope * part[k];
    return y;
  }

  /// Adds y, as sums of values and of derivatives.
  Dual& operator+=(const Dual& y) { return *this = *this + y; }
  /// Subtracts y.
  Dual& operator-=(const Dual& y) { return *this = *this - y; }

  friend Dual operator+(Dual x, const Dual& y) {
    x.value += y.value;
    for (int k = 0; k < n; ++k) x.part[k] += y.part[k];
    return x;
  }
  friend Dual operator-(Dual x, const Dual& y) {
    x.value -= y.value;
    for (int k = 0; k < n; ++k) x.part[k] -= y.part[k];
    return x;
  }
  friend Dual operator*(const Dual& x, const Dual& y) {
    Dual z(x.value * y.value);
    for (int k = 0; k < n; ++k) z.part[k] = x.value * y.part[k] + y.value * x.part[k];
    return z;
  }
  template <std::convertible_to<T> C>
  friend Dual operator*(const C& c, const Dual& x) {
    return x.chain(c * x.value, T(c));
  }
  template <std::convertible_to<T> C>
  friend Dual operator*(const Dual& x, const C& c) {
    return c * x;
  }
  friend Dual operator/(const Dual& x, const Dual& y) {
    const T inverse = T(1) / y.value;
    return x * y.chain(inverse, -(inverse * inverse));
  }
  friend Dual operator-(const Dual& x) { return -1.0 * x; }
  /// Returns the sine with its derivatives.
  friend Dual sin(const Dual& x) {
    using std::cos;
    using std::sin;
    return x.chain(sin(x.value), cos(x.value));
  }
  /// Returns the cosine with its derivatives.
  friend Dual cos(const Dual& x) {
    using std::cos;
    using std::sin;
    return x.chain(cos(x.value), -sin(x.value));
  }
  /// Returns the angle of (x, y) from the x axis (rad) with its derivatives.
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const T square = x.value * x.value + y.value * y.value;
    Dual angle(atan2(y.value, x.value));
    for (int k = 0; k < n; ++k) {
      angle.part[k] = (x.value * y.part[k] - y.value * x.part[k]) / square;
    }
    return angle;
  }
  /// Returns the square root with its derivatives.
  friend Dual sqrt(const Dual& x) {
    using std::sqrt;
    const T root = sqrt(x.value);
    return x.chain(root, T(0.5) / root);
  }
};

/// Type that may be multiplied with numbers of type T and has no derivatives of its own.
template <class T>
struct ConstantOf {
  /// The type itself, for numbers.
  using Type = T;
};
/// Constants of dual numbers are of the type of their values.
template <int n, class T>
struct ConstantOf<Dual<n, T>> {
  /// Type of the value.
  using Type = T;
};

// Products of vectors with constants, whose derivatives are not multiplied.
/// Scales a vector of dual numbers by a constant.
template <int n, class T>
Vec3<Dual<n, T>> operator*(const T& s, const Vec3<Dual<n, T>>& x) {
  return {s * x.x, s * x.y, s * x.z};
}
/// Scales a constant vector by a dual number.
template <int n, class T>
Vec3<Dual<n, T>> operator*(const Dual<n, T>& s, const Vec3<T>& x) {
  return {s * x.x, s * x.y, s * x.z};
}
/// Returns the vector product of a constant and a dual vector.
template <int n, class T>
Vec3<Dual<n, T>> cross(const Vec3<T>& a, const Vec3<Dual<n, T>>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns the vector product of a dual and a constant vector.
template <int n, class T>
Vec3<Dual<n, T>> cross(const Vec3<Dual<n, T>>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace tress
