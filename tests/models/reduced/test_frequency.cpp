#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdio>
#include <numbers>

#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/fit.h"
#include "tests/models/reduced/static_equilibrium.h"

namespace tress::test_frequency {

using namespace experiments;

using namespace testing_support;

struct Hair {
  double length, radius, youngs_modulus, density;
};

/// First frequency over sqrt(EI/(rho S L^4)) of a straight strand, clamped, without
/// gravity: of K x = omega^2 M x, with the columns of M from the inverse dynamics, linear
/// in a, and those of K from the static residual, linear in q about the straight strand.
double first_frequency(const std::string& model, int elements, const Hair& hair) {
  const auto system = make_model(model, {{"modes", "bend_planar"},
                                         {"elements", std::to_string(elements)},
                                         {"length_m", text(hair.length)},
                                         {"radius_m", text(hair.radius)},
                                         {"youngs_modulus_pa", text(hair.youngs_modulus)},
                                         {"density_kg_m3", text(hair.density)},
                                         {"gravity_m_s2", "0"}});
  const int n = system->layout().coordinates;
  const std::vector<double> zero = zeros(*system);
  Eigen::MatrixXd mass(n, n), stiffness(n, n);
  for (int j = 0; j < n; ++j) {
    std::vector<double> unit = zero;
    unit[static_cast<std::size_t>(j)] = 1;
    const std::vector<double> by_a = residual(*system, zero, zero, unit);
    const std::vector<double> by_q = residual(*system, unit, zero, zero);
    mass.col(j) = Eigen::Map<const Eigen::VectorXd>(by_a.data(), n);
    stiffness.col(j) = Eigen::Map<const Eigen::VectorXd>(by_q.data(), n);
  }
  const Eigen::VectorXd squares = symmetric_eigenpairs(stiffness, mass).values;
  const double bending =
      hair.youngs_modulus * std::numbers::pi * std::pow(hair.radius, 4) / 4;
  const double mass_per_length =
      hair.density * std::numbers::pi * hair.radius * hair.radius;
  return std::sqrt(squares[0] * mass_per_length * std::pow(hair.length, 4) / bending);
}

constexpr Hair usual{0.1, 40e-6, 3e9, 1300};
// (beta L)^2 of cosh(beta L) cos(beta L) = -1, the clamped-free beam of Euler and
// Bernoulli.
constexpr double beam = 3.5160152685001512;

class Frequency : public testing::TestWithParam<const char*> {};

TEST_P(Frequency, ApproachesTheBeamAtOrder2) {
  std::vector<double> sizes, errors;
  for (const int n : {5, 10, 20, 40}) {
    const double frequency = first_frequency(GetParam(), n, usual);
    sizes.push_back(1.0 / n);
    errors.push_back(std::abs(frequency / beam - 1));
    std::printf("%s, N = %d: %.9f, off by %.2e\n", GetParam(), n, frequency,
                errors.back());
  }
  // The next term, (beta h)^2/10 or so of the first, is 0.014 at N = 5.
  EXPECT_NEAR(log_log_slope(sizes, errors), 2, 0.02);
}

TEST_P(Frequency, ScalesWithLengthSectionAndMaterial) {
  const double expected = first_frequency(GetParam(), 10, usual);
  for (const Hair& hair : {Hair{0.01, 20e-6, 1e6, 1300}, Hair{0.5, 20e-6, 1e10, 900},
                           Hair{0.1, 1e-3, 1e6, 2000}, Hair{1, 1e-3, 1e10, 1300}}) {
    // Rounding of M, 1e-16 of its largest entry, on its condition of 1e5 at N = 10.
    EXPECT_NEAR(first_frequency(GetParam(), 10, hair) / expected, 1, 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Reduced, Frequency,
                         testing::Values("super_helix", "articulated_chain"));

}  // namespace tress::test_frequency
