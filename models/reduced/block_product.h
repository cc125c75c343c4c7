#pragma once

#include <Eigen/Core>

#include "models/math/lanes.h"

namespace tress {

/// sum += weight a for a column of a product (below).
template <int rows>
[[gnu::always_inline]] inline void add_scaled(double weight, const double* a,
                                              double* sum) {
#pragma GCC unroll 1
  for (int i = 0; i < rows; ++i) sum[i] += weight * a[i];
}
template <int rows>
[[gnu::always_inline]] inline void add_scaled(const Pack& weight, const Pack* a,
                                              Pack* sum) {
#pragma GCC unroll 27
  for (int i = 0; i < rows; ++i) sum[i] += weight * a[i];
}

/// c (+)= sign a b for small column-major blocks of fixed size inside larger ones, given
/// by their first entries and column strides; b, with a row stride too, may be
/// transposed. Loops rather than Eigen's products: those unroll completely, and a 9 x 6 x
/// 21 product then takes the compiler minutes. A column of c stays in vector registers;
/// without `unroll 1` the compiler unrolls its loop before it comes to vectorise it, and
/// the product takes more than twice as long; packs are vectors already. Inlined, so that
/// strides are constants.
template <int sign, bool onto, int rows, int inner, int columns, class T>
[[gnu::always_inline]] inline void multiply(const T* a, int a_stride, const T* b,
                                            int b_step, int b_stride, T* c,
                                            int c_stride) {
  for (int j = 0; j < columns; ++j) {
    T sum[rows];
    for (int i = 0; i < rows; ++i) sum[i] = onto ? c[i + c_stride * j] : T(0.0);
#pragma GCC unroll 9
    for (int k = 0; k < inner; ++k) {
      const T weight = sign * b[b_step * k + b_stride * j];
      add_scaled<rows>(weight, a + a_stride * k, sum);
    }
    for (int i = 0; i < rows; ++i) c[i + c_stride * j] = sum[i];
  }
}

/// The same for matrices or blocks of them; the smallest are Eigen's to unroll.
template <int sign, bool onto, class A, class B, class C>
inline void multiply(const A& a, const B& b, C&& c) {
  constexpr int rows = A::RowsAtCompileTime, inner = A::ColsAtCompileTime,
                columns = B::ColsAtCompileTime;
  static_assert(inner == static_cast<int>(B::RowsAtCompileTime));
  static_assert(!A::IsRowMajor || rows == 1 || inner == 1);
  if constexpr (rows * inner * columns <= 27) {
    if constexpr (onto) {
      if constexpr (sign > 0) {
        c.noalias() += a.lazyProduct(b);
      } else {
        c.noalias() -= a.lazyProduct(b);
      }
    } else {
      c.noalias() = a.lazyProduct(b);
    }
  } else {
    multiply<sign, onto, rows, inner, columns>(a.data(), static_cast<int>(a.colStride()),
                                               b.data(), static_cast<int>(b.rowStride()),
                                               static_cast<int>(b.colStride()), c.data(),
                                               static_cast<int>(c.colStride()));
  }
}

/// c += a b
template <class A, class B, class C>
inline void add_product(const A& a, const B& b, C&& c) {
  multiply<1, true>(a, b, c);
}

/// c -= a b
template <class A, class B, class C>
inline void subtract_product(const A& a, const B& b, C&& c) {
  multiply<-1, true>(a, b, c);
}

/// a b
template <class A, class B>
inline auto product(const A& a, const B& b) {
  Eigen::Matrix<typename A::Scalar, A::RowsAtCompileTime, B::ColsAtCompileTime> c;
  multiply<1, false>(a, b, c);
  return c;
}

}  // namespace tress
