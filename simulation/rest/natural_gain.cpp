#include "simulation/rest/natural_gain.h"

#include <Eigen/Core>

#include "linear/dense_algebra.h"

namespace tress::simulation {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<double> coordinates_at_start(const System& system) {
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  std::vector<double> q(n), v(n);
  system.initial_state(q, v);
  return q;
}

MatrixXd natural_gain(DenseStatics& statics, NaturalStrains& strains) {
  if (strains.strains_are_coordinates()) {
    const std::vector<double> stiffness = strains.natural_stiffness();
    const Eigen::Map<const VectorXd> k(stiffness.data(), std::ssize(stiffness));
    return MatrixXd(k.cwiseInverse().asDiagonal());
  }
  constexpr double ridge = 1e-10;  // for strains that no displacement feels
  const MatrixXd slope = statics.by_natural(strains);
  const auto displaced = [&](const MatrixXd& r) {
    return MatrixXd(statics.scale().cwiseInverse().asDiagonal() *
                    statics.displacement(solution(statics.stiffness(), r)));
  };
  const MatrixXd unit = MatrixXd::Identity(slope.rows(), slope.rows());
  return -least_squares(displaced(slope), displaced(unit), ridge);
}

}  // namespace tress::simulation
