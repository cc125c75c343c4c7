#include "experiments/harness/linear_modes.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <vector>

#include "experiments/harness/eigenvalues.h"

namespace tress {
namespace {

Eigen::VectorXd residual(System& system, In q, In a) {
  const std::vector<double> zero(q.size());
  Eigen::VectorXd r(static_cast<Eigen::Index>(q.size()));
  const Status s = system.residual(0, q, zero, a, {r.data(), q.size()});
  if (s != Status::ok) throw std::runtime_error("no residual at a state of rest");
  return r;
}

}  // namespace

LinearModes linear_modes(System& system, In q) {
  const std::size_t n = q.size();
  std::vector<double> q_typ(n), v_typ(n), a(n), moved(q.begin(), q.end());
  system.scale(q_typ, v_typ);
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd mass(size, size), stiffness(size, size);
  const Eigen::VectorXd forces = residual(system, q, a);
  // Differences of order 2: eps^(1/3).
  constexpr double step = 6e-6;
  for (std::size_t j = 0; j < n; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    a[j] = 1;
    mass.col(column) = residual(system, q, a) - forces;
    a[j] = 0;
    const double e = step * q_typ[j];
    moved[j] = q[j] + e;
    stiffness.col(column) = residual(system, moved, a);
    moved[j] = q[j] - e;
    stiffness.col(column) -= residual(system, moved, a);
    stiffness.col(column) /= 2 * e;
    moved[j] = q[j];
  }
  const Eigen::MatrixXd dynamics = mass.partialPivLu().solve(stiffness);
  LinearModes modes;
  modes.slowest_rad_s = std::numeric_limits<double>::infinity();
  // A double real eigenvalue computes to a pair apart by sqrt(eps).
  constexpr double real = 1e-7;
  for (const std::complex<double> square : eigenvalues(dynamics)) {
    const std::complex<double> s = std::sqrt(-square);
    modes.slowest_rad_s = std::min(modes.slowest_rad_s, std::abs(s));
    if (std::abs(square.imag()) > real * std::abs(square)) ++modes.complex_modes;
    if (std::abs(s.real()) > real * std::abs(s)) {
      modes.growth_1_s = std::max(modes.growth_1_s, std::abs(s.real()));
    }
  }
  return modes;
}

}  // namespace tress
