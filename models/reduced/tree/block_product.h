#pragma once

#include <Eigen/Core>
#include <type_traits>

#include "contract/layers.h"
#include "math/lanes.h"

namespace tress::models {

/// Adds weight times a to sum, a column of multiply().
template <int rows>
[[gnu::always_inline]] inline void add_scaled(double weight, const double* a,
                                              double* sum) {
#pragma GCC unroll 1
  for (int i = 0; i < rows; ++i) sum[i] += weight * a[i];
}
/// Adds weight times a to sum, a column of packs.
template <int rows>
[[gnu::always_inline]] inline void add_scaled(const Pack& weight, const Pack* a,
                                              Pack* sum) {
#pragma GCC unroll 27
  for (int i = 0; i < rows; ++i) sum[i] += weight * a[i];
}

/// Computes c (+)= sign a b for small column-major blocks of fixed size inside larger
/// ones, given by their first entries and column strides. The block b also has a row
/// stride and may be transposed. Loops replace Eigen's products, which unroll completely:
/// a 9 x 6 x 21 product then takes the compiler minutes. A column of c stays in vector
/// registers. Without `unroll 1` the compiler unrolls its loop before vectorising it, and
/// the product takes more than twice as long. Inlined, so that strides are constants.
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

/// Computes multiply() unrolled completely, for the smallest blocks.
template <int sign, bool onto, int rows, int inner, int columns, class T>
[[gnu::always_inline]] inline void multiply_small(const T* a, int a_stride, const T* b,
                                                  int b_step, int b_stride, T* c,
                                                  int c_stride) {
#pragma GCC unroll 9
  for (int j = 0; j < columns; ++j) {
#pragma GCC unroll 9
    for (int i = 0; i < rows; ++i) {
      T sum = a[i] * b[b_stride * j];
#pragma GCC unroll 9
      for (int k = 1; k < inner; ++k) {
        sum += a[i + a_stride * k] * b[b_step * k + b_stride * j];
      }
      T& to = c[i + c_stride * j];
      if constexpr (onto) {
        to += sign * sum;
      } else {
        to = sign * sum;
      }
    }
  }
}

/// A block of a small column-major matrix, or its transpose. Replaces Eigen's blocks,
/// each of which takes the compiler as long as the whole product.
template <class T, int rows, int columns>
struct Part {
  /// Size of the block, named as in Eigen.
  static constexpr int RowsAtCompileTime = rows, ColsAtCompileTime = columns;
  T* first;                       // address of entry (0, 0)
  int row_stride, column_stride;  // steps from row to row, from column to column

  /// Returns the address of entry (0, 0).
  T* data() const { return first; }
  /// Returns the step from row to row, in entries.
  int rowStride() const { return row_stride; }
  /// Returns the step from column to column, in entries.
  int colStride() const { return column_stride; }
  /// Returns entry (i, j).
  T& operator()(int i, int j) const { return first[row_stride * i + column_stride * j]; }
  T& operator[](int i) const { return first[row_stride * i]; }  // entry i of a column
  /// Returns the transposed block.
  Part<T, columns, rows> transpose() const { return {first, column_stride, row_stride}; }
};

/// Returns the block of a matrix whose first entry is (row, column).
template <int rows, int columns, class M>
auto part(M& m, int row, int column) {
  using T = std::remove_pointer_t<decltype(m.data())>;
  const auto stride = static_cast<int>(m.outerStride());
  return Part<T, rows, columns>{m.data() + row + stride * column, 1, stride};
}
/// Returns a column of a matrix of fixed size as a block.
template <class M>
auto column_of(M& m, int column) {
  return part<M::RowsAtCompileTime, 1>(m, 0, column);
}
/// Returns a whole matrix of fixed size as a block.
template <class M>
auto part(M& m) {
  return part<M::RowsAtCompileTime, M::ColsAtCompileTime>(m, 0, 0);
}

/// Copies a to b, which may be a block.
template <class A, class B>
inline void copy(const A& a, B&& b) {
  for (int j = 0; j < A::ColsAtCompileTime; ++j) {
    for (int i = 0; i < A::RowsAtCompileTime; ++i) b(i, j) = a(i, j);
  }
}
/// Adds factor times a to b, which may be a block.
template <class A, class B>
inline void add(const A& a, B&& b, double factor = 1) {
  for (int j = 0; j < A::ColsAtCompileTime; ++j) {
    for (int i = 0; i < A::RowsAtCompileTime; ++i) b(i, j) += factor * a(i, j);
  }
}

/// Computes c (+)= sign a b for matrices and parts of matrices; a is column-major.
template <int sign, bool onto, class A, class B, class C>
inline void multiply(const A& a, const B& b, C&& c) {
  constexpr int rows = A::RowsAtCompileTime, inner = A::ColsAtCompileTime,
                columns = B::ColsAtCompileTime;
  static_assert(inner == static_cast<int>(B::RowsAtCompileTime));
  const auto a_stride = static_cast<int>(a.colStride());
  const auto b_step = static_cast<int>(b.rowStride());
  const auto b_stride = static_cast<int>(b.colStride());
  const auto c_stride = static_cast<int>(c.colStride());
  if constexpr (rows * inner * columns <= 27) {
    multiply_small<sign, onto, rows, inner, columns>(a.data(), a_stride, b.data(), b_step,
                                                     b_stride, c.data(), c_stride);
  } else {
    multiply<sign, onto, rows, inner, columns>(a.data(), a_stride, b.data(), b_step,
                                               b_stride, c.data(), c_stride);
  }
}

/// Returns the scalar product of two columns of fixed size, in four partial sums.
template <int rows>
[[gnu::always_inline]] inline double product_of_columns(const double* a,
                                                        const double* x) {
  constexpr int whole = rows / 4 * 4;
  double sum[4] = {};
#pragma GCC unroll 1
  for (int i = 0; i < whole; i += 4) {
    for (int l = 0; l < 4; ++l) sum[l] += a[i + l] * x[i + l];
  }
  double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  for (int i = whole; i < rows; ++i) all += a[i] * x[i];
  return all;
}
/// Computes y (+)= sign a^T x for a column-major matrix a and columns x and y of fixed
/// size.
template <int sign, bool onto, class A, class X, class Y>
inline void multiply_transposed(const A& a, const X& x, Y&& y) {
  constexpr int rows = A::RowsAtCompileTime;
  static_assert(rows == static_cast<int>(X::RowsAtCompileTime));
  const auto stride = static_cast<int>(a.colStride());
  for (int j = 0; j < A::ColsAtCompileTime; ++j) {
    const double sum = product_of_columns<rows>(a.data() + stride * j, x.data());
    y[j] = (onto ? y[j] : 0.0) + sign * sum;
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
  using T = std::remove_cvref_t<decltype(*a.data())>;
  Eigen::Matrix<T, A::RowsAtCompileTime, B::ColsAtCompileTime> c;
  multiply<1, false>(a, b, c);
  return c;
}

}  // namespace tress::models
