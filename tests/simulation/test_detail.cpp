// As few elements as a strand's shape needs, and heads of several numbers of elements.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "models/strand/needed_elements.h"
#include "simulation/head/head_classes.h"
#include "simulation/head/head_run.h"
#include "simulation/run/world.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"
#include "tests/harness/toy_process.h"

namespace tress::test_detail {

using namespace simulation;
using models::elements_for;
using models::UncutStrand;

constexpr double pi = std::numbers::pi;

TEST(Detail, ElementsFollowLengthWeightCurlAndTolerance) {
  const models::Shape straight = models::uniform_shape({});
  // w L/EI = 2500/m^2 times 0.2 m: at most 500 and 2 sqrt(500) sin(pi/4)/m at the root.
  const UncutStrand across{0.2, 1.5e-5, 6e-9, {1, 0, 0}, straight};
  const double bend = 2 * std::sqrt(500.0) * std::sin(pi / 4);
  EXPECT_EQ(std::ceil(0.2 * std::sqrt(bend / (12 * 0.002))), 8);
  EXPECT_EQ(elements_for(across, 0.002, 64), 8);
  EXPECT_EQ(elements_for(across, 0.002 / 16, 64), 32);  // 29.05
  EXPECT_EQ(elements_for(across, 0.002, 6), 6);
  // It hangs straight down and stays straight.
  UncutStrand down = across;
  down.tangent = {0, 0, -1};
  EXPECT_EQ(elements_for(down, 1e-9, 64), 2);
  // So short that it hardly bends: w L^2/(2 EI) = 2.5e-3/m.
  UncutStrand stubble = across;
  stubble.length = 0.002 / std::sqrt(2.0);
  EXPECT_EQ(elements_for(stubble, 1e-5, 64), 2);
  // A curl without weight has constant curvature: only its winding counts, 60 rad.
  const models::Shape coil = models::uniform_shape({0, 300, 0});
  const UncutStrand curl{0.2, 0, 6e-9, {0, 0, -1}, coil};
  EXPECT_EQ(elements_for(curl, 1e-3, 100), 48);
  EXPECT_EQ(elements_for(curl, 1e-3, 40), 40);
}

std::string groom(const std::string& shape, const std::string& more) {
  return "title = \"t\"\nduration_s = 0.1\nframes_per_s = 30\n[model]\nid = "
         "\"super_helix\"\n"
         "modes = \"bend_twist\"\njacobian = \"elastic\"\n[integrator]\nid = "
         "\"linearly_implicit_euler\"\ndt_s = 0.0008333333333333334\n[material]\nname = "
         "\"hair.caucasian\"\n[effects.gravity]\n[groom]\ncount = 60\nlength_m = "
         "0.12\nlength_variation = 0.6\ncurl_variation = 0.3\n" +
         shape + more;
}

/// Joints of a strand from the root on, after so many steps.
using Points = std::vector<Vec>;

/// Every strand of a scene by its class, at each of `frames` instants.
std::vector<std::vector<Points>> moved(const Scene& scene, double h, int steps,
                                       int frames) {
  std::map<std::size_t, std::vector<std::size_t>> classes;
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    classes[scene.strands[k].segments.size()].push_back(k);
  }
  std::vector<std::vector<Points>> all(static_cast<std::size_t>(frames),
                                       std::vector<Points>(scene.strands.size()));
  for (const auto& [elements, strands] : classes) {
    SceneHead made = make_head(only(scene, strands), {models::HeadNumber::float64, 4}, 1);
    HeadRun run(std::move(made.head), 1);
    std::vector<double> x;
    int taken = 0;
    for (auto& frame : all) {
      for (int i = 0; i < steps; ++i, ++taken) run.step(taken * h, h);
      run.positions(taken * h, x);
      EXPECT_TRUE(run.head().losses().empty());
      for (std::size_t i = 0; i < strands.size(); ++i) {
        for (std::size_t j = 0; j <= elements; ++j) {
          frame[strands[i]].push_back(load3(&x[3 * (i * (elements + 1) + j)]));
        }
      }
    }
  }
  return all;
}

/// The largest distance of joints of strand k from those of a finer one.
double off(const Points& strand, const Points& fine) {
  const std::size_t ratio = (fine.size() - 1) / (strand.size() - 1);
  EXPECT_EQ(ratio * (strand.size() - 1), fine.size() - 1);
  double most = 0;
  for (std::size_t i = 0; i < strand.size(); ++i) {
    most = std::max(most, norm(strand[i] - fine[i * ratio]));
  }
  return most;
}

struct Share {
  double within, median;  // of strands; of errors over the tolerance
  double elements;        // mean
};

constexpr int fine_elements = 96;  // a multiple of 2, 3, 4, 6, 8 ... 32, 48

/// Errors of a groom's strands, each the largest over frames.
Share share(const std::string& shape, const std::string& drive, double tolerance,
            double allowed, double h, int steps, int frames) {
  const Scene chosen =
                  parse_scene(groom(shape, "elements = 48\ntolerance_m = " +
                                               std::to_string(tolerance) + "\n" + drive),
                              "chosen.toml"),
              fine = parse_scene(groom(shape, "elements = 96\n" + drive), "fine.toml");
  const auto coarse = moved(chosen, h, steps, frames),
             exact = moved(fine, h, steps, frames);
  std::vector<double> errors(chosen.strands.size());
  double elements = 0;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    for (std::size_t f = 0; f < coarse.size(); ++f) {
      errors[k] = std::max(errors[k], off(coarse[f][k], exact[f][k]) / tolerance);
    }
    elements += static_cast<double>(chosen.strands[k].segments.size());
  }
  std::ranges::sort(errors);
  const auto within = std::ranges::upper_bound(errors, allowed) - errors.begin();
  const auto count = static_cast<double>(errors.size());
  return {static_cast<double>(within) / count, errors[errors.size() / 2],
          elements / count};
}

class DetailOfShapes : public testing::TestWithParam<std::string> {};

/// Let down through thick air, w/c = 0.13 m/s for 4 s, until it hangs: m/c = 13 ms.
TEST_P(DetailOfShapes, StrandsHangWithinTheTolerance) {
  for (const double tolerance : {0.003, 0.001}) {
    const Share found = share(GetParam(), "[effects.linear_drag]\ndrag_kg_m_s = 5e-4\n",
                              tolerance, 1, 1.0 / 120, 480, 1);
    RecordProperty("within", std::to_string(found.within));
    RecordProperty("median", std::to_string(found.median));
    EXPECT_GE(found.within, 0.9) << tolerance;
    EXPECT_LT(found.elements, 40);
  }
}

/// In motion the weight is joined by the forces of a frame that moves with the head, at
/// most a = |a_0| + (|alpha| + omega^2) r, and a load that sets in at once bends twice as
/// far as one that rests: the bound of the shape at rest, times 2 (1 + a/g).
TEST_P(DetailOfShapes, StrandsMoveWithinTheToleranceOfTheirLoad) {
  const std::string drive =
      "[effects.linear_drag]\ndrag_kg_m_s = 5e-5\n[root]\nmotion = \"head\"\ncentre_m = "
      "[-0.02, 0, -0.1]\ntorque_n_m = 0.6\nfrequency_hz = 2\n";
  const Scene scene = parse_scene(groom(GetParam(), drive), "drive.toml");
  double most = 0, reach = 0;
  for (const Strand& strand : scene.strands) {
    const Vec away = strand.root.position - Vec{-0.02, 0, -0.1};
    reach = std::max(reach, std::hypot(away.x, away.y) + strand.length());
  }
  for (int i = 0; i <= 500; ++i) {
    const models::RootPose pose = scene.strands.front().root.at(i * 1e-3);
    const double turns = norm(pose.omega);
    most = std::max(most, (norm(pose.alpha) + turns * turns) * reach);
  }
  EXPECT_GT(most, 1);
  const double allowed = 2 * (1 + most / 9.81);
  const Share found = share(GetParam(), drive, 0.003, allowed, 1.0 / 1200, 60, 10);
  EXPECT_GE(found.within, 0.9);
}

INSTANTIATE_TEST_SUITE_P(
    Grooms, DetailOfShapes,
    testing::Values("shape = \"straight\"\n",
                    "shape = \"wavy\"\nwave_per_m = 40\nwavelength_m = 0.05\n",
                    "shape = \"helix\"\ncurl_radius_m = 0.01\ncurl_pitch_m = 0.04\n",
                    "shape = \"fuzzy\"\nfuzz_per_m = 30\ncorrelation_m = 0.03\n"));

Scene classes(const std::string& more = "") {
  return parse_scene(groom("shape = \"helix\"\n", "tolerance_m = 0.002\n" + more),
                     "t.toml");
}

TEST(Detail, TheSameInPixels) {
  const Scene metres = classes(),
              pixels = parse_scene(
                  groom("shape = \"helix\"\n", "tolerance_px = 3\npixels_per_m = 1500\n"),
                  "t.toml");
  ASSERT_EQ(metres.strands.size(), pixels.strands.size());
  for (std::size_t k = 0; k < metres.strands.size(); ++k) {
    EXPECT_EQ(metres.strands[k].segments.size(), pixels.strands[k].segments.size());
  }
}

TEST(Detail, WhatMakesNoSenseIsRefused) {
  for (const char* bad : {"tolerance_m = 0.001\ntolerance_px = 1\npixels_per_m = 1000\n",
                          "tolerance_px = 1\n", "pixels_per_m = 1000\n",
                          "tolerance_m = 0.001\nguides = 5\n",
                          "tolerance_m = 0.001\ngrading = 2\n", "tolerance_m = -1\n"}) {
    EXPECT_THROW(parse_scene(groom("", bad), "t.toml"), InputError) << bad;
  }
}

TEST(Detail, OtherElementsReplaceIt) {
  for (const Strand& strand : with_elements(classes(), 7).strands) {
    EXPECT_EQ(strand.segments.size(), 7U);
  }
  for (const Strand& strand : every_strand(classes(), 100).strands) {
    EXPECT_EQ(strand.segments.size(), 20U);
  }
  EXPECT_THROW(with_twice_the_elements(classes()), InputError);
}

TEST(Detail, StrandsOfAllClassesRunInOneWorld) {
  Scene scene = classes();
  scene.duration = 0.02;
  World world(scene);
  EXPECT_EQ(world.advance(0.02), Status::ok) << world.failure();
}

/// Classes are all strands, each once, and each head's strands are what they would be in
/// one run.
TEST(HeadClasses, AreTheStrandsOfTheScene) {
  Toy toy;
  toy.write("t.toml", groom("shape = \"helix\"\n", "tolerance_m = 0.002\n"));
  const SceneOutline outline = read_outline(toy.path("work/t.toml"));
  ASSERT_TRUE(has_classes(outline));
  const auto found = head_classes(outline, 2);
  ASSERT_GT(found.size(), 1U);
  const Scene scene = classes();
  std::size_t strands = 0;
  for (const HeadClass& one : found) {
    EXPECT_EQ(one.outline.scene.name, "t." + std::to_string(one.elements));
    EXPECT_FALSE(no_head(one.outline));
    const SceneHead made = make_head(one.outline, {models::HeadNumber::float64, 4}, 2);
    ASSERT_EQ(made.head->strands(), one.outline.series->size());
    EXPECT_EQ(made.head->numbers(), 3U * (static_cast<std::size_t>(one.elements) + 1));
    std::size_t next = 0;
    for (const Strand& strand : scene.strands) {
      if (static_cast<int>(strand.segments.size()) != one.elements) continue;
      const Strand own = one.outline.series->strand(next++);
      EXPECT_EQ(norm(own.root.position - strand.root.position), 0);
      EXPECT_EQ(own.length(), strand.length());
    }
    EXPECT_EQ(next, one.outline.series->size());
    strands += next;
  }
  EXPECT_EQ(strands, 60U);
}

TEST(HeadClasses, RunAsHeadsWithFilesOfTheirOwn) {
  Toy toy;
  toy.write("t.toml",
            "guard = \"true\"\n" + groom("shape = \"helix\"\n", "tolerance_m = 0.002\n"));
  const Toy::Result result = toy.run("t.toml --as batch --out .");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, testing::HasSubstr("t: batches of equal elements: strands "));
  const auto found = head_classes(read_outline(toy.path("work/t.toml")), 1);
  for (const HeadClass& one : found) {
    const std::string stem = "t." + std::to_string(one.elements);
    EXPECT_THAT(toy.files(), testing::Contains(stem + ".h5"));
    EXPECT_THAT(toy.files(), testing::Contains(stem + ".csv"));
  }
}

TEST(HeadClasses, ThatTouchAreRefused) {
  Toy toy;
  toy.write("t.toml", groom("shape = \"helix\"\n",
                            "tolerance_m = 0.002\n[effects.strand_interaction]\n"));
  const Toy::Result result = toy.run("t.toml --as batch --out .");
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.error_lines(), 1);
  EXPECT_THAT(result.err, testing::HasSubstr("that touch each other"));
}

}  // namespace tress::test_detail
