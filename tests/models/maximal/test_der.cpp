#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <numbers>

#include "experiments/harness/fit.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/rod_edge.h"
#include "tests/models/reduced/static_equilibrium.h"

namespace tress {
namespace {

using namespace testing_support;

// A rod of L = 1 m, EI = 1 N m^2 and radius 1 mm, so that Gamma is the weight in N and
// EA L^2/EI = 4e6: under Gamma it stretches by Gamma/4e6 at most.
constexpr double line_density = std::numbers::pi * 1e-3;  // kg/m
const ModelSettings unit_rod = {{"length_m", "1"},
                                {"radius_m", "0.001"},
                                {"density_kg_m3", "1000"},
                                {"youngs_modulus_pa", "1273239544735.1628"},
                                {"poisson_ratio", "0.4"}};

TEST(Der, CantileverApproachesTheGravitoBendingCurveAtOrder2) {
  struct Master {
    double gamma, width, height;
  };
  for (const Master& exact : {Master{1, 0.9912463953466362, 0.1234714019833512},
                              Master{10, 0.6563537612385990, 0.7001997155143134},
                              Master{100, 0.1592233826284426, 0.9375239353963470}}) {
    std::vector<double> sizes, errors;
    for (const int n : {5, 10, 20, 40, 80, 160, 320}) {
      const Hung hung = hang("der", with(unit_rod, {{"elements", std::to_string(n)}}),
                             exact.gamma / line_density);
      const std::vector<double> x = points(hung);
      const double ratio = -x[x.size() - 1] / x[x.size() - 3];
      sizes.push_back(1.0 / n);
      errors.push_back(std::abs(ratio / (exact.height / exact.width) - 1));
      std::printf("der, Gamma = %g, N = %d: H/W off by %.2e\n", exact.gamma, n,
                  errors.back());
    }
    EXPECT_LE(errors[3], 0.01);
    // Lumping makes the tip hang too low, 2 tan(angle/2) too high: for Gamma = 10 and 100
    // both cancel near N = 10, and only beyond, where next terms are (kappa h)^2 = 2
    // Gamma h^2 of either, 0.03 for the largest load and h here, does one h^2 show.
    const std::vector<double> last_sizes(sizes.end() - 3, sizes.end());
    const std::vector<double> last_errors(errors.end() - 3, errors.end());
    EXPECT_NEAR(log_log_slope(last_sizes, last_errors), 2, 0.1);
  }
}

/// Natural curvature 18.04/L and twist 3.588/L, clamped with its tangent down, Gamma =
/// 35.8678125, GJ/EI = 1/1.4: the tip of Kirchhoff's rod, as in
/// tests/models/reduced/test_cantilever.cpp.
TEST(Der, CurlyHairApproachesKirchhoffsRod) {
  const Vec tip{0.1575486055087, 0.00707793852891, -0.2017219830847};
  std::vector<double> sizes, away;
  for (const int n : {20, 40, 80, 160}) {
    const Hung hung = hang("der",
                           with(unit_rod, {{"elements", std::to_string(n)},
                                           {"root_tangent", "down"},
                                           {"natural_curvature2_1_m", "18.0361544841071"},
                                           {"natural_twist_1_m", "3.58817892564338"}}),
                           35.8678125 / line_density);
    const std::vector<double> x = points(hung);
    const Vec off = load3(&x[x.size() - 3]) - tip;
    sizes.push_back(1.0 / n);
    away.push_back(std::sqrt(dot(off, off)));
    std::printf("der, N = %d: tip of the curl off by %.2e L\n", n, away.back());
  }
  EXPECT_LE(away[2], 5e-3);
  // (kappa h)^2/4 of the leading error at the coarsest of the three, 0.05.
  EXPECT_NEAR(
      log_log_slope({sizes.begin() + 1, sizes.end()}, {away.begin() + 1, away.end()}), 2,
      0.1);
}

/// Frequencies of small vibrations of a straight, clamped hair over sqrt(EI/(rho S L^4)),
/// lowest first, each twice (two planes).
std::vector<double> frequencies(int elements) {
  const auto system =
      make_model("der", {{"elements", std::to_string(elements)}, {"gravity_m_s2", "0"}});
  const auto n = static_cast<Eigen::Index>(system->layout().coordinates);
  State start = initial_state(*system);
  SparseForm& form = *system->sparse_form();
  const Pattern& pattern = form.pattern();
  const auto dense = [&](Weights w) {
    std::vector<double> values(static_cast<std::size_t>(pattern.nonzeros()));
    EXPECT_EQ(form.values(0, start.q, start.v, start.v, w, values), Status::ok);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto column = static_cast<std::size_t>(j);
      for (int k = pattern.start[column]; k < pattern.start[column + 1]; ++k) {
        matrix(pattern.row[static_cast<std::size_t>(k)], j) =
            values[static_cast<std::size_t>(k)];
      }
    }
    return matrix;
  };
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(dense({0, 0, 1}),
                                                                        dense({1, 0, 0}));
  const double unit = std::sqrt(3e9 * 40e-6 * 40e-6 / 4 / 1300) / (0.1 * 0.1);
  std::vector<double> all;
  for (Eigen::Index i = 0; i < 6; ++i) {
    all.push_back(std::sqrt(modes.eigenvalues()[i]) / unit);
  }
  return all;
}

TEST(Der, VibratesAsTheBeamOfEulerAndBernoulli) {
  constexpr double beam[] = {1.875104068711961, 4.694091132974175, 7.854757438237613};
  std::vector<double> sizes, errors;
  for (const int n : {10, 20, 40}) {
    const std::vector<double> found = frequencies(n);
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double exact = beam[k] * beam[k];
      worst = std::max(worst, std::abs(found[2 * k] / exact - 1));
      // Both planes alike to the rounding of eigenvalues 1e7 times smaller than those of
      // stretching, EA L^2/EI = 2.5e7.
      EXPECT_NEAR(found[2 * k + 1] / found[2 * k], 1, 1e-6);
      std::printf("der, N = %d, mode %zu: off by %.2e\n", n, k + 1,
                  found[2 * k] / exact - 1);
    }
    sizes.push_back(1.0 / n);
    errors.push_back(worst);
  }
  EXPECT_LE(errors.back(), 0.01);
  // The next term is (beta h)^2/10 of the first for the third mode: 0.06 at N = 10.
  EXPECT_NEAR(log_log_slope(sizes, errors), 2, 0.1);
}

/// Rigid turning of a free strand takes every edge far from its reference: frames, spins
/// and energy must not jump when it gets a new one.
TEST(Der, NewReferenceFramesLeaveTheMotionAsItIs) {
  const auto system = make_model("der", {{"elements", "6"},
                                         {"root", "free"},
                                         {"natural_curvature_1_m", "40"},
                                         {"natural_twist_1_m", "30"},
                                         {"gravity_m_s2", "0"}});
  State state = initial_state(*system);
  const std::size_t nodes = 7, angles = 3 * nodes;
  const Frame turn = rotation({0, 0.6, 0.8}, 1.3);  // 74 degrees
  for (std::size_t i = 0; i < nodes; ++i) {
    store3(turn * load3(&state.q[3 * i]) + Vec{0, 0, 1e-3 * std::sin(i)},
           &state.q[3 * i]);
    store3(Vec{std::cos(i), 1, std::sin(i)}, &state.v[3 * i]);
  }
  for (std::size_t k = angles; k < state.q.size(); ++k) state.q[k] = 0.3;
  Energetics& energetics = *system->energetics();
  const std::vector<double> zero = zeros(*system);
  const double before = energetics.energy(0, state.q, state.v).potential;
  const std::vector<double> force = residual(*system, state.q, zero, zero);
  std::vector<double> work(1);
  for (std::size_t k = 0; k < zero.size(); ++k) work[0] += force[k] * state.v[k];

  EXPECT_TRUE(system->accept(0, state.q, state.v));
  EXPECT_FALSE(system->accept(0, state.q, state.v));
  EXPECT_NEAR(energetics.energy(0, state.q, state.v).potential / before, 1, 1e-12);
  // Forces on nodes change with the meaning of the angles' rates, their work does not.
  const std::vector<double> after = residual(*system, state.q, zero, zero);
  double now = 0;
  for (std::size_t k = 0; k < zero.size(); ++k) now += after[k] * state.v[k];
  EXPECT_NEAR(now / work[0], 1, 1e-10);
}

/// Turning an edge around a cone and back leaves no trace while its reference stays;
/// with a new one on the way the frame comes back turned about the edge by the area that
/// the tangent went around on the sphere, 2 pi (1 - cos 35 deg).
TEST(Der, HolonomyIsTheAreaAroundWhichTheTangentWent) {
  using std::numbers::pi;
  const double cone = 70 * pi / 180 / 2;
  const Vec axis{std::cos(cone), 0, std::sin(cone)};
  Frame reference, frame = edge_frame(reference, Vec{1, 0, 0}, 0.0);
  for (const bool renew : {false, true}) {
    reference = frame = Frame{};
    constexpr int steps = 3600;
    for (int i = 1; i <= steps; ++i) {
      const Vec t = rotation(axis, 2 * pi * i / steps) * Vec{1, 0, 0};
      frame = edge_frame(reference, t, 0.0);
      if (renew) reference = frame;
    }
    const double turned = joint_strain(Frame{}, frame).x;
    const double area = 2 * pi * (1 - std::cos(cone));
    std::printf("holonomy %s: %.6f rad, area %.6f\n", renew ? "renewed" : "kept", turned,
                area);
    if (renew) {
      // Steps of angle 2 pi sin(35 deg)/3600 = 1e-3 leave the area off by its square.
      EXPECT_NEAR(std::abs(turned), area, 1e-5);
    } else {
      EXPECT_NEAR(turned, 0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace tress
