#include "experiments/numerics/small_motions.h"

#include <algorithm>

#include "experiments/numerics/dense_algebra.h"

namespace tress::experiments {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

bool symmetric(const MatrixXd& matrix) {
  // Differences of a residual make a symmetric matrix only to 1e-9 of its largest entry.
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
  while (!is_definite(definite)) {
    shift = shift == 0 ? first : 4 * shift;
    definite = stiffness + shift * mass;
  }
  const auto [values, vectors] = symmetric_eigenpairs(mass, definite);
  std::vector<SmallMotion> all;
  for (auto k = values.size(); k-- > 0;) {
    all.push_back({1 / values[k] - shift, vectors.col(k)});
  }
  return all;
}

/// M and K on the subspace that satisfies the conditions.
struct Reduced {
  MatrixXd right, mass, stiffness;
};
Reduced reduced(const MatrixXd& mass, const MatrixXd& stiffness, const MatrixXd& columns,
                const MatrixXd& rows, In typical) {
  const Eigen::Map<const VectorXd> size(typical.data(), mass.rows());
  const MatrixXd right =
      size.asDiagonal() * complement(size.asDiagonal() * rows.transpose());
  const MatrixXd left = size.asDiagonal() * complement(size.asDiagonal() * columns);
  return {right, left.transpose() * mass * right, left.transpose() * stiffness * right};
}

}  // namespace

std::vector<SmallMotion> small_motions(const MatrixXd& mass, const MatrixXd& stiffness,
                                       const MatrixXd& columns, const MatrixXd& rows,
                                       In typical) {
  const auto [right, m, k] = reduced(mass, stiffness, columns, rows, typical);
  std::vector<SmallMotion> all;
  if (symmetric(m) && symmetric(k)) {
    all = of_symmetric((m + m.transpose()) / 2, (k + k.transpose()) / 2);
    for (SmallMotion& motion : all) motion.shape = right * motion.shape;
  } else {
    const auto [values, vectors] = real_eigenpairs(solution(m, k));
    for (Eigen::Index j = 0; j < m.rows(); ++j) {
      all.push_back({values[j], right * vectors.col(j)});
    }
    std::ranges::sort(all, {}, &SmallMotion::square);
  }
  return all;
}

std::vector<std::complex<double>> squares_of_motions(const MatrixXd& mass,
                                                     const MatrixXd& stiffness,
                                                     const MatrixXd& columns,
                                                     const MatrixXd& rows, In typical) {
  const auto [right, m, k] = reduced(mass, stiffness, columns, rows, typical);
  const Eigen::VectorXcd values = eigenvalues(solution(m, k));
  std::vector<std::complex<double>> all(values.begin(), values.end());
  std::ranges::sort(all, {}, [](const auto& square) { return square.real(); });
  return all;
}

}  // namespace tress::experiments
