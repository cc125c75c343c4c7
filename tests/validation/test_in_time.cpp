#include <gsl/gsl_sf_ellint.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/validation/exact_rods.h"
#include "experiments/validation/pendulum.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/spring.h"
#include "experiments/validation/test.h"

namespace tress::test_in_time {

using namespace experiments;
using namespace experiments::validation;

ModelVariant model(std::string_view id) { return {&find_model(id), {}, ""}; }

// ---- the references ---------------------------------------------------------------

// The spring is 0.05 % of the moment of the weight at small angles: of that of omega^2
// between 1 and a/sin a times it, half of it of the period. It pulls to the side, which
// moves the middle by 0.05 % of a; the period goes with 1 + a^2/16.
TEST(PendulumPeriod, IsThatOfThePendulumWithoutSpring) {
  const double small = pendulum_period(1e-3);
  for (const double amplitude : {0.5, 1.0}) {
    const double longer = gsl_sf_ellint_Kcomp(std::sin(amplitude / 2), GSL_PREC_DOUBLE) *
                          2 / std::numbers::pi;
    EXPECT_NEAR(pendulum_period(amplitude) / small, longer,
                longer * 0.0005 *
                    (0.5 * amplitude / std::sin(amplitude) + amplitude * amplitude / 8));
  }
}

// 3/2 g/L, but for the hinge: 0.05 % of stiffness, 0.05 % of the length twice.
TEST(PendulumPeriod, IsThatOfARodAtSmallAngles) {
  const double simple = 2 * std::numbers::pi * std::sqrt(2 * 0.1 / (3 * 9.81));
  EXPECT_NEAR(pendulum_period(1e-3), simple, simple * (0.00025 + 0.0005));
}

TEST(FoldedChain, StartsFreelyAndEndsFaster) {
  for (const ValidationTest& test : chain_tests()) {
    if (test.name != "folded_chain") continue;
    // v^2 = 2 g x (1 + x/(2 L) + ...): a quarter of x/L.
    EXPECT_NEAR(test.reference(1e-3) / std::sqrt(2e-3), 1, 1e-3);
    EXPECT_NEAR(test.reference(0.5), std::sqrt(1.5), 1e-15);
  }
}

// Independent values: the same elastica by a two-parameter shooting with another
// Runge-Kutta code, to 1e-10.
TEST(PinnedElastica, AgreesWithAnotherShooting) {
  struct Known {
    double eps, friction, axial, tip;
  };
  constexpr Known table[] = {{0.0001, 0.00445130365308, 20.1914881049, 0.0249408026171},
                             {0.01, 0.0448536979315, 20.2667993757, 0.249954037879},
                             {0.1, 0.152792555407, 20.9586422056, 0.807292422616},
                             {0.3, 0.326491314201, 22.4177246593, 1.4813273888},
                             {0.8, 10.9879128887, 2.76943124831, 3.59238493552}};
  for (const Known& known : table) {
    const PinnedElastica rod = pinned_elastica(known.eps);
    EXPECT_NEAR(rod.lateral / rod.axial, known.friction,
                1e-9 * (1 + known.friction * known.friction))
        << known.eps;
    EXPECT_NEAR(rod.axial, known.axial, 1e-7) << known.eps;
    EXPECT_NEAR(rod.tip, known.tip, 1e-9) << known.eps;
  }
}

// Flat turns: k = GJ/(r^2 wire), omega = (pi/2) sqrt(k/m), and the wave that turns has EI
// in place of GJ. A pitch angle of 0.15 couples them by its square, 2 %, over how far
// apart they are, 1/3: 7 % at most.
TEST(SpringModes, AreNearlyLovesSpringOfFlatTurns) {
  const SpringModes modes = spring_modes(5);
  const double wire = TestRod().length, r = wire / (10 * std::numbers::pi);
  const double mass = TestRod().line_mass() * wire;
  const auto flat = [&](double stiffness) {
    return std::numbers::pi / 2 * std::sqrt(stiffness / (r * r * wire) / mass);
  };
  EXPECT_NEAR(modes.low / flat(TestRod().twisting()), 1, 0.07);
  EXPECT_NEAR(modes.high / flat(TestRod().bending()), 1, 0.07);
}

// ---- the measurements -------------------------------------------------------------

std::vector<ValidationTest> tests_in_time() {
  std::vector<ValidationTest> all;
  for (auto* family : {pendulum_tests, chain_tests, ringing_tests, spring_tests,
                       stick_slip_tests, wisp_tests}) {
    for (ValidationTest& test : family()) all.push_back(std::move(test));
  }
  return all;
}

double error(const ValidationTest& test, std::string_view id) {
  const Deadline deadline(60);
  const double parameter = test.quick.parameters.front();
  const double measured =
      test.measure({model(id), test.quick.elements.front(), parameter, deadline});
  return std::abs(measured / test.reference(parameter) - 1);
}

TEST(ValidationInTime, TwoModelsOfDifferentFamiliesPass) {
  for (const ValidationTest& test : tests_in_time()) {
    for (const std::string_view id : {"super_helix", "der"}) {
      EXPECT_LE(error(test, id), test.tolerance) << test.name << ", " << id;
    }
  }
}

// force_transport lets what lies beyond a joint move rigidly with it: it is no chain (a
// pulse does not run, the tip of a chain does not fall freely).
TEST(ValidationInTime, AModelThatIsNoChainFails) {
  for (const ValidationTest& test : chain_tests()) {
    if (test.name == "folded_chain") {
      EXPECT_THROW((void)error(test, "force_transport"), std::runtime_error);
    } else {
      EXPECT_GT(error(test, "force_transport"), test.tolerance) << test.name;
    }
  }
}

TEST(ValidationInTime, WhatDoesNotTwistIsRefusedTorsion) {
  for (const ValidationTest& test : ringing_tests()) {
    if (test.name != "torsion") continue;
    EXPECT_EQ(test.refusal(model("mass_spring")), "no twist");
    EXPECT_EQ(test.refusal(model("der")), "");
  }
}

}  // namespace tress::test_in_time
