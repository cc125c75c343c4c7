#include "models/reduced/definite_block.h"

#include <Eigen/Eigenvalues>

#include "models/reduced/point_matrix.h"

namespace tress::models {
namespace {

/// By leading minors.
bool definite(const Eigen::Matrix3d& m) {
  const double minor = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1);
  return m(0, 0) > 0 && minor > 0 && m.determinant() > 0;
}

}  // namespace

void make_semidefinite(InOut blocks) {
  for (std::size_t at = 0; at < blocks.size(); at += 9) {
    if (is_multiple_of_unit(&blocks[at]) && blocks[at] >= 0) continue;
    Eigen::Map<Eigen::Matrix3d> block(&blocks[at]);
    const Eigen::Matrix3d symmetric = (block + block.transpose()) / 2;
    block = symmetric;
    if (definite(symmetric) || !symmetric.allFinite()) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> pairs(symmetric);
    block = pairs.eigenvectors() * pairs.eigenvalues().cwiseMax(0).asDiagonal() *
            pairs.eigenvectors().transpose();
  }
}

}  // namespace tress::models
