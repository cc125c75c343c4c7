#include <gtest/gtest.h>

#include "tests/gradient/strand_runs.h"

namespace tress::test_frames {

using namespace testing_support;

class GradientWithFrames : public testing::TestWithParam<std::string> {};

/// How often accept() moves the frames of a run.
int renewals(const StrandRun& run) {
  const auto system = run.make();
  std::vector<double> q(static_cast<std::size_t>(system->layout().coordinates)), v(q);
  system->initial_state(q, v);
  system->accept(0, q, v);
  const auto method = make_integrator(run.method, *system, run.options);
  EXPECT_EQ(method->start(0, q, v), Status::ok);
  int count = 0;
  std::vector<double> memory = system->memory();
  const std::size_t frames = 9 * 5;
  EXPECT_EQ(method->advance(run.stops.back(),
                            [&](double, In, In) {
                              const std::vector<double> now = system->memory();
                              count += std::equal(now.begin(), now.begin() + frames,
                                                  memory.begin())
                                           ? 0
                                           : 1;
                              memory = now;
                              return true;
                            }),
            Status::ok);
  return count;
}

// Edges of a falling hair turn by more than the 60 degrees after which der moves their
// reference frames. The step at which it does must be the same in the runs that are
// compared: with e = 1e-3 it is not for bdf2, whose derivatives are then 2e-5 apart.
// Rounding is some 1e-13 L over e, 1e-9 of derivatives of 0.2 L.
TEST_P(GradientWithFrames, IsThatOfDifferencesOfRuns) {
  StrandRun run{&find_model("der"), {}, GetParam(), {}, {0.1, 0.2}};
  run.settings = {{"elements", "5"},
                  {"initial", "straight"},
                  {"natural_curvature_per_m", "20"},
                  {"natural_curvature2_per_m", "15"},
                  {"drag_kg_m_s", "5e-5"},
                  {"internal_friction_kg_m3_s", "1e-10"}};
  run.options.step = 0.2 / 60;
  run.options.newton_tolerance = 1e-13;
  EXPECT_GT(renewals(run), 0);
  const std::vector<Varied> all{{"youngs_modulus_pa", 3e9, 3e9},
                                {"drag_kg_m_s", 5e-5, 5e-5},
                                {"natural_curvature_per_m", 20, 10}};
  const TipGradient found = tip_gradient(run, all);
  ASSERT_EQ(found.failure, "");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::vector<double> by_runs = difference(run, all[k], 1e-4);
    EXPECT_GT(largest_of(by_runs), 0.01) << all[k].key;
    EXPECT_LT(apart(found.by[k], by_runs), 1e-7) << all[k].key;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, GradientWithFrames, testing::ValuesIn(stage_methods()),
                         [](const auto& c) { return c.param; });

}  // namespace tress::test_frames
