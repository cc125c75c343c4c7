// Strands that touch, by tolerance: every strand takes its own steps between exchanges,
// whose intervals are under the same control.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simulation/run/world.h"

namespace tress::test_exchange {

using namespace simulation;

/// Two hairs, or `count`, clamped 2 mm apart and 9 cm from each other, swing down and
/// against each other, and drag each other along.
Scene meeting(const std::string& integrator, const std::string& coupling = "lagged",
              const std::string& model = "super_helix") {
  return parse_scene(
      "title = \"meeting\"\nduration_s = 0.3\n[model]\nid = \"" + model +
          "\"\n[integrator]\n" + integrator +
          "\n[material]\nname = \"hair.asian\"\n"
          "[[strand]]\nlength_m = 0.1\nelements = 8\nroot_tangent = [1, 0, 0]\n"
          "[[strand]]\nlength_m = 0.1\nelements = 10\nroot_tangent = [-1, 0.01, 0]\n"
          "position_m = [0.09, 0.002, 0.004]\n[root]\nmotion = \"fixed\"\n"
          "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = 2e-5\n"
          "[effects.strand_interaction]\nstiffness_n_m2 = 2\n"
          "viscosity_n_s_m2 = 1e-2\ncoupling = \"" +
          coupling + "\"\n",
      "meeting.toml");
}

Scene by_tolerance(const std::string& id, double tolerance,
                   const std::string& coupling = "lagged",
                   const std::string& model = "super_helix") {
  return meeting("id = \"" + id + "\"\nposition_tol_rel = " + std::to_string(tolerance),
                 coupling, model);
}

constexpr double frame = 0.05, end = 0.3;

/// Positions at every frame, one after the other.
std::vector<double> path(World& world) {
  std::vector<double> all;
  for (int i = 1; i <= std::lround(end / frame); ++i) {
    EXPECT_EQ(world.advance(i * frame), Status::ok) << world.failure();
    const std::vector<double>& x = world.positions();
    all.insert(all.end(), x.begin(), x.end());
  }
  return all;
}

std::vector<double> path(const Scene& scene) {
  World world(scene);
  return path(world);
}

/// Largest distance of a point over the length.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    most =
        std::max(most, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  }
  return most / 0.1;
}

/// By exchanges of fixed steps, whose error is c h + O(h^2): from h and h/2 without the
/// first term. Measured: 2e-5 away from the same with twice the steps.
const std::vector<double>& reference() {
  static const std::vector<double> made = [] {
    const std::vector<double> coarse = path(meeting("id = \"tr_bdf2\"\ndt_s = 1e-4"));
    std::vector<double> fine = path(meeting("id = \"tr_bdf2\"\ndt_s = 5e-5"));
    for (std::size_t i = 0; i < fine.size(); ++i) fine[i] += fine[i] - coarse[i];
    return fine;
  }();
  return made;
}
constexpr double reference_error = 5e-5;

class Exchange : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, Exchange, testing::Values("tr_bdf2", "esdirk43"));

TEST_P(Exchange, ErrorFollowsTheToleranceAndIntervalsItsRoot) {
  double accepted = 0;
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    World world(by_tolerance(GetParam(), tolerance));
    // Errors of steps and intervals add up over the swing, to a few times what one of
    // them may have.
    EXPECT_LE(difference(path(world), reference()), 3 * tolerance + reference_error)
        << tolerance;
    const Exchanges& done = world.exchanges();
    EXPECT_GT(done.shortest.h, 0);
    EXPECT_LT(done.shortest.at, end);
    // The estimate falls as h^2. At 1e-2 frames and the speed of approach cut intervals.
    if (tolerance == 1e-4) {
      EXPECT_NEAR(std::log10(static_cast<double>(done.accepted) / accepted), 0.5, 0.15);
    }
    accepted = static_cast<double>(done.accepted);
  }
}

/// What the test above measures is the interaction: without it the strands are elsewhere.
TEST(ExchangeByTolerance, StrandsPushEachOtherAside) {
  Scene apart = by_tolerance("tr_bdf2", 1e-3);
  apart.effects.pop_back();
  EXPECT_GT(difference(path(apart), reference()), 0.5);
}

/// As fast as at its start no point moves by more than half the reach in an interval,
/// relative to the mean of all; while speeds rise, by less than the reach. Errors of this
/// tolerance would let the strands pass each other in between.
TEST(ExchangeByTolerance, LooseTolerancesDoNotStepOverContacts) {
  World world(by_tolerance("esdirk43", 0.5));
  const std::vector<double> from = world.positions();
  ASSERT_EQ(world.advance(0.15), Status::ok) << world.failure();
  const std::vector<double>& to = world.positions();
  const std::size_t count = to.size() / 3;
  double far = 0;
  for (std::size_t axis : {0, 1, 2}) {
    double mean = 0;
    for (std::size_t i = axis; i < to.size(); i += 3) {
      mean += (to[i] - from[i]) / static_cast<double>(count);
    }
    for (std::size_t i = axis; i < to.size(); i += 3) {
      far = std::max(far, std::abs(to[i] - from[i] - mean));
    }
  }
  EXPECT_GT(far, 0.03);
  EXPECT_GE(static_cast<double>(world.exchanges().accepted),
            far / world.interaction()->reach());
}

TEST_P(Exchange, ThreadsDoNotChangeABit) {
  const Scene scene = by_tolerance(GetParam(), 1e-3);
  World one(scene), two(scene, 2);
  EXPECT_EQ(path(one), path(two));
  EXPECT_EQ(one.exchanges().accepted, two.exchanges().accepted);
  EXPECT_EQ(one.exchanges().rejected, two.exchanges().rejected);
  EXPECT_EQ(one.stats().residuals, two.stats().residuals);
}

TEST_P(Exchange, SnapshotsGoOnBitForBit) {
  const Scene scene = by_tolerance(GetParam(), 1e-3);
  World world(scene), other(scene);
  ASSERT_EQ(world.advance(0.123), Status::ok) << world.failure();
  const Snapshot middle = world.snapshot();
  EXPECT_EQ(middle.t, 0.123);
  world.restore(middle);
  other.restore(middle);
  EXPECT_EQ(world.exchanges().accepted, 0);
  for (World* const one : {&world, &other}) {
    ASSERT_EQ(one->advance(0.2), Status::ok) << one->failure();
    ASSERT_EQ(one->advance(0.3), Status::ok) << one->failure();
  }
  EXPECT_EQ(world.positions(), other.positions());
  EXPECT_EQ(world.velocities(), other.velocities());
  EXPECT_EQ(world.exchanges().accepted, other.exchanges().accepted);
}

/// Without drag across the gap nothing announces a contact: intervals have grown too long
/// for it, and the strands start again from where these began.
TEST(ExchangeByTolerance, ContactsThatComeSuddenlyRejectIntervals) {
  const auto dry = [](double tolerance) {
    Scene scene = by_tolerance("esdirk43", tolerance);
    scene.effects.back().parameters.set("viscosity_n_s_m2", "0");
    scene.effects.back().parameters.set("stiffness_n_m2", "20");
    return scene;
  };
  World world(dry(1e-4));
  EXPECT_LE(difference(path(world), path(dry(1e-6))), 3e-4);
  EXPECT_GT(world.exchanges().rejected, 0);
}

TEST(ExchangeByTolerance, EndsWithTheStrandAndTheTermThatNeedShorterIntervals) {
  Scene scene = by_tolerance("esdirk43", 1e-4);
  scene.options.min_step = 1e-3;  // its steps reach that, its exchanges do not
  World world(scene);
  ASSERT_NE(world.advance(end), Status::ok);
  EXPECT_THAT(world.failure(), testing::ContainsRegex(
                                   "strand [01]: tolerance 0.0001 needs exchanges with "
                                   "other strands less than 0.001 s apart at t = .* s, "
                                   "for the error of the (velocity|position) of point"));
  EXPECT_GT(world.exchanges().rejected, 0);
}

TEST(ExchangeByTolerance, AStrandThatFailsIsNamedAfterShorterIntervals) {
  Scene scene = by_tolerance("tr_bdf2", 1e-3);
  scene.options.max_work = 2e4;
  World world(scene);
  ASSERT_NE(world.advance(end), Status::ok);
  EXPECT_THAT(world.failure(), testing::ContainsRegex("strand [01]: max_work used up"));
  EXPECT_EQ(world.exchanges().rejected, 1);  // shorter ones would only use more
}

/// One system of all strands has no exchanges, and the same control.
TEST(ExchangeByTolerance, StrandsThatAreOneSystemFollowTheTolerance) {
  const std::vector<double> exact =
      path(by_tolerance("esdirk43", 1e-6, "monolithic", "der"));
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    World world(by_tolerance("tr_bdf2", tolerance, "monolithic", "der"));
    EXPECT_LE(difference(path(world), exact), 3 * tolerance) << tolerance;
    EXPECT_EQ(world.exchanges().accepted, 0);
  }
}

}  // namespace tress::test_exchange
