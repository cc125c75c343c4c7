#pragma once

#include <cmath>

#include "math/pack.h"

/// Choices and square roots for kernels over doubles or packs, lane by lane; comparisons
/// with NaN fail.
namespace tress {

/// Returns `yes` where x < y, else `no`; `no` with a NaN.
inline double where_less(double x, double y, double yes, double no) {
  return x < y ? yes : no;
}
/// Returns, lane by lane, `yes` where x < y, else `no`; `no` with a NaN.
template <class Number, int width>
PackOf<Number, width> where_less(const PackOf<Number, width>& x,
                                 const PackOf<Number, width>& y,
                                 const PackOf<Number, width>& yes,
                                 const PackOf<Number, width>& no) {
  return PackOf<Number, width>(x.v < y.v ? yes.v : no.v);
}

/// Whether x < y in some lane.
inline bool any_less(double x, double y) { return x < y; }
/// Returns true if x < y in some lane.
template <class Number, int width>
bool any_less(const PackOf<Number, width>& x, const PackOf<Number, width>& y) {
  const auto less = x.v < y.v;
#ifdef __AVX__
  using Four = PackOf<double, 4>::Vector;
  if constexpr (width == 4 && sizeof(Number) == sizeof(double)) {
    return __builtin_ia32_movmskpd256(reinterpret_cast<Four>(less)) != 0;
  }
  if constexpr (width == 8 && sizeof(Number) == sizeof(double)) {
    const auto halves = __builtin_shufflevector(less, less, 0, 1, 2, 3) |
                        __builtin_shufflevector(less, less, 4, 5, 6, 7);
    return __builtin_ia32_movmskpd256(reinterpret_cast<Four>(halves)) != 0;
  }
#endif
  auto any = less[0];
  for (int lane = 1; lane < width; ++lane) any |= less[lane];
  return any != 0;
}

/// The first if one of them is NaN, as std::max and std::min.
template <class T>
T larger(const T& x, const T& y) {
  return where_less(x, y, y, x);
}
/// Returns the smaller one, lane by lane; y with a NaN.
template <class T>
T smaller(const T& x, const T& y) {
  return where_less(y, x, y, x);
}
/// Returns |x|, lane by lane.
template <class T>
T magnitude(const T& x) {
  return where_less(x, T(0), -x, x);
}

/// Returns the square root.
inline double square_root(double x) { return std::sqrt(x); }
/// One instruction in sources that are compiled without errno for functions of math.
template <class Number, int width>
PackOf<Number, width> square_root(const PackOf<Number, width>& x) {
  PackOf<Number, width> root;
  for (int lane = 0; lane < width; ++lane) root.v[lane] = std::sqrt(x.v[lane]);
  return root;
}

}  // namespace tress
