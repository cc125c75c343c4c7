#include "experiments/validation/small_motions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>

#include "experiments/harness/eigenvalues.h"

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

std::vector<double> of_symmetric(const MatrixXd& mass, const MatrixXd& stiffness) {
  // With omega^2 + shift = 1/mu, M x = mu (K + shift M) x.
  double shift = 0;
  const double first =
      1e-14 * stiffness.cwiseAbs().maxCoeff() / mass.diagonal().maxCoeff();
  MatrixXd definite = stiffness;
  while (Eigen::LLT<MatrixXd>(definite).info() != Eigen::Success) {
    shift = shift == 0 ? first : 4 * shift;
    definite = stiffness + shift * mass;
  }
  const VectorXd mu = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(
                          mass, definite, Eigen::EigenvaluesOnly)
                          .eigenvalues();
  std::vector<double> squares;
  for (auto k = mu.size(); k-- > 0;) squares.push_back(1 / mu[k] - shift);
  return squares;
}

}  // namespace

std::vector<double> small_motions(const MatrixXd& mass, const MatrixXd& stiffness,
                                  const MatrixXd& constraints, In typical) {
  const Eigen::Map<const VectorXd> size(typical.data(), mass.rows());
  const MatrixXd basis = size.asDiagonal() * complement(size.asDiagonal() * constraints);
  const MatrixXd m = basis.transpose() * mass * basis;
  const MatrixXd k = basis.transpose() * stiffness * basis;
  if (symmetric(m) && symmetric(k)) {
    return of_symmetric((m + m.transpose()) / 2, (k + k.transpose()) / 2);
  }
  std::vector<double> squares;
  for (const auto& square : eigenvalues(m.partialPivLu().solve(k))) {
    squares.push_back(square.real());
  }
  std::ranges::sort(squares);
  return squares;
}

}  // namespace tress
