#pragma once

#include <algorithm>
#include <cmath>

#include "math/pack.h"

/// Functions of numbers and of packs, entry by entry, for kernels that take either.
namespace tress {

inline double root(double x) { return std::sqrt(x); }
inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }
/// `yes` where a < b, otherwise (NaN, too) `no`.
inline double where_less(double a, double b, double yes, double no) {
  return a < b ? yes : no;
}
inline bool any_less(double a, double b) { return a < b; }

/// Without a branch only where the compiler may ignore errno (-fno-math-errno).
template <class N, int w>
PackOf<N, w> root(const PackOf<N, w>& x) {
  PackOf<N, w> result;
  for (int lane = 0; lane < w; ++lane) result.v[lane] = std::sqrt(x.v[lane]);
  return result;
}
template <class N, int w>
PackOf<N, w> larger(const PackOf<N, w>& a, const PackOf<N, w>& b) {
  return PackOf<N, w>(a.v > b.v ? a.v : b.v);
}
template <class N, int w>
PackOf<N, w> smaller(const PackOf<N, w>& a, const PackOf<N, w>& b) {
  return PackOf<N, w>(a.v < b.v ? a.v : b.v);
}
template <class N, int w>
PackOf<N, w> where_less(const PackOf<N, w>& a, const PackOf<N, w>& b,
                        const PackOf<N, w>& yes, const PackOf<N, w>& no) {
  return PackOf<N, w>(a.v < b.v ? yes.v : no.v);
}
template <class N, int w>
bool any_less(const PackOf<N, w>& a, const PackOf<N, w>& b) {
  const auto less = a.v < b.v;
#ifdef __AVX__
  if constexpr (w == 4 && sizeof(N) == 8) {
    return __builtin_ia32_movmskpd256(
               reinterpret_cast<typename PackOf<N, w>::Vector>(less)) != 0;
  }
#endif
  auto any = less[0];
  for (int lane = 1; lane < w; ++lane) any |= less[lane];
  return any != 0;
}

}  // namespace tress
