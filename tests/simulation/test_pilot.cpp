// [strand] tolerance_m: elements by trials of the motion.
#include <gtest/gtest.h>

#include <string>

#include "contract/input_error.h"
#include "simulation/errors/error_bars.h"
#include "simulation/errors/pilot.h"
#include "simulation/scene_changes/changes.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::test_pilot {

using namespace simulation;

constexpr double length = 0.2;  // m

/// A soft curl, let go; drag keeps neighbouring motions together.
Scene curl(const std::string& keys, const std::string& more = "",
           const std::string& model = "super_helix") {
  return parse_scene(
      "title = \"t\"\nduration_s = 0.3\nframes_per_s = 40\n[model]\nid = \"" + model +
          "\"\n[integrator]\nid = \"backward_euler\"\ndt_s = 0.002\n[material]\nradius_m "
          "= 40e-6\nyoungs_modulus_pa = 1e8\nellipticity = 1\ndensity_kg_m3 = 1300\n"
          "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = 2e-5\n" +
          more +
          "[strand]\nlength_m = 0.2\nshape = \"helix\"\ncurl_radius_m = 0.015\n"
          "curl_pitch_m = 0.05\nroot_tangent = [0.1, 0, -1]\nmesh = \"rest\"\n" +
          keys,
      "curl.toml");
}

/// Of the joints, m, from a strand of many elements.
double error_of(const Scene& scene) {
  return length *
         distance(scene, with_elements(curl(""), 96), 1, 1).strands.at(0).error.largest;
}

TEST(Pilot, MotionGetsMoreElementsThanRestUntilItsErrorIsWithinTheTolerance) {
  constexpr double tolerance = 1e-3;
  const Scene given = curl("elements = 96\ntolerance_m = 1e-3\n");
  ASSERT_TRUE(wants_pilot(given));
  EXPECT_GT(error_of(given), tolerance);
  const Pilot found = pilot(given, 1);
  ASSERT_EQ(found.strands.size(), 1U);
  const Pilot::OfStrand& one = found.strands[0];
  EXPECT_EQ(one.at_rest, static_cast<int>(given.strands[0].segments.size()));
  EXPECT_EQ(one.elements, static_cast<int>(found.scene.strands[0].segments.size()));
  EXPECT_GT(one.elements, one.at_rest);
  EXPECT_LT(one.elements, 96);
  EXPECT_GE(found.tries, 2);
  EXPECT_LE(one.error, tolerance);
  EXPECT_LE(error_of(found.scene), tolerance);
  // A scene as any other: its elements stand fast.
  EXPECT_FALSE(wants_pilot(found.scene));
  EXPECT_EQ(with_twice_the_elements(found.scene).strands[0].segments.size(),
            2U * static_cast<unsigned>(one.elements));
}

/// The same with these tables after [[strand]] in place of the curl.
Scene strands(const std::string& tables) {
  const std::string text = scene_text(curl("elements = 5\n"));
  return parse_scene(text.substr(0, text.find("[strand]")) + "[strand]]\n" + tables,
                     "strands.toml");
}

const std::string straight = "length_m = 0.05\nposition_m = [0, 0.1, 0]\n",
                  kept = straight + "elements = 40\ntolerance_m = 0.02\n";

TEST(Pilot, WhatRestAsksForIsKeptWhereItIsEnough) {
  const Pilot found = pilot(strands(kept), 1);
  EXPECT_EQ(found.tries, 1);
  EXPECT_EQ(found.strands.at(0).elements, found.strands.at(0).at_rest);
  EXPECT_EQ(found.elements, 3 * found.strands[0].elements);
}

TEST(Pilot, EndsAtTheElementsOfTheTableAndSaysWhatIsLeft) {
  const Pilot found = pilot(curl("elements = 9\ntolerance_m = 1e-5\n"), 1);
  EXPECT_EQ(found.strands.at(0).elements, 9);
  EXPECT_GT(found.worst().error, 1e-5);
  EXPECT_TRUE(found.missing.empty());
}

TEST(Pilot, EachStrandHasItsOwnTolerance) {
  const Scene scene = strands(
      "length_m = 0.2\nshape = \"helix\"\ncurl_radius_m = 0.015\ncurl_pitch_m = 0.05\n"
      "root_tangent = [0.1, 0, -1]\nmesh = \"rest\"\nelements = 96\ntolerance_m = 1e-3\n"
      "[[strand]]\n" +
      straight + "elements = 5\n[[strand]]\n" + kept);
  const Pilot found = pilot(scene, 1);
  ASSERT_EQ(found.strands.size(), 2U);
  EXPECT_EQ(found.strands[0].strand, 0U);
  EXPECT_EQ(found.strands[1].strand, 2U);
  EXPECT_GT(found.strands[0].elements, found.strands[0].at_rest);
  EXPECT_EQ(found.strands[1].elements, found.strands[1].at_rest);
  EXPECT_EQ(found.scene.strands[1].segments.size(), 5U);
  EXPECT_EQ(&found.worst(), &found.strands[0]);
}

TEST(Pilot, RefusesWhatNoNumberOfElementsHolds) {
  // One element and two of them swing apart.
  const Scene apart = curl("elements = 1\ntolerance_m = 1e-4\n");
  ASSERT_TRUE(space_error(with_elements(apart, 1), 1).strands.at(0).parts);
  try {
    pilot(apart, 1);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("no tolerance can be held"), std::string::npos) << text;
    EXPECT_NE(text.find("curl.toml:"), std::string::npos) << text;
  }
  // Its points are control points.
  EXPECT_THROW(
      pilot(curl("elements = 96\ntolerance_m = 1e-3\n", "", "dynamic_spline"), 1),
      InputError);
}

TEST(Pilot, ARunThatFailsLeavesTheElementsOfRest) {
  const Scene given = curl("elements = 96\ntolerance_m = 1e-4\n", "", "super_helix");
  Scene failing = given;
  failing.integrator = "explicit_euler";
  failing.options.step = 0.02;
  const Pilot found = pilot(failing, 1);
  EXPECT_FALSE(found.missing.empty());
  EXPECT_EQ(found.scene.strands[0].segments.size(), given.strands[0].segments.size());
}

TEST(Pilot, GroomsAreCutByTheirRestAlone) {
  EXPECT_FALSE(wants_pilot(curl("elements = 9\n")));
  EXPECT_FALSE(wants_pilot(parse_scene(
      "title = \"t\"\n[model]\nid = \"super_helix\"\n[integrator]\nid = "
      "\"linearly_implicit_euler\"\ndt_s = 0.001\n[groom]\ncount = 3\nelements = 48\n"
      "tolerance_m = 0.001\n",
      "groom.toml")));
}

}  // namespace tress::test_pilot
