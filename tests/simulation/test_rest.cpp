// rest = "inverse": strands that stay as they are at t = 0, and which of them would not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "simulation/rest/dense_statics.h"
#include "simulation/run/world.h"

namespace tress::test_rest {

using namespace simulation;

struct Setting {
  std::string model, shape, effects;
  std::string unstable = "stiffen";
  std::string integrator = "id = \"backward_euler\"\ndt_s = 0.05";
  std::string strand = "length_m = 0.12\nelements = 12\nroot_tangent = [1, 0, 0.3]\n";
  std::string top = {};
};

Scene scene_of(const Setting& s) {
  return parse_scene(
      fmt::format(
          "title = \"at rest\"\nduration_s = 10\nframes_per_s = 1\nrest = "
          "\"inverse\"\nunstable = \"{}\"\n{}[model]\n{}\n[integrator]\n{}\n"
          "[material]\nname = \"hair.asian\"\nradius_m = 40e-6\npoisson_ratio = 0.48\n"
          "[strand]\n{}{}\n"
          "[root]\nmotion = \"fixed\"\n[effects.gravity]\n{}",
          s.unstable, s.top, s.model, s.integrator, s.strand, s.shape, s.effects),
      "rest.toml");
}

const char* const shapes[] = {
    "shape = \"straight\"", "shape = \"wavy\"\nwave_per_m = 60\nwavelength_m = 0.04",
    "shape = \"helix\"\ncurl_radius_m = 0.008\ncurl_pitch_m = 0.02",
    "shape = \"fuzzy\"\nfuzz_per_m = 40\ncorrelation_m = 0.02"};
const char* const effects[] = {
    "",
    "[effects.wind]\nvelocity_m_s = [0.3, 1, 0]\nprofile = \"gusts\"\nlaw = "
    "\"quadratic\"\n[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n",
    "[effects.tether]\ntarget_m = [0.1, 0.03, 0.05]\npull_n = 2e-6\nt_on_s = -1\n"};
const char* const reduced[] = {"id = \"super_helix\"",
                               "id = \"super_helix\"\nmodes = \"bend\"",
                               "id = \"super_helix\"\njacobian = \"elastic\"",
                               "id = \"articulated_chain\"",
                               "id = \"super_clothoid\"",
                               "id = \"super_clothoid\"\nmodes = \"bend\""};
const char* const others[] = {"id = \"der\"",
                              "id = \"der\"\nstretch = \"inextensible\"",
                              "id = \"der\"\ntwist = \"quasi_static\"",
                              "id = \"corde\"",
                              "id = \"xpbd_cosserat\"",
                              "id = \"dynamic_spline\""};

/// Methods that keep constraints, for models that have them.
Setting setting(const std::string& model, const std::string& shape,
                const std::string& effect) {
  Setting s{model, shape, effect};
  if (model.find("inextensible") != std::string::npos ||
      model.find("spline") != std::string::npos) {
    s.integrator += "\nformulation = \"projection\"";
  }
  return s;
}

/// Residuals are sums of some 1e3 terms of equal size, each right to 1e-16.
constexpr double rounding = 1e-11;

TEST(AtRest, ReducedModelsBalanceEveryShapeUnderEveryEffect) {
  for (const char* const model : reduced) {
    for (const char* const shape : shapes) {
      for (const char* const effect : effects) {
        const World world(scene_of({model, shape, effect}));
        const HeldShape& held = world.held().front();
        EXPECT_LE(held.residual, rounding) << model << shape << effect;
        EXPECT_FALSE(held.falls());
      }
    }
  }
}

TEST(AtRest, OtherModelsSagByLittle) {
  for (const char* const model : others) {
    for (const char* const shape : shapes) {
      for (const char* const effect : effects) {
        const World world(scene_of(setting(model, shape, effect)));
        const HeldShape& held = world.held().front();
        EXPECT_LE(held.sag / 0.12, 1e-4) << model << shape << effect;
      }
    }
  }
}

/// Largest distance of a point from where it was, over 10 s in the strand's length.
double drift(const Scene& scene) {
  World world(scene);
  const std::vector<double> start = world.positions();
  double most = 0;
  for (int second = 1; second <= 10; ++second) {
    if (world.advance(second) != Status::ok) return 1;
    const std::vector<double>& now = world.positions();
    for (std::size_t i = 0; i < now.size(); ++i) {
      most = std::max(most, std::abs(now[i] - start[i]));
    }
  }
  return most / 0.12;
}

TEST(AtRest, StrandsStayForTenSeconds) {
  for (const char* const shape : shapes) {
    for (const char* const model : {reduced[0], reduced[3], reduced[4]}) {
      EXPECT_LE(drift(scene_of({model, shape, effects[2]})), 1e-9) << model << shape;
    }
    for (const char* const model : {others[0], others[3]}) {
      const double moved = drift(scene_of({model, shape, ""}));
      EXPECT_LE(moved, 1e-4) << model << shape;
    }
  }
}

/// The root moves after all, and gusts blow: then the strand does.
TEST(AtRest, WhatMovesIsStillWhenShapesAreHeld) {
  Setting s{reduced[0], shapes[2], effects[1]};
  s.strand += "position_m = [0, 0, 0.1]\n";
  Scene scene = scene_of(s);
  scene.head.translations.push_back({Vec{0, 1, 0}, models::sine(0.05, 3)});
  for (Strand& strand : scene.strands) strand.root.translations = scene.head.translations;
  World world(scene);
  EXPECT_LE(world.held().front().residual, rounding);
  const std::vector<double> start = world.positions();
  ASSERT_EQ(world.advance(0.1), Status::ok);
  double moved = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    moved = std::max(moved, std::abs(world.positions()[i] - start[i]));
  }
  EXPECT_GT(moved, 0.01);
}

/// An upright column buckles at rho A g L^3/EI = 7.8373 [Greenhill 1881]: it stays where
/// its moduli are raised by its own number over that. 24 elements: error of order 1/n^2.
TEST(Stability, IsGreenhillsForAnUprightStrand) {
  constexpr double greenhill = 7.8373;
  for (const char* const model :
       {reduced[0], reduced[3], reduced[4], others[0], others[3]}) {
    for (const double length : {0.05, 0.2}) {
      Setting s{model, shapes[0], "", "keep"};
      s.strand =
          fmt::format("length_m = {}\nelements = 24\nroot_tangent = [0, 0, 1]\n", length);
      const Scene scene = scene_of(s);
      const models::Strand& strand = scene.strands.front();
      const models::CrossSection& section = strand.segments.front().section;
      const double gamma = strand.material.density * section.area() * 9.81 *
                           std::pow(length, 3) /
                           (strand.material.youngs_modulus *
                            std::min(section.inertia1(), section.inertia2()));
      const World world(scene);
      EXPECT_NEAR(world.held().front().least_factor / (gamma / greenhill), 1, 0.01)
          << model << length;
    }
  }
}

TEST(Stability, NamesThoseThatFall) {
  for (const char* const shape : {shapes[0], shapes[2]}) {
    for (const char* const length : {"0.04", "0.25"}) {
      Setting s{reduced[0], shape, "", "keep"};
      s.strand = fmt::format("length_m = {}\nelements = 16\nroot_tangent = [1, 0.2, 1]\n",
                             length);
      const Scene scene = scene_of(s);
      const World world(scene);
      const HeldShape& held = world.held().front();
      // A push of 1e-6 of the length decides within ten seconds.
      World pushed(scene);
      Snapshot begin = pushed.snapshot();
      for (double& x : begin.strands.front().q) x += 1e-4;
      pushed.restore(begin);
      const std::vector<double> start = World(scene).positions();
      ASSERT_EQ(pushed.advance(10), Status::ok);
      double most = 0;
      for (std::size_t i = 0; i < start.size(); ++i) {
        most = std::max(most, std::abs(pushed.positions()[i] - start[i]));
      }
      EXPECT_EQ(held.falls(), most > 0.05 * std::stod(length))
          << shape << length << " " << held.least_factor << " " << most;
    }
  }
}

TEST(Stability, StiffensWhatWouldFallAndLeavesTheRest) {
  Setting s{reduced[0], shapes[2], ""};
  s.strand = "length_m = 0.3\nelements = 16\nroot_tangent = [1, 0, 1]\n";
  const World stiff(scene_of(s));
  s.unstable = "keep";
  const World kept(scene_of(s));
  const HeldShape& held = stiff.held().front();
  ASSERT_GT(held.least_factor, 1);
  // Both by bisection, to 1e-7.
  EXPECT_NEAR(held.factor, stiffened * held.least_factor, 1e-5 * held.factor);
  EXPECT_FALSE(held.falls());
  EXPECT_TRUE(kept.held().front().falls());
  EXPECT_EQ(kept.held().front().factor, 1);
  EXPECT_NEAR(kept.held().front().least_factor, held.least_factor,
              1e-3 * held.least_factor);
  s.unstable = "drop";
  EXPECT_THROW(World(scene_of(s)), InputError);
}

/// A strand laid on a sphere whose surface it enters by the radius of a hair.
TEST(Contact, SupportsWithoutBendingWhereAPenaltyBends) {
  const std::string head =
      "[effects.body]\nshape = \"sphere\"\nradius_m = 0.08\ncentre_m = [0, 0, -0.08]\n"
      "stiffness_n_m2 = 1000\n";
  for (const char* const model : {reduced[0], reduced[3], reduced[4], others[0]}) {
    Setting s{model, "shape = \"helix\"\ncurl_radius_m = 0.08\ncurl_pitch_m = 0", head};
    s.strand = "length_m = 0.1\nelements = 12\nroot_tangent = [1, 0, 0]\n";
    Scene scene = scene_of(s);
    const auto bend = [](const World& world, const std::vector<double>& at_start) {
      double most = 0;
      for (std::size_t k = 0; k < at_start.size(); ++k) {
        most = std::max(most, std::abs(world.held().front().natural[k] - at_start[k]));
      }
      return most;
    };
    const auto system =
        scene.model->on_strand(scene.strands.front(), scene.model_options, {});
    const std::vector<double> start = natural_strains(*system)->natural();
    const World world(scene);
    const HeldShape& held = world.held().front();
    EXPECT_GT(held.contacts, 0) << model;
    EXPECT_LE(held.residual, model == others[0] ? 1e-3 : rounding) << model;
    const double per_length = model == reduced[3] ? 0.1 / 12 : 1;
    EXPECT_LT(bend(world, start), 10 * per_length) << model;
    // The penalty of the surface at the depth of a radius: the residual is its bending.
    const auto pressed = scene.model->on_strand(scene.strands.front(),
                                                scene.model_options, make_effects(scene));
    const auto n = static_cast<std::size_t>(pressed->layout().coordinates);
    std::vector<double> q(n), v(n), r(n);
    pressed->initial_state(q, v);
    ASSERT_EQ(pressed->residual(0, q, v, v, r), Status::ok);
    const std::vector<double> stiffness = natural_strains(*pressed)->natural_stiffness();
    double penalty = 0;
    for (std::size_t k = 0; model != others[0] && k < n; ++k) {
      penalty = std::max(penalty, std::abs(r[k]) / stiffness[k]);
    }
    EXPECT_TRUE(model == others[0] || penalty > 1000 * per_length) << penalty;
    const double moved = drift(scene);
    EXPECT_LT(moved, 1e-4) << model;
  }
}

TEST(Contact, NonnegativeLeastSquaresMeetItsConditions) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd a(12, 9);
    Eigen::VectorXd b(12);
    for (Eigen::Index i = 0; i < a.size(); ++i) a.data()[i] = normal(random);
    for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = normal(random);
    const Eigen::VectorXd x = nonnegative(a, b, 0);
    const Eigen::VectorXd slope = a.transpose() * (a * x - b);
    // Karush, Kuhn and Tucker: x >= 0, slope >= 0, one of them 0 in each entry.
    int active = 0;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      EXPECT_GE(x[k], 0);
      EXPECT_GE(slope[k], -1e-10);
      EXPECT_LE(std::abs(x[k] * slope[k]), 1e-10);
      active += x[k] > 0;
    }
    EXPECT_GT(active, 0);
    EXPECT_LT(active, 9);
  }
}

TEST(AtRest, IsRefusedWhereItCannotBe) {
  const auto message = [](const Setting& s) {
    try {
      scene_of(s);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const std::string lacks = "lacks a natural strain for each direction";
  for (const char* const model : {"id = \"mass_spring\"", "id = \"kirchhoff_nodal\"",
                                  "id = \"inextensible_strand\""}) {
    const std::string told = message(setting(model, shapes[0], ""));
    EXPECT_NE(told.find(lacks), std::string::npos) << model << told;
    EXPECT_NE(told.find("rest.toml:4:"), std::string::npos) << told;
  }
}

/// Four strands side by side in lanes of one system, and one apart.
TEST(AtRest, HoldsStrandsOfABatch) {
  std::string text =
      "title = \"batch\"\nduration_s = 1\nrest = \"inverse\"\n[model]\nid = "
      "\"super_helix\"\njacobian = \"elastic\"\n[integrator]\nid = "
      "\"linearly_implicit_euler\"\ndt_s = 0.01\n[material]\nname = \"hair.asian\"\n";
  for (int k = 0; k < 5; ++k) {
    text += fmt::format(
        "[[strand]]\nlength_m = 0.06\nelements = 8\nposition_m = [0, {}, 0]\nshape = "
        "\"helix\"\ncurl_radius_m = {}\n",
        0.01 * k, 0.006 + 0.001 * k);
  }
  const Scene scene = parse_scene(
      text +
          "[root]\nmotion = \"fixed\"\n[effects.gravity]\n[effects.strand_interaction]\n",
      "batch.toml");
  World world(scene, 2);
  EXPECT_LT(world.systems(), world.strands());
  const std::vector<double> start = world.positions();
  ASSERT_EQ(world.advance(1), Status::ok);
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_NEAR(world.positions()[i], start[i], 1e-9 * 0.06);
  }
}

}  // namespace tress::test_rest
