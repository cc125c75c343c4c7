// Equilibria of scenes against runs that come to rest, and what varies in a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "experiments/statics/equilibrium_path.h"
#include "experiments/statics/path_rows.h"
#include "simulation/run/world.h"
#include "tests/statics/static_scenes.h"

namespace tress::test_static_rest {

using namespace experiments::statics;
using namespace testing_support;
using simulation::World;

const std::string cantilever_strand =
    "length_m = 0.1\nelements = 20\nroot_tangent = [1, 0, 0]";

/// Farthest distance of two sets of places, m.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    most = std::max(most, norm(load3(&a[i]) - load3(&b[i])));
  }
  return most;
}

/// Steps of backward Euler of 0.05 s damp every motion of a strand whose slowest rate is
/// 30 rad/s by 1.5 or more each: 100 of them leave 1e-17.
TEST(Rest, OfACantileverIsWhereARunSettles) {
  for (const char* model : {"super_helix", "super_clothoid", "der", "mass_spring"}) {
    const std::string text =
        static_scene("id = \"" + std::string(model) + "\"", cantilever_strand,
                     "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n");
    StaticStrand strand = static_strand(text, "gravity=0..1");
    const auto path = equilibrium_path(strand, {});
    ASSERT_EQ(path.back().failure, "") << model;
    EXPECT_DOUBLE_EQ(path.back().at.value, 1) << model;
    // The last state balances, by a system of its own: up to the rounding of stretch,
    // which is 4e8 times as stiff as bending.
    StaticStrand again = static_strand(text, "gravity=0..1");
    again.recall(strand.memory());
    const Eigen::VectorXd left =
        again.residual(path.back().at).cwiseQuotient(again.units());
    EXPECT_LE(left.cwiseAbs().maxCoeff(), 1e-7) << model;
    simulation::Scene scene = simulation::parse_scene(text, "run.toml");
    scene.integrator = "backward_euler";
    scene.options.step = 0.05;
    World world(scene);
    ASSERT_EQ(world.advance(5), Status::ok) << world.failure();
    const double apart = distance(path.back().x, world.positions());
    std::printf("%s: sag %.4f of the length, %.1e from the run\n", model,
                -tip_of(path.back()).z / 0.1, apart / 0.1);
    EXPECT_GT(-tip_of(path.back()).z, 0.05) << model;
    EXPECT_LE(apart, 1e-8) << model;
  }
}

/// A cord between two ball joints, led outwards: the path ends where a run at rest does.
TEST(Rest, OfACordOnSupportsIsWhereARunSettles) {
  const std::string text = static_scene(
      "id = \"super_helix\"", cantilever_strand,
      "[root]\nmotion = \"free\"\n[[supports]]\nat = \"root\"\n[[supports]]\nkeyframes = "
      "[[0, 0.06, 0, 0], [0.5, 0.08, 0, 0.01]]\n[effects.gravity]\n"
      "[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n");
  const auto path = static_path(text, "supports");
  ASSERT_EQ(path.back().failure, "");
  EXPECT_DOUBLE_EQ(path.back().at.value, 0.5);
  simulation::Scene scene = simulation::parse_scene(text, "run.toml");
  scene.integrator = "backward_euler";
  scene.options.step = 0.02;
  World world(scene);
  ASSERT_EQ(world.advance(5), Status::ok) << world.failure();
  EXPECT_LE(distance(path.back().x, world.positions()), 1e-7);
  const std::vector<double> force = world.support_loads().forces;
  const double weight = 1300 * 9.81 * std::numbers::pi * 25e-10 * 0.1;
  EXPECT_LE(norm(path.back().forces[1] - load3(&force[3])), 1e-5 * weight);
}

/// A straight strand between ball joints spins about itself without energy: one neutral
/// mode, along the whole path, that is no bifurcation.
TEST(Rest, LeavesOutModesWithoutEnergy) {
  const std::string text = static_scene(
      "id = \"super_helix\"", cantilever_strand,
      "[root]\nmotion = \"free\"\n[[supports]]\nat = \"root\"\n[[supports]]\nat = "
      "\"tip\"\nslide = [1, 0, 0]\n[[effects.point_force]]\nforce_n = [-1e-6, 0, 0]\n");
  const auto path = static_path(text, "point_force=0..5");
  for (const PathPoint& point : path) {
    EXPECT_EQ(point.failure, "");
    EXPECT_EQ(point.stability.neutral.cols(), 1);
    EXPECT_EQ(point.stability.negative, 0);
  }
  EXPECT_TRUE(values_at(path, Event::bifurcation).empty());
}

/// The sag of a slight load grows as the load over Young's modulus.
TEST(Rest, FollowsANumberOfTheScene) {
  const std::string text =
      static_scene("id = \"super_helix\"", cantilever_strand,
                   "[effects.gravity]\ngravity_m_s2 = [0, 0, -1e-3]\n");
  StaticStrand strand = static_strand(text, "youngs_modulus_pa=1e9..4e9");
  EXPECT_EQ(strand.varied().unit, "Pa");
  const auto path = equilibrium_path(strand, {});
  ASSERT_EQ(path.back().failure, "");
  EXPECT_DOUBLE_EQ(path.back().at.value, 4e9);
  EXPECT_NEAR(tip_of(path.front()).z / tip_of(path.back()).z, 4, 1e-5);
}

/// What varies without a word: supports that move, else the only point force, else
/// gravity.
TEST(Rest, ChoosesWhatVaries) {
  const auto chosen = [](const std::string& more) {
    const auto scene = simulation::parse_scene(
        static_scene("id = \"super_helix\"", cantilever_strand, more), "statics.toml");
    return varied(scene, "", "--over").name;
  };
  const std::string force = "[[effects.point_force]]\nforce_n = [0, 0, 1e-6]\n";
  const std::string support =
      "[[supports]]\nkeyframes = [[0, 0.09, 0, 0], [1, 0.08, 0, 0]]\n";
  EXPECT_EQ(chosen("[effects.gravity]\n"), "gravity");
  EXPECT_EQ(chosen("[effects.gravity]\n" + force), "point_force");
  EXPECT_EQ(chosen(support + "[effects.gravity]\n" + force), "supports");
}

}  // namespace tress::test_static_rest
