#include "linear/least_norm.h"

#include <Eigen/Core>
#include <algorithm>

#include "linear/dense_algebra.h"
#include "linear/vector_ops.h"

namespace tress {

bool LeastNorm::factor(In columns, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd a = Eigen::Map<const Eigen::MatrixXd>(columns.data(), n, n);
  if (!a.allFinite()) return false;
  scale_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    auto row = a.row(static_cast<Eigen::Index>(i));
    const double largest = row.cwiseAbs().maxCoeff();
    scale_[i] = largest > 0 ? 1 / largest : 0;
    row *= scale_[i];
  }
  const Eigen::MatrixXd inverse = pseudoinverse(a, dependence);
  inverse_.assign(inverse.data(), inverse.data() + inverse.size());
  return true;
}

void LeastNorm::solve(InOut b) const {
  const std::size_t n = scale_.size();
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) {
    add(x, scale_[i] * b[i], In(inverse_).subspan(i * n, n));
  }
  std::ranges::copy(x, b.begin());
}

}  // namespace tress
