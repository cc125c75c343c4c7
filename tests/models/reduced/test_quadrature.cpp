#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cstdio>
#include <numbers>
#include <random>

#include "math/vec3.h"
#include "models/reduced/reduced_strand.h"
#include "tests/models/reduced/static_equilibrium.h"

namespace tress::test_quadrature {

using namespace simulation;

using namespace testing_support;
using std::numbers::pi;

/// Of one element of Darboux vector kappa and length 1 m, thrown freely, without
/// rotational inertia: all that a longer strand's matrix is made of. Columns over (twist,
/// curvatures; translation; rotation) of the inverse dynamics, which are linear in a.
Eigen::MatrixXd mass_matrix(const Vec& kappa, int points) {
  const auto system =
      make_model("super_helix", {{"elements", "1"},
                                 {"length_m", "1"},
                                 {"natural_twist_per_m", text(kappa.x)},
                                 {"natural_curvature_per_m", text(kappa.y)},
                                 {"natural_curvature2_per_m", text(kappa.z)},
                                 {"quadrature", std::to_string(points)},
                                 {"motion", "free"},
                                 {"gravity_m_s2", "0"},
                                 {"rotary_inertia", "off"}});
  const State at = initial_state(*system);
  const std::vector<double> zero = zeros(*system);
  const auto n = static_cast<Eigen::Index>(zero.size());
  Eigen::MatrixXd m(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    std::vector<double> unit = zero;
    unit[static_cast<std::size_t>(j)] = 1;
    const std::vector<double> column = residual(*system, at.q, zero, unit);
    m.col(j) = Eigen::Map<const Eigen::VectorXd>(column.data(), n);
  }
  return m;
}

std::vector<Vec> directions() {
  std::vector<Vec> all = {{0, 1, 0}, {1, 0, 0}, {0.28, 0, 0.96}, {0.96, 0.28, 0}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  while (all.size() < 32) {
    const Vec x{uniform(random), uniform(random), uniform(random)};
    all.push_back(1 / norm(x) * x);
  }
  return all;
}

/// Largest error of an entry (i, j) of the mass matrix of an element that winds by
/// `angle`, over sqrt(M_ii M_jj) with the largest diagonal entry of each kind (curvature
/// and twist, translation, rotation). The inertia of twist alone vanishes with the
/// curvature; errors relative to it would too.
double error_of_rule(double angle, int points) {
  double worst = 0;
  for (const Vec& direction : directions()) {
    const Eigen::MatrixXd exact = mass_matrix(angle * direction, 64);
    Eigen::VectorXd scale(9);
    for (int kind = 0; kind < 9; kind += 3) {
      scale.segment<3>(kind).setConstant(
          1 / std::sqrt(exact.diagonal().segment<3>(kind).maxCoeff()));
    }
    const Eigen::MatrixXd error = mass_matrix(angle * direction, points) - exact;
    worst = std::max(
        worst, (scale.asDiagonal() * error * scale.asDiagonal()).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(Quadrature, ByDefaultIsWithin1e8OfTheIntegral) {
  double angle = 0.01;  // rad
  for (; angle < 6 * pi; angle *= 1.12) {
    EXPECT_LE(error_of_rule(angle, quadrature_points(angle)), 1e-8) << angle << " rad";
  }
  EXPECT_LE(error_of_rule(6 * pi, quadrature_points(6 * pi)), 1e-8);
  EXPECT_LE(error_of_rule(8 * pi, quadrature_points(8 * pi)), 1e-8);
}

TEST(Quadrature, ByDefaultTakesNoMorePointsThanThat) {
  // A rule of four points fewer misses it at most of the angles that take this one; the
  // steps of four, a SIMD pack, are short of 1e-8 by up to a tenth of the angle.
  for (const double angle : {0.33, 5.2, 10.8, 17.1}) {
    const int points = quadrature_points(angle);
    ASSERT_GT(points, 4) << angle;
    EXPECT_GT(error_of_rule(angle, points - 4), 1e-8) << angle;
  }
}

TEST(Quadrature, IsThatOfTheParameter) {  // 0 takes the default
  const Vec kappa{1, 2, 2};
  EXPECT_EQ(mass_matrix(kappa, 0), mass_matrix(kappa, quadrature_points(3)));
  EXPECT_NE(mass_matrix(kappa, 0), mass_matrix(kappa, 4));
}

// The table beside quadrature_points.
TEST(Quadrature, TableOfErrors) {
  std::printf("angle/pi");
  const std::array orders = {4, 8, 12, 16, 20};
  for (const int points : orders) std::printf("  %7d", points);
  for (const double turns : {0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    std::printf("\n%8g", turns);
    double previous = 10;
    for (const int points : orders) {
      const double error = error_of_rule(turns * pi, points);
      std::printf("  %7.0e", error);
      EXPECT_LE(error, std::max(previous, 1e-14));  // down to rounding
      previous = error;
    }
  }
  std::printf("\n");
}

}  // namespace tress::test_quadrature
