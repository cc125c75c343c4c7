#include "experiments/validation/small_motions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>

namespace tress {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Orthonormal, of what is orthogonal to the columns.
MatrixXd complement(const MatrixXd& columns) {
  if (columns.cols() == 0) return MatrixXd::Identity(columns.rows(), columns.rows());
  const Eigen::HouseholderQR<MatrixXd> qr(columns);
  return MatrixXd(qr.householderQ()).rightCols(columns.rows() - columns.cols());
}

bool symmetric(const MatrixXd& matrix) {
  // Differences of a residual make a symmetric matrix to 1e-9 of its largest entry.
  constexpr double noise = 1e-6;
  return (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <=
         noise * matrix.cwiseAbs().maxCoeff();
}

std::vector<SmallMotion> of_symmetric(const MatrixXd& mass, const MatrixXd& stiffness) {
  // With omega^2 + shift = 1/mu, M x = mu (K + shift M) x.
  double shift = 0;
  const double first =
      1e-14 * stiffness.cwiseAbs().maxCoeff() / mass.cwiseAbs().maxCoeff();
  MatrixXd definite = stiffness;
  while (Eigen::LLT<MatrixXd>(definite).info() != Eigen::Success) {
    shift = shift == 0 ? first : 4 * shift;
    definite = stiffness + shift * mass;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> motions(mass, definite);
  std::vector<SmallMotion> all;
  for (auto k = motions.eigenvalues().size(); k-- > 0;) {
    all.push_back({1 / motions.eigenvalues()[k] - shift, motions.eigenvectors().col(k)});
  }
  return all;
}

}  // namespace

std::vector<SmallMotion> small_motions(const MatrixXd& mass, const MatrixXd& stiffness,
                                       const MatrixXd& columns, const MatrixXd& rows,
                                       In typical) {
  const Eigen::Map<const VectorXd> size(typical.data(), mass.rows());
  const MatrixXd right =
      size.asDiagonal() * complement(size.asDiagonal() * rows.transpose());
  const MatrixXd left = size.asDiagonal() * complement(size.asDiagonal() * columns);
  const MatrixXd m = left.transpose() * mass * right;
  const MatrixXd k = left.transpose() * stiffness * right;
  std::vector<SmallMotion> all;
  if (symmetric(m) && symmetric(k)) {
    all = of_symmetric((m + m.transpose()) / 2, (k + k.transpose()) / 2);
    for (SmallMotion& motion : all) motion.shape = right * motion.shape;
  } else {
    const Eigen::EigenSolver<MatrixXd> motions(m.partialPivLu().solve(k));
    for (Eigen::Index j = 0; j < m.rows(); ++j) {
      all.push_back({motions.eigenvalues()[j].real(),
                     right * motions.eigenvectors().col(j).real()});
    }
    std::ranges::sort(all, {}, &SmallMotion::square);
  }
  return all;
}

}  // namespace tress
