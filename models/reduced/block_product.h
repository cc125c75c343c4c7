#pragma once

#include <Eigen/Core>

namespace tress {

/// c += factor a b for small column-major blocks of fixed size inside larger ones, given
/// by their first entries and column strides. Loops rather than Eigen's products: those
/// unroll completely, and a 9 x 6 x 21 product then takes the compiler minutes.
template <int rows, int inner, int columns>
inline void add_product(const double* a, int a_stride, const double* b, int b_stride,
                        double* c, int c_stride, double factor = 1) {
  for (int j = 0; j < columns; ++j) {
    double sum[rows];
    for (int i = 0; i < rows; ++i) sum[i] = 0;
    for (int k = 0; k < inner; ++k) {
      const double weight = b[k + b_stride * j];
      for (int i = 0; i < rows; ++i) sum[i] += weight * a[i + a_stride * k];
    }
    for (int i = 0; i < rows; ++i) c[i + c_stride * j] += factor * sum[i];
  }
}

/// c += factor a b for matrices or blocks of them.
template <class A, class B, class C>
inline void add_product(const A& a, const B& b, C&& c, double factor = 1) {
  constexpr int rows = A::RowsAtCompileTime, inner = A::ColsAtCompileTime,
                columns = B::ColsAtCompileTime;
  static_assert(inner == static_cast<int>(B::RowsAtCompileTime));
  static_assert(!A::IsRowMajor || rows == 1 || inner == 1);
  static_assert(!B::IsRowMajor || inner == 1 || columns == 1);
  add_product<rows, inner, columns>(a.data(), static_cast<int>(a.colStride()), b.data(),
                                    static_cast<int>(b.colStride()), c.data(),
                                    static_cast<int>(c.colStride()), factor);
}

/// a b
template <class A, class B>
inline auto product(const A& a, const B& b) {
  Eigen::Matrix<double, A::RowsAtCompileTime, B::ColsAtCompileTime> c;
  c.setZero();
  add_product(a, b, c);
  return c;
}

}  // namespace tress
