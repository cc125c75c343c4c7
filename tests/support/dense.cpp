#include "tests/support/dense.h"

#include <gsl/gsl_linalg.h>

#include <algorithm>
#include <limits>

namespace tress::testing_support {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What GSL sees of a matrix; it writes there.
gsl_matrix_view view(RowMajor& a) {
  return gsl_matrix_view_array(a.data(), static_cast<std::size_t>(a.rows()),
                               static_cast<std::size_t>(a.cols()));
}
gsl_vector_view view(Eigen::VectorXd& x) {
  return gsl_vector_view_array(x.data(), static_cast<std::size_t>(x.size()));
}

/// A = U diag(s) V^T, s descending, U with as many columns as the shorter side.
struct Decomposed {
  RowMajor u, v;
  Eigen::VectorXd s;

  explicit Decomposed(const Eigen::MatrixXd& a) {
    const bool wide = a.cols() > a.rows();
    u = wide ? a.transpose() : a;
    v.resize(u.cols(), u.cols());
    s.resize(u.cols());
    gsl_matrix_view of_u = view(u), of_v = view(v);
    Eigen::VectorXd work(u.cols());
    gsl_vector_view of_s = view(s), of_work = view(work);
    gsl_linalg_SV_decomp(&of_u.matrix, &of_v.matrix, &of_s.vector, &of_work.vector);
    if (wide) u.swap(v);
  }
};

/// Singular values below this times the largest are rounding.
double rounding(const Eigen::MatrixXd& a) {
  return static_cast<double>(std::max(a.rows(), a.cols())) *
         std::numeric_limits<double>::epsilon();
}

}  // namespace

Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  RowMajor lu = a;
  gsl_matrix_view of_lu = view(lu);
  gsl_permutation* order = gsl_permutation_alloc(static_cast<std::size_t>(a.rows()));
  int sign = 0;
  gsl_linalg_LU_decomp(&of_lu.matrix, order, &sign);
  Eigen::MatrixXd x = b;
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    Eigen::VectorXd column = b.col(j);
    gsl_vector_view of_column = view(column);
    gsl_linalg_LU_svx(&of_lu.matrix, order, &of_column.vector);
    x.col(j) = column;
  }
  gsl_permutation_free(order);
  return x;
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                              double threshold) {
  const Decomposed d(a);
  const double least = std::max(threshold, rounding(a)) * d.s.maxCoeff();
  const Eigen::VectorXd inverse =
      (d.s.array() > least).select(d.s.array().max(least).inverse(), 0);
  return d.v * inverse.asDiagonal() * d.u.transpose() * b;
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& a) { return Decomposed(a).s; }

Eigen::Index rank(const Eigen::MatrixXd& a) {
  const Eigen::VectorXd s = singular_values(a);
  return (s.array() > rounding(a) * s.maxCoeff()).count();
}

Eigen::MatrixXd orthogonal(const Eigen::MatrixXd& a) {
  RowMajor qr = a, q(a.rows(), a.rows()), r(a.rows(), a.cols());
  Eigen::VectorXd tau(a.cols());
  gsl_matrix_view of_qr = view(qr), of_q = view(q), of_r = view(r);
  gsl_vector_view of_tau = view(tau);
  gsl_linalg_QR_decomp(&of_qr.matrix, &of_tau.vector);
  gsl_linalg_QR_unpack(&of_qr.matrix, &of_tau.vector, &of_q.matrix, &of_r.matrix);
  return q;
}

}  // namespace tress::testing_support
