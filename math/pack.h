#pragma once

#include <array>
#include <bit>
#include <cstddef>

namespace tress {

/// `width` numbers processed together, entry by entry; one instruction where the machine
/// has registers of that size. Number = double or float.
template <class Number, int width>
struct PackOf {
  static constexpr int lanes = width;  // number of lanes
  /// Type of the numbers.
  using Scalar = Number;
  /// The compiler's vector type.
  using Vector __attribute__((vector_size(width * sizeof(Number)))) = Number;
  // Of its own accord a vector has the alignment of the widest registers that are
  // allowed.
  /// The numbers of all lanes.
  alignas(width * sizeof(Number)) Vector v;

  PackOf() = default;  // Pack x; is uninitialised, Pack x{}; zero, as for double
  // Implicit, so that kernels can mix numbers and packs.
  /// Sets all lanes to x.
  PackOf(double x)  // NOLINT(google-explicit-constructor)
      : v(Vector{} + static_cast<Number>(x)) {}
  /// Takes the numbers of a vector.
  explicit PackOf(const Vector& x) : v(x) {}
  /// Sets four lanes.
  PackOf(Number x0, Number x1, Number x2, Number x3) requires(width == 4)
      : v(Vector{x0, x1, x2, x3}) {}

  /// Returns the number in a lane.
  Number operator[](int lane) const { return v[lane]; }
  /// Sets the number in a lane.
  void set(int lane, Number x) { v[lane] = x; }
  /// Takes the numbers of an array.
  explicit PackOf(const std::array<Number, width>& x) : v(std::bit_cast<Vector>(x)) {}
  /// Returns the numbers as an array.
  std::array<Number, width> numbers() const {
    return std::bit_cast<std::array<Number, width>>(v);
  }
  /// Reads numbers that lie one after the other; they need no alignment.
  static PackOf load(const Number* p) {
    PackOf x;
    for (int lane = 0; lane < width; ++lane) x.v[lane] = p[lane];
    return x;
  }

  /// Adds y, lane by lane.
  PackOf& operator+=(const PackOf& y) { return *this = *this + y; }
  /// Subtracts y, lane by lane.
  PackOf& operator-=(const PackOf& y) { return *this = *this - y; }
  friend PackOf operator+(const PackOf& x, const PackOf& y) { return PackOf(x.v + y.v); }
  friend PackOf operator-(const PackOf& x, const PackOf& y) { return PackOf(x.v - y.v); }
  friend PackOf operator*(const PackOf& x, const PackOf& y) { return PackOf(x.v * y.v); }
  friend PackOf operator/(const PackOf& x, const PackOf& y) { return PackOf(x.v / y.v); }
  friend PackOf operator-(const PackOf& x) { return PackOf(-x.v); }

  /// Returns the sum over all lanes, by pairs of lanes from the first on.
  friend Number sum(const PackOf& x) {  // of pairs of lanes, from the first on
    Number all = 0;
    for (int lane = 0; lane + 1 < width; lane += 2) all += x.v[lane] + x.v[lane + 1];
    return width % 2 == 0 ? all : all + x.v[width - 1];
  }
  friend bool operator==(const PackOf& x, const PackOf& y) {
    for (int lane = 0; lane < width; ++lane) {
      if (x.v[lane] != y.v[lane]) return false;
    }
    return true;
  }
  /// Whether x <= limit in all lanes; false with a NaN.
  friend bool all_up_to(const PackOf& x, Number limit) {
    const auto over = x.v <= Vector{} + limit;
    auto all = over[0];
    for (int lane = 1; lane < width; ++lane) all &= over[lane];
    return all != 0;
  }
  /// The lanes of `yes` where x <= limit, otherwise (NaN, too) those of `no`.
  friend PackOf where_up_to(const PackOf& x, Number limit, const PackOf& yes,
                            const PackOf& no) {
    return PackOf(x.v <= Vector{} + limit ? yes.v : no.v);
  }
};

/// The points of an element, or four strands.
using Pack = PackOf<double, 4>;

/// Returns the number; it has one lane.
inline double sum(double x) { return x; }

}  // namespace tress
