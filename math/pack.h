#pragma once

#include <cstddef>

namespace tress {

/// Four numbers processed together: the points of an element, or four strands. Arithmetic
/// is entry by entry, one AVX instruction on machines that have AVX.
struct Pack {
  static constexpr int lanes = 4;
  using Vector __attribute__((vector_size(lanes * sizeof(double)))) = double;
  Vector v;

  Pack() = default;  // Pack x; is uninitialised, Pack x{}; zero, as for double
  // Implicit, so that kernels can mix numbers and packs.
  Pack(double x) : v(Vector{x, x, x, x}) {}  // NOLINT(google-explicit-constructor)
  explicit Pack(const Vector& x) : v(x) {}
  Pack(double x0, double x1, double x2, double x3) : v(Vector{x0, x1, x2, x3}) {}

  double operator[](int lane) const { return v[lane]; }
  void set(int lane, double x) { v[lane] = x; }
  static Pack load(const double* p) { return {p[0], p[1], p[2], p[3]}; }

  Pack& operator+=(const Pack& y) { return *this = *this + y; }
  Pack& operator-=(const Pack& y) { return *this = *this - y; }
  friend Pack operator+(const Pack& x, const Pack& y) { return Pack(x.v + y.v); }
  friend Pack operator-(const Pack& x, const Pack& y) { return Pack(x.v - y.v); }
  friend Pack operator*(const Pack& x, const Pack& y) { return Pack(x.v * y.v); }
  friend Pack operator/(const Pack& x, const Pack& y) { return Pack(x.v / y.v); }
  friend Pack operator-(const Pack& x) { return Pack(-x.v); }

  friend double sum(const Pack& x) { return (x.v[0] + x.v[1]) + (x.v[2] + x.v[3]); }
  friend bool operator==(const Pack& x, const Pack& y) {
    return x[0] == y[0] && x[1] == y[1] && x[2] == y[2] && x[3] == y[3];
  }
};

inline double sum(double x) { return x; }

}  // namespace tress
