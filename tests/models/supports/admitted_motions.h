#pragma once

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/sparse_form.h"
#include "contract/system.h"

/// Matrices of a system with constraints, and the motions that the constraints admit.
namespace tress::testing_support {

/// S(w) of a system, dense.
inline Eigen::MatrixXd matrix_of(System& system, In q, In lambda, Weights w) {
  SparseForm& form = *system.sparse_form();
  const Pattern& pattern = form.pattern();
  const std::vector<double> zero(q.size());
  std::vector<double> values(std::size_t(pattern.nonzeros()));
  EXPECT_EQ(form.values(0, q, zero, zero, w, values), Status::ok);
  if (w.pos != 0 && system.layout().constraints > 0) {
    EXPECT_EQ(system.constraint_form()->add_curvature(0, q, lambda, -w.pos, values),
              Status::ok);
  }
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(pattern.rows, pattern.cols);
  for (int k = 0; k < pattern.cols; ++k) {
    for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
         ++p) {
      full(pattern.row[std::size_t(p)], k) = values[std::size_t(p)];
    }
  }
  return full;
}

/// Orthonormal motions that the constraints admit, in typical sizes.
inline Eigen::MatrixXd free_motions(System& system, In q) {
  const auto n = static_cast<Eigen::Index>(q.size());
  std::vector<double> q_typ(q.size()), v_typ(q.size());
  system.scale(q_typ, v_typ);
  const Eigen::VectorXd typ = Eigen::Map<const Eigen::VectorXd>(q_typ.data(), n);
  if (system.layout().constraints == 0) return typ.asDiagonal();
  ConstraintForm& form = *system.constraint_form();
  const Pattern& pattern = form.pattern();
  std::vector<double> values(std::size_t(pattern.nonzeros()));
  EXPECT_EQ(form.gradient(0, q, values), Status::ok);
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(n, pattern.cols);
  for (int k = 0; k < pattern.cols; ++k) {
    for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
         ++p) {
      g(pattern.row[std::size_t(p)], k) = values[std::size_t(p)];
    }
    g.col(k) = typ.asDiagonal() * g.col(k);
    g.col(k) /= g.col(k).norm();
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(g);
  EXPECT_EQ(qr.rank(), g.cols());
  const Eigen::MatrixXd all = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
  return typ.asDiagonal() * all.rightCols(n - g.cols());
}

}  // namespace tress::testing_support
