#pragma once

#include <Eigen/Core>

namespace tress {

/// c (+)= sign a b for small column-major blocks of fixed size inside larger ones, given
/// by their first entries and column strides; b, with a row stride too, may be
/// transposed. Loops rather than Eigen's products: those unroll completely, and a 9 x 6 x
/// 21 product then takes the compiler minutes. A column of c stays in vector registers;
/// without the last pragma the compiler unrolls its loop before it comes to vectorise it,
/// and the product takes more than twice as long. Inlined, so that strides are constants.
template <int sign, bool onto, int rows, int inner, int columns>
[[gnu::always_inline]] inline void multiply(const double* a, int a_stride,
                                            const double* b, int b_step, int b_stride,
                                            double* c, int c_stride) {
  for (int j = 0; j < columns; ++j) {
    double sum[rows];
    for (int i = 0; i < rows; ++i) sum[i] = onto ? c[i + c_stride * j] : 0.0;
#pragma GCC unroll 9
    for (int k = 0; k < inner; ++k) {
      const double weight = b[b_step * k + b_stride * j];
#pragma GCC unroll 1
      for (int i = 0; i < rows; ++i) sum[i] += sign * weight * a[i + a_stride * k];
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
      c.noalias() += sign * a.lazyProduct(b);
    } else {
      c.noalias() = sign * a.lazyProduct(b);
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
  Eigen::Matrix<double, A::RowsAtCompileTime, B::ColsAtCompileTime> c;
  multiply<1, false>(a, b, c);
  return c;
}

}  // namespace tress
