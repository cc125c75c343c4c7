#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "models/effects/tether.h"
#include "tests/models/effects/settle.h"

namespace tress::test_tether {

using namespace models;

using testing_support::Cloud;
using testing_support::FreePoints;
using testing_support::load;
using testing_support::straight;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double always = 1e6;  // s

TEST(Tether, HoldsThePointThatCarriesThePlace) {
  Cloud strand(3);
  strand.length = {1, 2, 1};
  const auto held = [&](double at) {
    return Tether({.at = at, .off = always}).held(strand.points());
  };
  EXPECT_EQ(held(0), 0U);
  EXPECT_EQ(held(0.2), 0U);
  EXPECT_EQ(held(0.3), 1U);
  EXPECT_EQ(held(0.7), 1U);
  EXPECT_EQ(held(0.8), 2U);
  EXPECT_EQ(held(1), 2U);
  EXPECT_EQ(held(0.25 * (1 - 1e-15)), 0U);
  EXPECT_EQ(held(0.25 * (1 + 1e-15)), 0U);
}

TEST(Tether, HoldsOnePointOnly) {
  const Cloud strand = straight(4, 1, 1, 0);
  const Tether tether({.at = 0.4, .stiffness = 3, .target = {0, 0, 1}, .off = always});
  const auto f = load(tether, 1, strand.points());
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(f[i] != 0, i == 3 || i == 5) << i;
  EXPECT_DOUBLE_EQ(f[5], 3.0);
}

TEST(Tether, PullsWithTheGivenForceAndFadesAtItsTarget) {
  Cloud one(1);
  one.x = {3, 0, 4};
  one.v = {0, 0, 0};
  const Tether tether({.pull = 0.7, .soft = 1e-3, .off = always});
  const auto f = load(tether, 1, one.points());
  // 1/sqrt(1 + (soft/5)^2) = 1 - 2e-8
  EXPECT_NEAR(f[0], -0.6 * 0.7, 2e-8);
  EXPECT_NEAR(f[2], -0.8 * 0.7, 2e-8);
  one.x = {0, 0, 0};
  for (const double fx : load(tether, 1, one.points())) EXPECT_EQ(fx, 0);
}

TEST(Tether, ActsFromOnToOffOnly) {
  Cloud one(1);
  const Tether tether({.stiffness = 5, .on = 1, .off = 2, .ramp = 0.25});
  const auto force = [&](double t) { return load(tether, t, one.points())[0]; };
  const double full = -5 * one.x[0];
  EXPECT_EQ(force(0.9), 0);
  EXPECT_EQ(force(1), 0);
  EXPECT_NEAR(force(1.125), full / 2, 4 * eps * 5);
  EXPECT_EQ(force(1.3), full);
  EXPECT_NEAR(force(2.125), full / 2, 4 * eps * 5);
  EXPECT_EQ(force(2.3), 0);
  EXPECT_EQ(tether.potential(2.3, one.points()), 0);
  EXPECT_EQ(tether.power(2.3, one.points()), 0);
}

// The strength rises with a horizontal tangent at both ends: within 1e-4 of an end of the
// ramp it has changed by 3 1e-8.
TEST(Tether, NamesTheTimesBetweenWhichItIsSmooth) {
  const Tether tether({.stiffness = 5, .on = 1, .off = 2, .ramp = 0.25});
  double t = 0;
  for (const double next : {1.0, 1.25, 2.0, 2.25}) {
    EXPECT_EQ(tether.next_breakpoint(t), next);
    t = next;
  }
  EXPECT_EQ(tether.next_breakpoint(t), std::numeric_limits<double>::infinity());
}

TEST(Tether, TakesHoldSmoothly) {
  Cloud one(1);
  one.x = {-1, 0, 0};
  const Tether tether({.stiffness = 1, .on = 1, .off = 5, .ramp = 1});
  EXPECT_NEAR(load(tether, 1 + 1e-4, one.points())[0], 0, 3e-8);
  EXPECT_NEAR(load(tether, 2 - 1e-4, one.points())[0], 1, 3e-8);
}

// A critically damped oscillator, w = 10/s: after 5 s (1 + 50) exp(-50) of the way is
// left.
TEST(Tether, BringsItsPointToTheTarget) {
  Cloud one(1);
  one.mass = {0.02};
  const Tether tether(
      {.stiffness = 2, .damping = 0.4, .target = {0.3, -0.1, 0.2}, .off = always});
  FreePoints moving(one, {&tether});
  moving.run(5, 2000);
  EXPECT_NEAR(moving.place(0).x, 0.3, 1e-14);
  EXPECT_NEAR(moving.place(0).y, -0.1, 1e-14);
  EXPECT_NEAR(moving.place(0).z, 0.2, 1e-14);
}

TEST(Tether, OnAFixedTargetOnlyDissipates) {
  const Tether tether(
      {.stiffness = 2, .damping = 0.4, .pull = 1, .target = {0.3, 0, 0}, .off = always});
  for (unsigned seed = 1; seed < 50; ++seed) {
    const Cloud one(1, seed);
    EXPECT_LT(tether.power(1, one.points()), 0);
  }
}

TEST(Tether, RefusesNumbersOutsideTheirMeaning) {
  EXPECT_THROW(Tether({.at = 1.1}), InputError);
  EXPECT_THROW(Tether({.stiffness = -1}), InputError);
  EXPECT_THROW(Tether({.soft = 0}), InputError);
  EXPECT_THROW(Tether({.on = 2, .off = 1}), InputError);
  EXPECT_THROW(Tether({.ramp = 0}), InputError);
  EXPECT_THROW(Tether({.target = {0, std::nan(""), 0}}), InputError);
}

}  // namespace tress::test_tether
