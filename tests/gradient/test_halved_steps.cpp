#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "simulation/errors/halved_step.h"
#include "simulation/gradient/scene_gradient.h"

namespace tress::test_halved_steps {

using namespace simulation;

/// A hair that swings in viscous air, at 60 frames/s.
Scene swinging(const std::string& step, const std::string& gradient,
               const std::string& method = "tr_bdf2", double duration = 0.2) {
  return parse_scene("title = \"t\"\nduration_s = " + std::to_string(duration) +
                         "\nframes_per_s = 60\n[integrator]\nid = \"" + method +
                         "\"\nnewton_tolerance = 1e-12\n" + step +
                         "\n[material]\n[strand]\nelements = 4\nlength_m = 0.1\n"
                         "[root]\n[effects.gravity]\n[effects.linear_drag]\n"
                         "drag_kg_m_s = 1e-3\n[gradient]\nby = "
                         "[\"linear_drag.drag_kg_m_s\", \"root_angle_rad.y\"]\n" +
                         gradient,
                     "s.toml");
}

/// Largest difference of the derivatives by a parameter over all frames and points.
double apart(const SceneGradient& one, const SceneGradient& other, std::size_t by) {
  double most = 0;
  const auto &x = one.strands.at(0).by.at(by), &y = other.strands.at(0).by.at(by);
  EXPECT_EQ(x.size(), y.size());
  for (std::size_t f = 0; f < x.size(); ++f) {
    for (std::size_t i = 0; i < x[f].size(); ++i) {
      most = std::max(most, std::abs(x[f][i] - y[f][i]));
    }
  }
  return most;
}

struct Case {
  const char *method, *step, *start, *way;
};

class HalvedSteps : public testing::TestWithParam<Case> {};

// Frames are 16.7 ms: steps of 8.3 ms for dt_s = 16.6 ms, of 16.7 ms for 50 ms. The run
// with 32nds of the steps has at most 1/32 of the error with order 1. Of the rest the
// next order of the error leaves a part h/T with T = 0.1 s, the time in which the hair
// falls: 0.17.
TEST_P(HalvedSteps, EstimateTheErrorOfTheStepsThatARunTakes) {
  const Case& c = GetParam();
  const Scene scene = swinging(std::string("dt_s = ") + c.step,
                               std::string("start = \"") + c.start +
                                   "\"\nof = " + "\"points\"\nway = \"" + c.way + "\"\n",
                               c.method);
  const SceneGradient found = scene_gradient(scene),
                      reference = scene_gradient(scene, 32);
  ASSERT_EQ(found.strands.at(0).unfinished, "");
  for (std::size_t by = 0; by < 2; ++by) {
    const double error = apart(found, reference, by);
    EXPECT_GT(error, 0);
    EXPECT_NEAR(error_over_change(scene) * apart(found, scene_gradient(scene, 2), by),
                error, (1. / 32 + 0.17) * error)
        << found.parameters[by].name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Frames, HalvedSteps,
    testing::Values(Case{"tr_bdf2", "0.0166", "as_run", "forward"},
                    Case{"tr_bdf2", "0.05", "as_run", "forward"},
                    Case{"tr_bdf2", "0.0166", "damped", "forward"},
                    Case{"tr_bdf2", "0.05", "damped", "adjoint"},
                    Case{"backward_euler", "0.0166", "as_run", "adjoint"},
                    Case{"backward_euler", "0.05", "damped", "forward"}),
    [](const auto& tested) { return "Case" + std::to_string(tested.index); });

// 16.6 and 9 ms both give two steps to a frame.
TEST(HalvedStepsOfAGradient, EqualRunsHaveEqualGradientsAndEstimates) {
  for (const char* start : {"damped", "as_run"}) {
    const auto gradient = [&](const char* step, int parts) {
      return scene_gradient(swinging(std::string("dt_s = ") + step,
                                     std::string("start = \"") + start + "\"\n"),
                            parts);
    };
    for (const int parts : {1, 2}) {
      const SceneGradient found = gradient("0.0166", parts);
      for (std::size_t by = 0; by < 2; ++by) {
        EXPECT_EQ(apart(found, gradient("0.009", parts), by), 0) << start;
        EXPECT_GT(apart(found, gradient("0.02", parts), by), 0) << start;
      }
    }
  }
}

// The last frame is 3.3 ms after the one before: a step, whose half the others are not.
TEST(HalvedStepsOfAGradient, AShortLastFrameIsHalvedToo) {
  const Scene scene =
      swinging("dt_s = 0.008", "start = \"as_run\"\n", "backward_euler", 0.02);
  const SceneGradient half = scene_gradient(scene, 2);
  const Scene fine =
      swinging("dt_s = 0.0028", "start = \"as_run\"\n", "backward_euler", 0.02);
  EXPECT_LT(apart(half, scene_gradient(fine), 0),
            1e-9 * apart(half, scene_gradient(scene), 0));
}

// Both ways take the same steps: rounding and the differences of residuals in both.
TEST(HalvedStepsOfAGradient, AreThoseOfBothWays) {
  const auto gradient = [](const char* way) {
    return scene_gradient(
        swinging("dt_s = 0.0166",
                 std::string("start = \"damped\"\nway = \"") + way + "\"\n"),
        2);
  };
  const SceneGradient forward = gradient("forward"), adjoint = gradient("adjoint");
  ASSERT_TRUE(adjoint.strands.at(0).adjoint);
  const double size = std::abs(forward.strands.at(0).by[0].back().back());
  EXPECT_GT(size, 0);
  double most = 0;
  for (std::size_t i = forward.strands[0].by[0].back().size() - 3;
       i < forward.strands[0].by[0].back().size(); ++i) {
    most = std::max(most, std::abs(forward.strands[0].by[0].back()[i] -
                                   adjoint.strands[0].by[0].back()[i]));
  }
  EXPECT_LT(most, 1e-7 * size);
}

}  // namespace tress::test_halved_steps
