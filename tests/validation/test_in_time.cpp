#include <gsl/gsl_sf_ellint.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/validation/chain.h"
#include "experiments/validation/pendulum.h"
#include "experiments/validation/ringing.h"

namespace tress {
namespace {

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

// ---- the measurements -------------------------------------------------------------

std::vector<ValidationTest> tests_in_time() {
  std::vector<ValidationTest> all;
  for (auto* family : {pendulum_tests, chain_tests, ringing_tests}) {
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

}  // namespace
}  // namespace tress
