#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "tests/models/reduced/kirchhoff.h"

namespace tress::test_super_clothoid {

using namespace experiments;
using namespace testing_support;

// Length 1 m, EI 1 N m^2; a mass of 0.314 kg.
const ModelSettings unit_rod = {{"length_m", "1"},
                                {"radius_m", "0.01"},
                                {"density_kg_m3", "1000"},
                                {"youngs_modulus_pa", "127323954.47351627"},
                                {"poisson_ratio", "0.4"}};

// The bars are those measured of the continuous equations with 30 and 60 more terms.
TEST(SuperClothoid, CurlyHairHangsAtOrder4) {
  std::vector<double> sizes, away, energy_off;
  for (const std::size_t n : {12U, 24U, 48U}) {
    const CurlyError error = curly_error("super_clothoid", unit_rod, n);
    sizes.push_back(1.0 / static_cast<double>(n));
    away.push_back(error.points);
    energy_off.push_back(error.energy);
    std::printf("N = %zu: points off by %.2e L, energy by %.2e\n", n, away.back(),
                energy_off.back());
  }
  EXPECT_LE(away[0], 1.5e-3);
  EXPECT_LE(away[1], 7e-5);
  EXPECT_GE(log_log_slope(sizes, away), 3.8);
  EXPECT_GE(log_log_slope(sizes, energy_off), 3.8);
}

// The moment of small loads is quadratic along the rod; the part of it that no linear
// function holds is orthogonal to the lever of the height, so that the error is of second
// order in Gamma, and terms h^6 count more: elements of L/8. The boundary layer at the
// clamp, Gamma^-1/2 L long, takes two.
TEST(SuperClothoid, ApproachesTheGravitoBendingCurveAtOrder4) {
  for (const Master& exact : master_curve) {
    std::vector<double> sizes, errors;
    for (const int n :
         exact.gamma < 50 ? std::vector{8, 16, 32} : std::vector{24, 48, 96}) {
      sizes.push_back(1.0 / n);
      errors.push_back(master_error("super_clothoid", unit_rod, exact, n));
      std::printf("Gamma = %g, N = %d: H/W off by %.2e\n", exact.gamma, n, errors.back());
    }
    EXPECT_GE(log_log_slope(sizes, errors), 3.8) << exact.gamma;
  }
}

/// The tip at t of a rod let go from a horizontal line, Gamma = 10, in its plane.
std::vector<Vec> released(const std::string& model, int elements, double step) {
  const double g = 10 / line_density;
  const auto system =
      make_model(model, with(unit_rod, {{"elements", std::to_string(elements)},
                                        {"root_tangent", "x"},
                                        {"modes", "bend_planar"},
                                        {"gravity_m_s2", text(g)}}));
  Options options;
  options.step = step;
  options.newton_tolerance = 1e-11;
  MaterialPoints& points = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  std::vector<Vec> tips;
  const Simulation run =
      simulate("implicit_midpoint", *system, options, initial_state(*system),
               4 / std::sqrt(g), [&](double t, In q, In) {
                 points.positions(t, q, x);
                 tips.push_back(load3(&x[x.size() - 3]));
                 return true;
               });
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  return tips;
}

// Errors of space alone: all by the same steps. The farthest over four times sqrt(L/g),
// three swings.
TEST(SuperClothoid, OfAReleasedRodThreeElementsAreWithin1PercentAndSixWithinATenth) {
  const double step = 1 / std::sqrt(10 / line_density) / 400;
  const std::vector<Vec> fine = released("super_clothoid", 24, step);
  const auto error = [&](const std::string& model, int elements) {
    const std::vector<Vec> tips = released(model, elements, step);
    EXPECT_EQ(tips.size(), fine.size());
    double most = 0;
    for (std::size_t i = 0; i < tips.size(); ++i) {
      most = std::max(most, norm(tips[i] - fine[i]));
    }
    std::printf("%s, %d elements: %.2e L\n", model.c_str(), elements, most);
    return most;
  };
  const double of_three = error("super_clothoid", 3);
  EXPECT_LE(of_three, 1e-2);
  EXPECT_LE(error("super_clothoid", 6), 1e-3);
  EXPECT_GT(error("super_helix", 12), of_three);
}

// In units of the rod, sqrt(rho S L^4/EI).
TEST(SuperClothoid, RecursionIsTheDenseSolutionAtManyElementsAndShortSteps) {
  const double h = 1e-3 * std::sqrt(line_density);
  for (const std::string jacobian : {"elastic", "exact"}) {
    for (const std::string curvature : {"0", "18"}) {
      const ModelSettings settings =
          with(unit_rod, {{"elements", "40"},
                          {"jacobian", jacobian},
                          {"natural_curvature_per_m", curvature},
                          {"natural_twist_per_m", "3"}});
      const auto recursive =
          make_model("super_clothoid", with(settings, {{"solver", "recursive"}}));
      const auto dense =
          make_model("super_clothoid", with(settings, {{"solver", "composite"}}));
      for (unsigned seed = 1; seed <= 3; ++seed) {
        States s(*dense, seed);
        s.shake(0.5);
        std::vector<double> b = zeros(*dense), x = b, y = b;
        ASSERT_EQ(dense->residual(t0, s.q, s.v, s.a, b), Status::ok);
        for (System* one : {recursive.get(), dense.get()}) {
          ASSERT_EQ(one->linearize(t0, s.q, s.v, s.a, {1, h, h * h}), Status::ok);
          ASSERT_EQ(one->solve(b, one == dense.get() ? y : x), Status::ok);
        }
        const double difference = relative_difference(x, y, s.a_typ);
        std::printf("%s, curvature %s: %.1e\n", jacobian.c_str(), curvature.c_str(),
                    difference);
        EXPECT_LE(difference, 1e-10);
      }
    }
  }
}

// A clothoid's curvature reaches where the means of helices only step.
TEST(SuperClothoid, TakesNaturalShapesThatVaryLinearly) {
  const Vec mean{3, 20, -7}, half{1, 12, 2};
  const auto shape = [&](double s) { return mean + (2 * s / 0.1 - 1) * half; };
  const Strand strand = make_strand({}, {}, {.elements = 2, .length = 0.1}, shape);
  EXPECT_LE(norm(strand.segments[1].natural - (mean + 0.5 * half)), 1e-13);
  EXPECT_LE(norm(strand.segments[1].natural_half - 0.5 * half), 1e-13);
  EXPECT_EQ(norm(strand.segments[1].initial_half - strand.segments[1].natural_half), 0);
  const Strand even =
      make_strand({}, {}, {.elements = 3, .length = 0.1}, uniform_shape(mean));
  for (const Segment& segment : even.segments) EXPECT_EQ(norm(segment.natural_half), 0);
  const Parameters parameters = parameters_of("super_clothoid", {});
  const auto system = find_model("super_clothoid").on_strand(strand, parameters, {});
  std::vector<double> q = zeros(*system), r = q;
  system->initial_state(q, r);
  EXPECT_NEAR(q[7], 26, 1e-12);
  EXPECT_NEAR(q[10], 6, 1e-12);
  const std::vector<double> zero = zeros(*system);
  ASSERT_EQ(system->residual(0, q, zero, zero, r), Status::ok);
  EXPECT_LE(largest(r), 1e-18);  // at rest: l EI of 1e-9 N m^3 times 1e-12/m
}

TEST(SuperClothoid, RefusesWhatItsPointsCannotTell) {
  for (const std::string points : {"1", "3"}) {
    EXPECT_THROW(make_model("super_clothoid", {{"quadrature", points}}), InputError);
  }
  EXPECT_THROW(make_model("super_clothoid",
                          {{"elements", "2"}, {"natural_curvature_per_m", "1e4"}}),
               InputError);
}

}  // namespace tress::test_super_clothoid
