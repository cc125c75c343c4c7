#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace tress::testing {

/// Forward-mode dual number: a value and its N first derivatives. Nest it for second
/// derivatives: Jet<Jet<double, N>, N>. Converts from anything that T is made of.
template <class T, std::size_t N>
struct Jet {
  T v{};
  std::array<T, N> d{};

  Jet() = default;
  Jet(double x) : v(x) {}  // NOLINT: a number is a jet without slope
  Jet(T x, std::array<T, N> slope) : v(x), d(slope) {}

  /// Of f(x) with value f and slope df.
  Jet chain(const T& f, const T& df) const {
    Jet r(f, {});
    for (std::size_t i = 0; i < N; ++i) r.d[i] = df * d[i];
    return r;
  }

  friend Jet operator+(const Jet& a, const Jet& b) {
    return combine(a, b, a.v + b.v, T(1), T(1));
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return combine(a, b, a.v - b.v, T(1), T(-1));
  }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return combine(a, b, a.v * b.v, b.v, a.v);
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const T q = a.v / b.v;
    return combine(a, b, q, T(1) / b.v, T(-1) * q / b.v);
  }

 private:
  /// f(a, b) with slopes fa, fb.
  static Jet combine(const Jet& a, const Jet& b, const T& f, const T& fa, const T& fb) {
    Jet r(f, {});
    for (std::size_t i = 0; i < N; ++i) r.d[i] = fa * a.d[i] + fb * b.d[i];
    return r;
  }
};

template <class T, std::size_t N>
Jet<T, N> sqrt(const Jet<T, N>& a) {
  using std::sqrt;
  const T root = sqrt(a.v);
  return a.chain(root, T(0.5) / root);
}

template <class T, std::size_t N>
Jet<T, N> cos(const Jet<T, N>& a);

template <class T, std::size_t N>
Jet<T, N> sin(const Jet<T, N>& a) {
  using std::cos, std::sin;
  return a.chain(sin(a.v), cos(a.v));
}

template <class T, std::size_t N>
Jet<T, N> cos(const Jet<T, N>& a) {
  using std::cos, std::sin;
  return a.chain(cos(a.v), T(-1) * sin(a.v));
}

/// x_i as the i-th independent variable.
template <std::size_t N>
Jet<double, N> variable(double x, std::size_t i) {
  Jet<double, N> r(x);
  r.d[i] = 1;
  return r;
}

template <std::size_t N>
Jet<Jet<double, N>, N> variable2(double x, std::size_t i) {
  Jet<Jet<double, N>, N> r;
  r.v = variable<N>(x, i);
  r.d[i] = 1;
  return r;
}

}  // namespace tress::testing
