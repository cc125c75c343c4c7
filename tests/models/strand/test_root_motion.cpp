#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "contract/input_error.h"
#include "models/motion/root_motion.h"
#include "tests/models/strand/parameters_for.h"

namespace tress::test_root_motion {

using namespace models;

using std::numbers::pi;
using testing_support::root_choices;
using testing_support::strand_parameters;
using testing_support::tangent_choices;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double largest(const Vec& a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

/// f'(t) by five points; error h^4/30 |f'''''| + 1.5 eps |f|/h.
template <class F>
Vec slope(const F& f, double t) {
  const double h = 1e-4;
  return 1 / (12 * h) * (8.0 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h)));
}

/// Every derivative of the pose against differences of what it is the derivative of.
/// Tolerance 1e-9: with h = 1e-4, angles a sin(wt), a = 0.5, w = 6 pi and arms of 0.1 m,
/// the largest fifth derivative belongs to v: sixth of 0.1 cos(a sin wt), below 0.1 w^6
/// sum_k S(6, k) a^k = 0.1 4.5e7 24 = 1.1e8, so h^4/30 times it is 4e-10; rounding of
/// omega <= 10: 1.5 10 eps/h = 3e-11. Slower motions lie below.
void expect_consistent(const RootMotion& motion, double t) {
  const RootPose pose = motion.at(t);
  const auto part = [&motion](auto member) {
    return [&motion, member](double s) { return member(motion.at(s)); };
  };
  const auto expect_slope = [t](const auto& f, const Vec& rate) {
    EXPECT_LE(largest(slope(f, t) - rate), 1e-9);
  };
  expect_slope(part([](const RootPose& p) { return p.x; }), pose.v);
  expect_slope(part([](const RootPose& p) { return p.v; }), pose.a);
  expect_slope(part([](const RootPose& p) { return p.frame.e0; }),
               cross(pose.omega, pose.frame.e0));
  expect_slope(part([](const RootPose& p) { return p.frame.e1; }),
               cross(pose.omega, pose.frame.e1));
  expect_slope(part([](const RootPose& p) { return p.frame.e2; }),
               cross(pose.omega, pose.frame.e2));
  expect_slope(part([](const RootPose& p) { return p.omega; }), pose.alpha);
}

/// Each turn rounds an axis by less than 10 eps; at most 3 turns and the dot product.
void expect_orthonormal(const Frame& f) {
  const Frame g{{dot(f.e0, f.e0), dot(f.e0, f.e1), dot(f.e0, f.e2)},
                {dot(f.e1, f.e0), dot(f.e1, f.e1), dot(f.e1, f.e2)},
                {dot(f.e2, f.e0), dot(f.e2, f.e1), dot(f.e2, f.e2)}};
  EXPECT_LE(largest(g.e0 - Vec{1, 0, 0}), 70 * eps);
  EXPECT_LE(largest(g.e1 - Vec{0, 1, 0}), 70 * eps);
  EXPECT_LE(largest(g.e2 - Vec{0, 0, 1}), 70 * eps);
  EXPECT_GT(dot(cross(f.e0, f.e1), f.e2), 0.5);
}

Signal constant(double value) {
  return [value](double) -> SignalValue { return {value, 0, 0}; };
}

/// Three axes that do not commute, through a centre off the root, and two translations.
RootMotion tumbling() {
  RootMotion motion;
  motion.position = {0.02, -0.05, 0.03};
  motion.centre = Vec{-0.04, 0.01, 0.02};
  motion.rotations = {{{1, 2, -2}, sine(0.5, 1)},
                      {{0, 0, 3}, one_minus_cosine(0.4, 0.7)},
                      {{1, 0, 1}, sine(0.3, 1.3)}};
  motion.translations = {{{0, 1, 2}, sine(0.03, 1)}, {{1, 1, 0}, smooth_step(0.1, 0, 1)}};
  return motion;
}

TEST(RootMotion, DerivativesAreThoseOfThePoseForEveryChoice) {
  for (const auto root : root_choices) {
    for (const auto tangent : tangent_choices) {
      SCOPED_TRACE(std::string(root) + " " + std::string(tangent));
      const RootMotion motion =
          root_motion(strand_parameters({{"motion", root}, {"root_tangent", tangent}}));
      check(motion, "root motion");
      // Off the instants where the third derivative jumps: 0, 0.01, 1/6 and 1/3 s.
      for (const double t : {-0.3, 0.003, 0.0085, 0.04, 0.13, 0.21, 0.32, 0.9}) {
        expect_consistent(motion, t);
        expect_orthonormal(motion.at(t).frame);
      }
    }
  }
}

TEST(RootMotion, DerivativesOfSeveralPartsAccumulate) {
  for (const double t : {-0.4, 0.0015, 0.2, 0.55, 0.83, 1.7}) {
    expect_consistent(tumbling(), t);
    expect_orthonormal(tumbling().at(t).frame);
  }
}

TEST(RootMotion, TakesTheFirstRotationFirst) {
  RootMotion motion;
  motion.rotations = {{{2, 0, 0}, constant(pi / 2)}, {{0, 0, 5}, constant(pi / 2)}};
  const RootPose pose = motion.at(0);
  // x -> x -> y,  y -> z -> z,  z -> -y -> x; cos(pi/2) rounds to 6e-17
  EXPECT_LE(largest(pose.frame.e0 - Vec{0, 1, 0}), 4 * eps);
  EXPECT_LE(largest(pose.frame.e1 - Vec{0, 0, 1}), 4 * eps);
  EXPECT_LE(largest(pose.frame.e2 - Vec{1, 0, 0}), 4 * eps);
}

TEST(RootMotion, TurnsTheRestFrameAboutWorldAxes) {
  RootMotion motion;
  motion.frame = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  motion.rotations = {{{0, 0, 1}, constant(pi / 2)}};
  EXPECT_LE(largest(motion.at(0).frame.e0 - Vec{-1, 0, 0}), 4 * eps);
  EXPECT_LE(largest(motion.at(0).frame.e1 - Vec{0, 0, 1}), 4 * eps);
}

TEST(RootMotion, CentreStaysAtItsDistanceAndDefaultsToTheRoot) {
  RootMotion motion = tumbling();
  motion.translations.clear();
  const auto distance = [&motion](double t) {
    const Vec arm = motion.at(t).x - *motion.centre;
    return norm(arm);
  };
  EXPECT_NEAR(distance(0.37), distance(0), 70 * eps * distance(0));
  EXPECT_GT(largest(motion.at(0.37).x - motion.at(0).x), 0.01);
  motion.centre.reset();
  EXPECT_EQ(largest(motion.at(0.37).x - motion.position), 0);
  EXPECT_EQ(largest(motion.at(0.37).v), 0);
}

TEST(RootMotion, RestsWithoutParts) {
  RootMotion motion;
  motion.position = {1, 2, 3};
  EXPECT_TRUE(motion.fixed());
  EXPECT_FALSE(tumbling().fixed());
  const RootPose pose = motion.at(5);
  EXPECT_EQ(largest(pose.x - motion.position), 0);
  EXPECT_EQ(largest(pose.v) + largest(pose.a), 0);
  EXPECT_EQ(largest(pose.omega) + largest(pose.alpha), 0);
}

TEST(Signal, SmoothStepJoinsItsEndsTwiceDifferentiably) {
  const Signal step = smooth_step(2, 1, 0.5);
  EXPECT_EQ(step(0.3).value, 0);
  EXPECT_DOUBLE_EQ(step(1.25).value, 1);
  EXPECT_DOUBLE_EQ(step(1.25).rate, 2 * 1.875 / 0.5);  // 30/16 at the middle
  EXPECT_DOUBLE_EQ(step(9).value, 2);
  for (const double t : {0.2, 1.0, 1.5, 3.0}) {
    EXPECT_EQ(step(t).rate, 0);
    EXPECT_EQ(step(t).acceleration, 0);
  }
}

TEST(Signal, StopTravelsAndRestsAfterHalfItsDuration) {
  const Signal signal = stop(3, 1, 0.5);
  EXPECT_DOUBLE_EQ(signal(0).value, -3);
  EXPECT_EQ(signal(1).value, 0);
  for (const double t : {0.0, 1.0}) EXPECT_EQ(signal(t).rate, 3);
  for (const double t : {1.5, 7.0}) {
    EXPECT_DOUBLE_EQ(signal(t).value, 3 * 0.5 / 2);
    EXPECT_EQ(signal(t).rate, 0);
  }
  for (const double t : {0.0, 1.0, 1.5, 7.0}) EXPECT_EQ(signal(t).acceleration, 0);
}

TEST(Signal, SineStartsAtZeroAndOneMinusCosineFromRest) {
  EXPECT_DOUBLE_EQ(sine(2, 0.25)(1).value, 2);
  EXPECT_DOUBLE_EQ(sine(2, 0.25)(0).rate, pi);
  EXPECT_EQ(one_minus_cosine(2, 0.5)(0).rate, 0);
  EXPECT_DOUBLE_EQ(one_minus_cosine(2, 0.5)(1).value, 4);
  EXPECT_DOUBLE_EQ(one_minus_cosine(2, 0.5)(0).acceleration, 2 * pi * pi);
}

TEST(RootMotion, NamesTheTimesBetweenWhichItsSignalsAreSmooth) {
  RootMotion motion;
  motion.translations = {{{1, 0, 0}, sum(sine(1, 1), smooth_step(1, 0.5, 1))}};
  motion.rotations = {{{1, 0, 0}, stop(1, 1, 2)}};
  double t = -1;
  for (const double next : {0.5, 1.0, 1.5, 3.0}) {
    EXPECT_EQ(motion.next_breakpoint(t), next);
    t = next;
  }
  EXPECT_EQ(motion.next_breakpoint(t), std::numeric_limits<double>::infinity());
}

/// What a motion carries is at its place at t = 0 and keeps its place in the frame of
/// another that the motion carries, also where the motion begins elsewhere. Products of
/// rotations round by some 10 eps, arms are below 1 m.
TEST(RootMotion, CarriesPlacesRigidly) {
  RootMotion motion = tumbling();
  motion.rotations.push_back({{0, 1, 1}, Signal([](double t) {
                                return SignalValue{0.4 + t, 1, 0};
                              })});
  const StrandPlace place{{0.1, 0.2, -0.3}, rotation({0, 0, 1}, 0.7)};
  const RootMotion of = carried(motion, place);
  EXPECT_LT(largest(of.at(0).x - place.x), 50 * eps);
  EXPECT_LT(largest(of.at(0).frame.e1 - place.frame.e1), 50 * eps);
  const auto seen = [&](double t) {
    const RootPose by = motion.at(t), one = of.at(t);
    return std::pair{by.frame.back(one.x - by.x), by.frame.back(one.frame.e1)};
  };
  for (const double t : {0.3, 1.7}) {
    EXPECT_LT(largest(seen(t).first - seen(0).first), 100 * eps);
    EXPECT_LT(largest(seen(t).second - seen(0).second), 100 * eps);
  }
}

TEST(RootMotion, RefusesWhatIsNoMotion) {
  const auto refuses = [](auto spoil) {
    RootMotion motion = tumbling();
    check(motion, "root");
    spoil(motion);
    EXPECT_THROW(check(motion, "root"), InputError);
  };
  refuses([](RootMotion& m) { m.position.z = nan; });
  refuses([](RootMotion& m) { m.centre->x = nan; });
  refuses([](RootMotion& m) { m.frame.e1 = {0, 1.1, 0}; });
  refuses([](RootMotion& m) { m.frame.e1 = {0, nan, 0}; });
  refuses([](RootMotion& m) { m.frame.e1 = {0, -1, 0}; });  // left-handed
  refuses([](RootMotion& m) { m.rotations[0].direction = {}; });
  refuses([](RootMotion& m) { m.rotations[1].signal = Signal{}; });
  refuses([](RootMotion& m) { m.translations[1].signal = Signal{}; });
  refuses([](RootMotion& m) { m.translations[0].direction.x = nan; });
  EXPECT_THROW(smooth_step(1, 0, 0), InputError);
  EXPECT_THROW(smooth_step(1, 0, nan), InputError);
  EXPECT_THROW(stop(1, 0, -1), InputError);
}

}  // namespace tress::test_root_motion
