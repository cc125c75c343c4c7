#include "experiments/numerics/linear_modes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/dense_form.h"

namespace tress::experiments {

LinearModes linear_modes(System& system, In q) {
  const Eigen::MatrixXd mass = dense_mass(system, 0, q);
  const Eigen::MatrixXd stiffness = dense_stiffness(system, 0, q);
  const Eigen::MatrixXd dynamics = solution(mass, stiffness);
  LinearModes modes;
  modes.slowest_rad_s = std::numeric_limits<double>::infinity();
  // A double real eigenvalue is computed as a pair sqrt(eps) apart.
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

}  // namespace tress::experiments
