// [strand]: elements that share what bends the strand at rest, and as few as a tolerance
// needs.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "contract/constants.h"
#include "contract/input_error.h"
#include "models/cut/graded_cut.h"
#include "models/strand/geometry.h"
#include "simulation/scene/scene.h"
#include "simulation/scene_changes/changes.h"

namespace tress::test_cuts {

using namespace simulation;

struct Hair {
  double length, radius, young;
  std::string tangent, shape;

  Strand cut(const std::string& keys) const {
    const auto text = [](double x) { return std::to_string(x); };
    const Scene scene = parse_scene(
        "title = \"t\"\nduration_s = 0.1\n[model]\nid = "
        "\"super_helix\"\n[integrator]\nid "
        "= \"linearly_implicit_euler\"\ndt_s = 0.001\n[material]\nradius_m = " +
            text(radius) + "\nyoungs_modulus_pa = " + text(young) +
            "\nellipticity = 1\ndensity_kg_m3 = "
            "1300\n[effects.gravity]\n[strand]\nlength_m = " +
            text(length) + "\nroot_tangent = " + tangent + "\n" + shape + keys,
        "t.toml");
    return scene.strands.front();
  }
};

/// Joints at rest under its weight.
std::vector<Vec> at_rest(Strand strand) {
  const double line = strand.mass() / strand.length();
  const std::vector<double> q =
      models::coordinates_at_rest(strand, {0, 0, -earth_gravity * line});
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    strand.segments[i].natural = load3(&q[3 * i]);
  }
  std::vector<Vec> all;
  for (const auto& place : models::joints(strand, models::ShapeOf::natural,
                                          {strand.root.position, strand.root.frame})) {
    all.push_back(place.x);
  }
  return all;
}

/// Largest distance of joints at rest from those of a strand of `fine` equal elements.
double off(const Hair& hair, const Strand& strand, int fine) {
  const std::vector<Vec> exact = at_rest(
                             hair.cut("elements = " + std::to_string(fine) + "\n")),
                         own = at_rest(strand);
  double most = 0, s = 0;
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    s += strand.segments[i].length;
    const double at = fine * s / hair.length;
    const auto k =
        static_cast<std::size_t>(std::clamp(static_cast<int>(at), 0, fine - 1));
    const Vec along = exact[k + 1] - exact[k];
    most = std::max(most,
                    norm(own[i + 1] - exact[k] - (at - static_cast<double>(k)) * along));
  }
  return most;
}

/// Soft waves are at rest in several ways, and which of them a strand falls into depends
/// on its elements: the nearest one counts.
double off(const Hair& hair, const Strand& strand) {
  return std::min(off(hair, strand, 96), off(hair, strand, 192));
}

std::vector<Hair> family() {
  std::vector<Hair> all;
  for (const double length : {0.05, 0.2}) {
    for (const double young : {1e8, 4e9}) {
      for (const char* tangent : {"[1, 0, 0]", "[1, 0, 1]", "[0.1, 0, -1]"}) {
        for (const char* shape :
             {"shape = \"straight\"\n",
              "shape = \"wavy\"\nwave_per_m = 30\nwavelength_m = 0.08\n",
              "shape = \"helix\"\ncurl_radius_m = 0.015\ncurl_pitch_m = 0.05\n"}) {
          all.push_back({length, 40e-6, young, tangent, shape});
        }
      }
    }
  }
  return all;
}

TEST(Cuts, AsFewElementsAsTheToleranceNeeds) {
  int within = 0, fewer = 0, not_more = 0;
  const std::vector<Hair> hairs = family();
  for (const Hair& hair : hairs) {
    const double tolerance = 0.005 * hair.length;
    const std::string keys = "elements = 96\ntolerance_m = " + std::to_string(tolerance);
    const Strand rest = hair.cut(keys + "\nmesh = \"rest\"\n"), equal = hair.cut(keys);
    const double error = off(hair, rest);
    RecordProperty(std::to_string(hair.length) + hair.tangent + hair.shape +
                       std::to_string(hair.young),
                   std::to_string(error / tolerance));
    within += error <= tolerance;
    fewer += rest.segments.size() < equal.segments.size();
    not_more += rest.segments.size() <= equal.segments.size();
  }
  EXPECT_GE(within, 0.95 * static_cast<double>(hairs.size()));
  EXPECT_GE(fewer, 0.5 * static_cast<double>(hairs.size()));
  RecordProperty("not_more", not_more);
}

TEST(Cuts, AHeavyCantileverNeedsFewWhereTheyCount) {
  // Gamma = 1000: rho A g L^3/(EI) = 4 rho g L^3/(E r^2).
  const double radius = 40e-6, length = 0.2,
               young = 4 * 1300 * earth_gravity * length * length * length /
                       (1000 * radius * radius);
  const Hair hair{length, radius, young, "[1, 0, 0]", "shape = \"straight\"\n"};
  const double equal = off(hair, hair.cut("elements = 12\n")) / length,
               graded = off(hair, hair.cut("elements = 12\nmesh = \"rest\"\n")) / length;
  EXPECT_LT(graded, 0.005);
  EXPECT_GT(equal, 10 * graded);
}

TEST(Cuts, OtherNumbersOfElementsKeepTheCut) {
  const Scene scene = parse_scene(
      "title = \"t\"\nduration_s = 0.1\n[model]\nid = \"super_helix\"\n[integrator]\nid "
      "= "
      "\"linearly_implicit_euler\"\ndt_s = 0.001\n[material]\nyoungs_modulus_pa = 1e7\n"
      "[effects.gravity]\n[strand]\nelements = 8\nmesh = \"rest\"\n",
      "t.toml");
  const auto grows = [](const Strand& strand) {
    return strand.segments.back().length / strand.segments.front().length;
  };
  EXPECT_GT(grows(scene.strands.front()), 1.5);
  const Strand twice = with_twice_the_elements(scene).strands.front();
  ASSERT_EQ(twice.segments.size(), 16U);
  EXPECT_GT(grows(twice), 1.5);
  EXPECT_EQ(with_elements(scene, 5).strands.front().segments.size(), 5U);
}

TEST(Cuts, ClothoidsAreCutByWhatTheyNeed) {
  const Hair hair{0.1, 40e-6, 1e7, "[1, 0, 0]", "shape = \"straight\"\n"};
  const Strand linear = hair.cut("elements = 6\nmesh = \"rest_linear\"\n");
  const Scene scene = parse_scene(
      "title = \"t\"\nduration_s = 0.1\n[model]\nid = "
      "\"super_clothoid\"\n[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = 0.001\n"
      "[material]\nradius_m = 40e-6\nyoungs_modulus_pa = 1e7\nellipticity = "
      "1\ndensity_kg_m3 = 1300\n[effects.gravity]\n[strand]\nlength_m = 0.1\n"
      "root_tangent = [1, 0, 0]\n",
      "t.toml");
  ASSERT_TRUE(may_cut_at_rest(scene));
  const Strand of_model = with_elements_at_rest(scene, 6).strands.front();
  const Strand helices = hair.cut("elements = 6\nmesh = \"rest\"\n");
  ASSERT_EQ(of_model.segments.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(of_model.segments[i].length, linear.segments[i].length);
  }
  EXPECT_NE(helices.segments[0].length, linear.segments[0].length);
  EXPECT_THROW(hair.cut("tolerance_m = 0.001\nmesh = \"rest_linear\"\n"), InputError);
}

TEST(Cuts, WhatMakesNoSenseIsRefused) {
  const Hair hair{0.1, 40e-6, 1e9, "[1, 0, 0]", ""};
  EXPECT_THROW(hair.cut("mesh = \"rest\"\ngrading = 2\n"), InputError);
  EXPECT_THROW(hair.cut("tolerance_m = 0.001\ngrading = 2\n"), InputError);
  EXPECT_THROW(hair.cut("tolerance_m = -1\n"), InputError);
  EXPECT_THROW(hair.cut("mesh = \"rest\"\n[root]\nmotion = \"free\"\n"), InputError);
  const std::string scene =
      "title = \"t\"\n[model]\nid = \"super_helix\"\n[integrator]\nid = "
      "\"linearly_implicit_euler\"\ndt_s = 0.001\n[strand]\npoints = [[0,0,0], "
      "[0.1,0,0], "
      "[0.2,0.1,0]]\n";
  EXPECT_NO_THROW(parse_scene(scene, "t.toml"));
  EXPECT_THROW(parse_scene(scene + "mesh = \"rest\"\n", "t.toml"), InputError);
  EXPECT_THROW(parse_scene(scene + "tolerance_m = 0.01\n", "t.toml"), InputError);
  EXPECT_THROW(with_twice_the_elements(parse_scene(
                   "title = \"t\"\n[model]\nid = \"super_helix\"\n[integrator]\nid = "
                   "\"linearly_implicit_euler\"\ndt_s = 0.001\n[strand]\ntolerance_m = "
                   "0.001\n",
                   "t.toml")),
               InputError);
}

}  // namespace tress::test_cuts
