#pragma once

#include <array>
#include <cmath>

namespace tress {

/// Forward-mode derivative number: a value with its derivatives along n directions. A
/// kernel written once for any scalar and called with Dual returns the exact directional
/// derivatives of what it computes. Cost: n + 1 multiplications for one.
template <int n>
struct Dual {
  double value = 0;
  std::array<double, n> part{};  // derivative along direction k

  Dual() = default;
  // Implicit, so that kernels mix constants and derivative numbers.
  Dual(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor)

  /// f(x) by the chain rule, from f and f' at x.value.
  Dual chain(double f, double slope) const {
    Dual y(f);
    for (int k = 0; k < n; ++k) y.part[k] = slope * part[k];
    return y;
  }

  Dual& operator+=(const Dual& y) { return *this = *this + y; }
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
  friend Dual operator*(double c, const Dual& x) { return x.chain(c * x.value, c); }
  friend Dual operator*(const Dual& x, double c) { return c * x; }
  friend Dual operator/(const Dual& x, const Dual& y) {
    return x * y.chain(1 / y.value, -1 / (y.value * y.value));
  }
  friend Dual operator-(const Dual& x) { return -1.0 * x; }
  friend Dual sin(const Dual& x) { return x.chain(std::sin(x.value), std::cos(x.value)); }
  friend Dual cos(const Dual& x) {
    return x.chain(std::cos(x.value), -std::sin(x.value));
  }
  friend Dual sqrt(const Dual& x) {
    const double root = std::sqrt(x.value);
    return x.chain(root, 0.5 / root);
  }
};

}  // namespace tress
