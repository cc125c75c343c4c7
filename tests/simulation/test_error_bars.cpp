// Estimated errors of a run against those found with a much finer run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "contract/input_error.h"
#include "experiments/simulate/outcome.h"
#include "simulation/errors/error_bars.h"
#include "simulation/run/world.h"
#include "simulation/scene_changes/changes.h"

namespace tress::test_error_bars {

using namespace experiments::scene_runs;
using namespace simulation;

constexpr double length = 0.1;  // m

/// A clamped hair, released horizontally.
Scene released(const std::string& integrator, const std::string& model = "super_helix",
               const std::string& more = "") {
  return parse_scene(
      "title = \"t\"\nduration_s = 0.1\nframes_per_s = 100\n[model]\nid = \"" + model +
          "\"\n[integrator]\n" + integrator +
          "\n[material]\nname = \"hair.asian\"\n[strand]\n"
          "length_m = 0.1\nelements = 8\nroot_tangent = [1, 0, 0]\n" +
          more + "[effects.gravity]\n",
      "released.toml");
}

/// Largest distance over the frames, over the length, of a scene's points from every
/// `each`-th point of a finer one.
double distance(const Scene& scene, const Scene& finer, std::size_t each) {
  World given(scene), reference(finer);
  double largest = 0;
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    EXPECT_EQ(given.advance(scene.time_of(frame)), Status::ok);
    EXPECT_EQ(reference.advance(scene.time_of(frame)), Status::ok);
    const auto& x = given.positions();
    const auto& y = reference.positions();
    EXPECT_EQ((y.size() / 3 - 1), each * (x.size() / 3 - 1));
    for (std::size_t i = 0; i < x.size() / 3; ++i) {
      const std::size_t a = 3 * i, b = 3 * each * i;
      largest = std::max(
          largest, std::hypot(x[a] - y[b], x[a + 1] - y[b + 1], x[a + 2] - y[b + 2]));
    }
  }
  return largest / length;
}

class InTime : public testing::TestWithParam<const char*> {};

/// The finer run of the test has 1/16 of the step: at most 1/16 of the error, at order 1.
/// Of the estimate itself the next power of the step is left, a part of the error of its
/// own size over the length (errors here are below 0.02) times some units.
TEST_P(InTime, TheEstimateOfAFixedStepIsTheError) {
  const Scene scene = released(GetParam());
  Scene reference = scene;
  reference.options.step /= 16;
  const double found = distance(scene, reference, 1);
  EXPECT_GT(found, 1e-5);
  const ErrorBar bar = time_error(scene, 1);
  ASSERT_EQ(bar.strands.size(), 1U);
  EXPECT_NEAR(bar.strands[0].error.largest, found, (1. / 16 + 0.1) * found);
  EXPECT_FALSE(bar.strands[0].parts);
  EXPECT_LE(bar.strands[0].error.rms, bar.strands[0].error.largest);

  // Of every point at every frame, the root's being held.
  ASSERT_EQ(bar.points.size(), scene.last_frame() + 1);
  float largest = 0;
  for (const std::vector<float>& points : bar.points) {
    ASSERT_EQ(points.size(), 9U);
    EXPECT_EQ(points[0], 0.F);
    largest = std::max(largest, std::ranges::max(points));
  }
  EXPECT_EQ(largest, static_cast<float>(bar.strands[0].error.largest));
}

INSTANTIATE_TEST_SUITE_P(Orders, InTime,
                         testing::Values("id = \"backward_euler\"\ndt_s = 0.00025",
                                         "id = \"implicit_midpoint\"\ndt_s = 0.002",
                                         "id = \"esdirk43\"\ndt_s = 0.01"),
                         [](const auto& tested) {
                           return "M" + std::to_string(tested.index);
                         });

/// Steps end at frames, here of 10 ms: a run with dt_s = 40 ms takes steps of 10 ms. The
/// last frame is 4 ms after the one before: one step. Tolerance as for other fixed steps.
TEST(ErrorBars, AStepLongerThanAFrameIsThatOfTheFrame) {
  Scene scene = released("id = \"esdirk43\"\ndt_s = 0.04");
  scene.duration = 0.104;
  Scene reference = scene;
  reference.options.step = 0.01 / 16;
  const double found = distance(scene, reference, 1);
  EXPECT_GT(found, 1e-5);
  EXPECT_NEAR(time_error(scene, 1).strands.at(0).error.largest, found,
              (1. / 16 + 0.1) * found);
}

/// 9.9 and 6 ms both give two steps to a frame of 10 ms: the runs are the same, and so
/// are those with half the steps.
TEST(ErrorBars, EqualRunsHaveEqualEstimates) {
  const auto error = [](const char* step) {
    return time_error(released(std::string("id = \"implicit_midpoint\"\ndt_s = ") + step),
                      1)
        .strands.at(0)
        .error;
  };
  const PointErrors found = error("0.0099");
  EXPECT_GT(found.largest, 1e-4);
  EXPECT_EQ(found.largest, error("0.006").largest);
  EXPECT_EQ(found.largest, error("0.005").largest);
  EXPECT_EQ(found.rms, error("0.006").rms);
}

/// A run of one step.
TEST(ErrorBars, OneStepIsHalvedToo) {
  Scene scene = released("id = \"tr_bdf2\"\ndt_s = 0.002");
  scene.duration = 0.001;
  EXPECT_GT(time_error(scene, 1).strands.at(0).error.largest, 0);
}

/// Strands 4 mm apart exchange their positions at the ends of steps, here once a frame.
TEST(ErrorBars, StepsBetweenExchangesAreHalvedToo) {
  const auto error = [](const std::string& step) {
    const std::string strand =
        "[[strand]]\nlength_m = 0.1\nelements = 4\nroot_tangent = [1, 0, 0]\n";
    const Scene scene = parse_scene(
        "title = \"t\"\nduration_s = 0.05\nframes_per_s = 100\n[model]\nid = "
        "\"super_helix\"\n[integrator]\nid = \"backward_euler\"\ndt_s = " +
            step + "\n[material]\nname = \"hair.asian\"\n" + strand + strand +
            "position_m = [0, 0.004, 0]\n[effects.gravity]\n"
            "[effects.strand_interaction]\n",
        "two.toml");
    return time_error(scene, 1).strands.at(0).error.largest;
  };
  EXPECT_GT(error("0.04"), 1e-3);
  EXPECT_EQ(error("0.04"), error("0.01"));
}

/// The error falls as the tolerance to the power 5/6 in the limit (tr_bdf2.cpp): a tenth
/// leaves 0.15 of it, and up to (1.2 / 0.95)^2 of that, for steps within the control's
/// dead band are left as they are.
TEST(ErrorBars, AToleranceIsComparedWithATenth) {
  const Scene scene = released("id = \"tr_bdf2\"\nposition_tol_rel = 1e-2");
  Scene reference = scene;
  reference.options.tolerance = 1e-6;
  const double found = distance(scene, reference, 1);
  const ErrorBar bar = time_error(scene, 1);
  EXPECT_NEAR(bar.strands.at(0).error.largest, found, 0.25 * found);
}

/// Eight times the elements have 1/64 of the error; the estimate leaves out terms of
/// order 4, a part of (1/8)^2 of it times some units.
TEST(ErrorBars, TheSpaceErrorIsTheDistanceFromFinerElements) {
  for (const char* const model : {"super_helix", "der"}) {
    const Scene scene = released("id = \"implicit_midpoint\"\ndt_s = 0.0005", model);
    const double found = distance(scene, with_elements(scene, 64), 8);
    const ErrorBar bar = space_error(scene, 1);
    ASSERT_EQ(bar.missing, "");
    EXPECT_NEAR(bar.strands.at(0).error.largest, found, 0.15 * found) << model;
  }
}

/// Elements that grow to the tip are no halves of each other: with points compared by
/// number, this strand would be off by a large part of an element.
TEST(ErrorBars, GradedElementsAreComparedAtEqualArcLength) {
  const std::string integrator = "id = \"implicit_midpoint\"\ndt_s = 0.0005";
  const auto error = [&](const std::string& more) {
    return space_error(released(integrator, "super_helix", more), 1)
        .strands.at(0)
        .error.largest;
  };
  const double even = error("");
  EXPECT_LT(error("grading = 2\n"), 2 * even);
  EXPECT_GT(error("grading = 2\n"), even / 10);
}

/// From where the two runs are a tenth of the length apart there is no estimate, and
/// until then none above that times Richardson's factor: 2 at order 1.
TEST(ErrorBars, NothingIsEstimatedAfterTheRunsPart) {
  Scene scene = released("id = \"backward_euler\"\ndt_s = 0.01");
  scene.duration = 1;
  scene.frame_rate = 30;
  scene.options.step = 1 / scene.frame_rate;
  Scene finer = scene;
  finer.options.step /= 2;
  ASSERT_GT(distance(scene, finer, 1), parted_from);
  const ErrorBar bar = time_error(scene, 1);
  ASSERT_TRUE(bar.strands.at(0).parts);
  EXPECT_EQ(bar.parted(), 1U);
  const double end = *bar.strands[0].parts;
  EXPECT_EQ(scene.time_of(bar.frames.size()), end);
  EXPECT_LT(bar.strands[0].largest_at, end);
  for (const PointErrors& frame : bar.frames) {
    EXPECT_LE(frame.largest, 2 * parted_from);
    EXPECT_LE(frame.rms, frame.largest);
  }
  EXPECT_NE(in_words("time", bar, scene).find("until"), std::string::npos);
  ASSERT_EQ(bar.points.size(), scene.last_frame() + 1);
  for (std::size_t frame = 0; frame < bar.points.size(); ++frame) {
    const bool together = frame < bar.frames.size();
    EXPECT_EQ(bar.points[frame][0], together ? 0.F : static_cast<float>(parted_from));
  }
}

TEST(ErrorBars, AStrandIsTheWorstByItsHorizonThenByItsError) {
  ErrorBar bar;
  bar.strands = {{{0.05, 0.01}, 0.1, {}},
                 {{0.01, 0.01}, 0.1, 0.7},
                 {{0.02, 0.01}, 0.1, 0.5},
                 {{0.03, 0.01}, 0.1, {}}};
  EXPECT_EQ(bar.worst(), 2U);
  EXPECT_EQ(bar.parted(), 2U);
  EXPECT_DOUBLE_EQ(bar.median(), 0.025);
  bar.strands.resize(1);
  EXPECT_EQ(bar.worst(), 0U);
}

TEST(ErrorBars, OwnElementsAreNotDoubledButTheTimePartIsGiven) {
  const Scene tree = parse_scene(
      "title = \"t\"\nduration_s = 0.1\nframes_per_s = 50\n[model]\nid = "
      "\"super_helix_tree\"\n"
      "[integrator]\nid = \"implicit_midpoint\"\ndt_s = 0.001\n",
      "tree.toml");
  EXPECT_NE(space_error(tree, 1).missing.find("cannot be doubled"), std::string::npos);
  const ErrorBar time = time_error(tree, 1);
  EXPECT_EQ(time.missing, "");
  EXPECT_GT(time.strands.at(0).error.largest, 0);
}

TEST(ErrorBars, OnlyAToleranceCanBeVerified) {
  EXPECT_THROW(check_verifiable(released("id = \"tr_bdf2\"\ndt_s = 0.001")), InputError);
  EXPECT_NO_THROW(
      check_verifiable(released("id = \"tr_bdf2\"\nposition_tol_rel = 1e-3")));
}

}  // namespace tress::test_error_bars
