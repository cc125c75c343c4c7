#include "linear/rank.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>

namespace tress {

using Sparse = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

struct NullSpace::Basis {
  Sparse n;
  Eigen::SimplicialLDLT<Sparse> gram;  // N^T N
};

namespace {

Eigen::Map<const Vector> mapped(In x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

}  // namespace

NullSpace::NullSpace(const Pattern& pattern, In gt, In rows, In columns)
    : basis_(std::make_unique<Basis>()) {
  Sparse a =
      Eigen::Map<const Sparse>(pattern.rows, pattern.cols, pattern.nonzeros(),
                               pattern.start.data(), pattern.row.data(), gt.data());
  a = mapped(rows).asDiagonal() * a * mapped(columns).asDiagonal();
  a.makeCompressed();

  Eigen::SparseQR<Sparse, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(dependence);
  qr.compute(a);
  const Eigen::Index rank = qr.rank();
  const Eigen::Index missing = pattern.cols - rank;

  const Sparse r = qr.matrixR();
  const Sparse r11 = r.block(0, 0, rank, rank);
  Sparse dependent = r.block(0, rank, rank, missing);
  if (missing > 0) r11.triangularView<Eigen::Upper>().solveInPlace(dependent);

  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < missing; ++j) {
    for (Sparse::InnerIterator it(dependent, j); it; ++it) {
      entries.emplace_back(static_cast<int>(it.row()), j, -it.value());
    }
    entries.emplace_back(static_cast<int>(rank) + j, j, 1.0);
  }
  Sparse unpermuted(pattern.cols, missing);
  unpermuted.setFromTriplets(entries.begin(), entries.end());
  basis_->n = mapped(columns).asDiagonal() * Sparse(qr.colsPermutation() * unpermuted);
  for (int j = 0; j < missing; ++j) basis_->n.col(j) /= basis_->n.col(j).norm();
  if (missing > 0) basis_->gram.compute(Sparse(basis_->n.transpose() * basis_->n));
}

NullSpace::~NullSpace() = default;

int NullSpace::dimension() const { return static_cast<int>(basis_->n.cols()); }

void NullSpace::project_out(InOut y) const {
  if (dimension() == 0) return;
  Eigen::Map<Vector> target(y.data(), static_cast<Eigen::Index>(y.size()));
  // The second pass removes the rounding error left by an ill-conditioned N^T N.
  for (int pass = 0; pass < 2; ++pass) {
    const Vector part = basis_->n.transpose() * target;
    target -= basis_->n * basis_->gram.solve(part);
  }
}

}  // namespace tress
