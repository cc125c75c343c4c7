// Euler's column: the load at which it buckles, its bent branch, and a little
// imperfection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "experiments/numerics/small_motions.h"
#include "experiments/statics/equilibrium_path.h"
#include "experiments/statics/path_rows.h"
#include "experiments/statics/path_words.h"
#include "models/catalogue.h"
#include "simulation/scene_changes/changes.h"
#include "tests/statics/static_scenes.h"

namespace tress::test_column {

using namespace experiments::statics;
using namespace testing_support;

constexpr double euler = std::numbers::pi * std::numbers::pi / 4;
const std::string planar_helix = "id = \"super_helix\"\nmodes = \"bend_planar\"";
const std::string planar_clothoid = "id = \"super_clothoid\"\nmodes = \"bend_planar\"";

/// Modulus k of the elastica of a clamped and free column: P L^2/EI = K(k)^2.
double modulus(double load) {
  double low = 0, high = 1 - 1e-12;
  for (int i = 0; i < 200; ++i) {
    const double k = (low + high) / 2;
    (std::pow(std::comp_ellint_1(k), 2) < load ? low : high) = k;
  }
  return low;
}

/// Tip of the elastica over the length: height 2 E/K - 1, to the side 2 k/K.
struct Tip {
  double side, height;
};
Tip tip_of_elastica(double load) {
  const double k = modulus(load), complete = std::comp_ellint_1(k);
  return {2 * k / complete, 2 * std::comp_ellint_2(k) / complete - 1};
}

/// Every model of a strand. 20 elements of order 2 err by 5e-4; helices, links and edges
/// agree on 0.206/n^2.
TEST(Column, OfEveryModelBucklesAtEulersLoad) {
  for (const models::ModelEntry& model : models::model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    const auto scene = simulation::parse_scene(column("id = \"der\"", 20), "column.toml");
    StaticStrand strand(simulation::with_method(scene, {&model, {}, "bdf2", {}}), 0,
                        varied(scene, "point_force=0..3", "--over"));
    const auto path = equilibrium_path(strand, {.resolution = 0.1});
    const std::vector<double> loads = values_at(path, Event::bifurcation);
    ASSERT_EQ(loads.size(), 1U) << model.id;
    std::printf("%s: %+.1e\n", std::string(model.id).c_str(), loads.front() / euler - 1);
    EXPECT_NEAR(loads.front() / euler, 1, 1e-3) << model.id;
    // Both planes, where the model has them.
    for (const PathPoint& point : path) {
      EXPECT_EQ(point.crossing, point.event == Event::bifurcation ? 2 : 0) << model.id;
      EXPECT_EQ(point.failure, "") << model.id;
      EXPECT_LE(point.correction, 1e-6) << model.id;
    }
    EXPECT_EQ(path.front().stability.negative, 0) << model.id;
    EXPECT_EQ(path.back().stability.negative, 2) << model.id;
  }
}

/// A range that descends: the factor 0..-3 on a force upwards is 0..3 on one downwards.
TEST(Column, BucklesOverARangeThatDescends) {
  const std::string down = column(planar_helix, 10);
  std::string up = down;
  up.replace(up.find("[0, 0, -"), 8, "[0, 0, ");
  const auto path = static_path(up, "point_force=0..-3", {.resolution = 0.1});
  const auto mirrored = static_path(down, "point_force=0..3", {.resolution = 0.1});
  ASSERT_EQ(path.size(), mirrored.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_EQ(path[i].event, mirrored[i].event);
    EXPECT_EQ(path[i].at.value, -mirrored[i].at.value);
  }
  EXPECT_EQ(path.back().event, Event::end);
  EXPECT_EQ(path.back().at.value, -3);
}

/// A tip on a spring of stiffness k that a support moves across by d: the spring pulls
/// with k (d - x), with x the way of the tip. The rod is much stiffer than the spring.
/// The displacement is that of the support.
TEST(Supports, OnSpringsHaveTheirForceAndDisplacement) {
  const double k = 1e-3, way = 1e-2;
  auto strand = static_strand(
      static_scene("id = \"super_helix\"", "length_m = 0.1\nelements = 8",
                   "[[supports]]\nslide = [1, 0, 0]\nstiffness_n_per_m = 1e-3\n"
                   "keyframes = [[0, 0.1, 0, 0], [1, 0.1, 0, -0.01]]\n"),
      "supports");
  const Gauge of = gauge(strand);
  const auto path = equilibrium_path(strand, {.resolution = 0.1});
  for (const PathPoint& point : path) {
    ASSERT_EQ(point.failure, "");
    const double moved = -of.path.at(point.at.value).x.z;
    EXPECT_NEAR(of.force_at(point), k * (moved + tip_of(point).z), 1e-9 * k * way);
    EXPECT_EQ(of.displacement(path.front(), point), moved);
  }
  EXPECT_NEAR(of.displacement(path.front(), path.back()), way, 1e-12);
  EXPECT_GT(of.force_at(path.back()), 0);
}

/// The signs of the eigenvalues are those of the squares of small motions, which another
/// algorithm finds with the mass matrix [Sylvester's law of inertia].
TEST(Column, IsAsStableAsItsSmallMotionsAre) {
  StaticStrand strand = static_strand(column("id = \"der\"", 10), "point_force=0..4");
  const auto path = equilibrium_path(strand, {.resolution = 0.1});
  for (const PathPoint& point : path) {
    if (point.event == Event::bifurcation) continue;
    const auto slopes = strand.slopes(point.at);
    const auto motions = experiments::small_motions(
        strand.mass(point.at), slopes.stiffness, slopes.gradient,
        slopes.gradient.transpose(), strand.typical());
    const auto negative = std::ranges::count_if(
        motions, [](const auto& motion) { return motion.square < 0; });
    EXPECT_EQ(negative, point.stability.negative) << point.at.value;
  }
}

/// The branch of the bent column is the elastica. 20 clothoids err by order 4 in the
/// load, 1e-7, which the root at the bifurcation turns into 1e-4 of the length near by.
TEST(Column, BendsAsTheElasticaOnItsBranch) {
  for (const int side : {1, -1}) {
    const auto path = static_path(column(planar_clothoid, 20), "point_force=0..8",
                                  {.resolution = 0.1, .branch = side});
    ASSERT_EQ(path.back().event, Event::end);
    double worst = 0;
    int bent = 0;
    for (const PathPoint& point : path) {
      EXPECT_EQ(point.failure, "");
      const bool on_branch = norm(tip_of(point) - Vec{0, 0, 0.1}) > 1e-4;
      if (!on_branch) continue;
      ++bent;
      EXPECT_EQ(point.stability.negative, 0);
      const Tip tip = tip_of_elastica(point.at.value);
      const Vec at = (1 / 0.1) * tip_of(point);
      worst = std::max(
          {worst, std::abs(std::abs(at.x) - tip.side), std::abs(at.z - tip.height)});
    }
    std::printf("branch to side %d: %d points, worst %.1e\n", side, bent, worst);
    EXPECT_GE(bent, 10);
    EXPECT_LE(worst, 1e-4);
  }
}

/// A force to the side of 1e-3 of EI/L^2 replaces the bifurcation by a smooth path. The
/// side force F turns the force by F/P, and with it the elastica by as much: 1e-3/4 at P
/// = 4 at most, times its lengths.
TEST(Column, WithALittleImperfectionFollowsTheBranch) {
  const std::string side = "[[effects.point_force]]\nforce_n = [" +
                           std::to_string(1e9 * 1e-3 * bending_of_strand / 0.01) +
                           "e-9, 0, 0]\n";
  const auto path = static_path(column(planar_clothoid, 20, side), "point_force=0..4",
                                {.resolution = 0.1});
  EXPECT_TRUE(values_at(path, Event::bifurcation).empty());
  EXPECT_TRUE(values_at(path, Event::limit_point).empty());
  ASSERT_EQ(path.back().at.value, 4);
  const Tip tip = tip_of_elastica(4);
  const Vec at = (1 / 0.1) * tip_of(path.back());
  EXPECT_NEAR(at.x, tip.side, 1e-3);
  EXPECT_NEAR(at.z, tip.height, 1e-3);
  for (const PathPoint& point : path) EXPECT_EQ(point.stability.negative, 0);
}

/// Beck's column, under a force along its tangent, has no other equilibrium, whatever the
/// load, and flutters at 20.05: its stiffness is unsymmetric.
std::string beck(const std::string& model, int elements) {
  return static_scene(model, "length_m = 0.1\nelements = " + std::to_string(elements),
                      "[[effects.point_force]]\nfollower_n = " +
                          std::to_string(-1e9 * bending_of_strand / 0.01) + "e-9\n");
}

TEST(Column, UnderAFollowerForceFlutters) {
  const auto path =
      static_path(beck(planar_clothoid, 10), "point_force=0..30", {.resolution = 0.02});
  double flutters = 0;
  for (const PathPoint& point : path) {
    EXPECT_NE(point.event, Event::bifurcation);
    EXPECT_EQ(point.stability.symmetric, point.at.value == 0);
    if (point.stability.oscillates && flutters == 0) flutters = point.at.value;
  }
  // Points are 0.6 apart; the load of 10 clothoids errs by 1e-4.
  EXPECT_GT(flutters, 20.05 - 0.01);
  EXPECT_LT(flutters, 20.05 + 0.61);
}

/// The stiffness of stretch is 1e9 times that of the load, which makes it unsymmetric all
/// the same. Links and springs err by O(h^2): 3 % with 20 elements of a strand.
TEST(Column, UnderAFollowerForceFluttersThoughItStretches) {
  for (const char* model : {"der", "mass_spring", "lifted_curls", "corde",
                            "xpbd_cosserat", "articulated_chain"}) {
    const auto path = static_path(beck("id = \"" + std::string(model) + "\"", 20),
                                  "point_force=0..24", {.resolution = 0.1});
    double flutters = 0;
    for (const PathPoint& point : path) {
      EXPECT_NE(point.event, Event::bifurcation) << model << ' ' << point.at.value;
      EXPECT_EQ(point.stability.symmetric, point.at.value == 0) << model;
      if (point.stability.oscillates && flutters == 0) flutters = point.at.value;
    }
    // Points are 2.4 apart.
    EXPECT_GT(flutters, 0.97 * 20.05) << model;
    EXPECT_LT(flutters, 20.05 + 2.4) << model;
  }
}

/// A strand that stands on a ball joint is neutral without a load, and topples under any.
/// It has no bifurcation up to a tenth of its own buckling.
TEST(Column, OnABallJointTopplesUnderAnyLoad) {
  for (const char* model : {"super_helix", "super_clothoid", "der", "corde",
                            "articulated_chain", "mass_spring"}) {
    const std::string scene = static_scene(
        "id = \"" + std::string(model) + "\"",
        "length_m = 0.1\nelements = 10\nroot_tangent = [0, 0, 1]",
        "[root]\nmotion = \"free\"\n[[supports]]\nat = \"root\"\n[effects.gravity]\n");
    const auto path = static_path(scene, "gravity=0..0.06");
    EXPECT_EQ(path.front().stability.negative, 0) << model;
    EXPECT_GE(path.front().stability.neutral.cols(), 2) << model;
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_NE(path[i].event, Event::bifurcation) << model;
      EXPECT_EQ(path[i].stability.negative, 2) << model << ' ' << path[i].at.value;
    }
    EXPECT_EQ(path.back().event, Event::end) << model;
    EXPECT_EQ(path.back().at.value, 0.06) << model;
  }
}

}  // namespace tress::test_column
