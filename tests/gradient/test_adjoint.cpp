#include <gtest/gtest.h>

#include "contract/forms/natural_strains.h"
#include "tests/gradient/strand_runs.h"

namespace tress::test_adjoint {

using namespace testing_support;

/// A hair in its natural curl, let go, its root moved sideways.
StrandRun swing(const std::string& model, const std::string& method) {
  StrandRun run{&find_model(model), {}, method, {}, {}};
  run.settings = {{"elements", "4"},       {"internal_friction_kg_m3_s", "1e-10"},
                  {"drag_kg_m_s", "5e-5"}, {"natural_curvature_per_m", "20"},
                  {"motion", "shake"},     {"amplitude_m", "0.005"},
                  {"frequency_hz", "3"}};
  run.options.step = 0.002;
  run.options.newton_tolerance = 1e-13;
  run.stops = {0.01, 0.02};
  return run;
}

/// Every natural strain, and three parameters that are none.
std::vector<RunParameter> many(const StrandRun& run) {
  // The strand starts in its natural shape, to which the reference frames belong.
  std::vector<RunParameter> all = parameters(run, {{"youngs_modulus_pa", 3e9, 3e9},
                                                   {"drag_kg_m_s", 5e-5, 5e-5},
                                                   {"natural_curvature_per_m", 20, 10}});
  const std::size_t count = natural_strains(*run.make())->natural().size();
  for (std::size_t k = 0; k < count; ++k) {
    all.emplace_back([&run, k](double s) {
      auto system = run.make();
      std::vector<double> natural = natural_strains(*system)->natural();
      natural[k] += s * std::max(1.0, std::abs(natural[k]));
      natural_strains(*system)->set_natural(natural);
      return system;
    });
  }
  return all;
}

void expect_same(const TipGradient& found, const TipGradient& expected) {
  ASSERT_EQ(found.failure, "");
  ASSERT_EQ(expected.failure, "");
  for (std::size_t k = 0; k < expected.by.size(); ++k) {
    EXPECT_LT(apart(found.by[k], expected.by[k]), 1e-7) << k;
  }
}

double factor(const StepTable::Combination& of, std::size_t vector) {
  for (const auto& term : of) {
    if (term.vector == vector) return term.factor;
  }
  return 0;
}

// Vectors 0 and 1 are q and v, 2 is the acceleration.
TEST(StepProbe, FindsTheTableOfBackwardEuler) {
  constexpr double h = 0.125;
  const auto system = swing("super_helix", "backward_euler").make();
  const WatchedSystem none(*system);
  StepProbe probe("backward_euler", {});
  EXPECT_EQ(probe.start(0).operations.size(), 0u);
  const StepTable table = probe.step(h, none);
  ASSERT_EQ(table.inputs, 2u);
  ASSERT_EQ(table.operations.size(), 1u);
  const auto& stage = table.operations.front();
  EXPECT_EQ(stage.first, 2u);
  EXPECT_EQ(stage.w.vel, h);
  EXPECT_EQ(stage.w.pos, h * h);
  EXPECT_EQ(factor(stage.of[0], 0), 1);
  EXPECT_EQ(factor(stage.of[0], 1), h);
  EXPECT_EQ(factor(stage.of[1], 1), 1);
  EXPECT_EQ(factor(table.results[0], 2), h * h);
  EXPECT_EQ(factor(table.results[1], 2), h);
}

class AdjointOf : public testing::TestWithParam<std::string> {};

// Strains that are coordinates, or not, with a damped start.
TEST_P(AdjointOf, NaturalStrainsIsThatForward) {
  for (const char* model : {"super_helix", "der", "corde"}) {
    SCOPED_TRACE(model);
    const StrandRun run = swing(model, GetParam());
    const auto all = many(run);
    expect_same(adjoint_tip_gradient(run, all, GradientStart::damped),
                tip_gradient(run, all, GradientStart::damped));
  }
}

// Newton's method starts from another guess where a part begins: its tolerance, 1e-13 of
// the typical sizes, is all that differs.
TEST_P(AdjointOf, ARecordInPartsIsThatOfOne) {
  const StrandRun run = swing("der", GetParam());
  const auto all = many(run);
  constexpr std::size_t few_steps = 1000;  // bytes
  expect_same(adjoint_tip_gradient(run, all, GradientStart::damped, few_steps),
              adjoint_tip_gradient(run, all, GradientStart::damped));
}

// As tests/gradient/test_frames.cpp.
TEST_P(AdjointOf, FramesThatMoveIsRefused) {
  StrandRun run = swing("der", GetParam());
  run.settings.emplace_back("initial", "straight");
  run.options.step = 0.2 / 60;
  run.stops = {0.2};
  const auto system = run.make();
  AdjointRun adjoint(*system, run.make(), {}, {run.method, run.options});
  ASSERT_EQ(adjoint.start(), Status::ok);
  ASSERT_EQ(adjoint.advance(0.2), Status::ok);
  EXPECT_NE(
      adjoint.sweep(1, [](std::size_t, std::size_t, Out x_hat) { x_hat.back() = 1; }, {}),
      Status::ok);
  EXPECT_TRUE(adjoint.frames_moved());
  EXPECT_NE(adjoint.failure().find("forward in time"), std::string::npos);
}

// A stage takes its time, q, v and a; der also notes the twist of every edge in a step.
TEST_P(AdjointOf, TheRecordIsShort) {
  for (const char* model : {"super_helix", "der"}) {
    SCOPED_TRACE(model);
    const StrandRun run = swing(model, GetParam());
    const auto system = run.make();
    constexpr std::size_t few_steps = 1000;  // bytes
    const auto record = [&](std::size_t limit) {
      AdjointRun adjoint(*system, run.make(), {}, {run.method, run.options}, limit);
      EXPECT_EQ(adjoint.start(), Status::ok);
      EXPECT_EQ(adjoint.advance(0.02), Status::ok);
      return std::pair(adjoint.record_bytes(), adjoint.parts());
    };
    const auto n = static_cast<std::size_t>(system->layout().coordinates);
    const auto stages = static_cast<std::size_t>(find_integrator(GetParam()).stages);
    const auto [bytes, parts] = record(AdjointRun::most_record);
    EXPECT_EQ(parts, 1u);
    constexpr std::size_t steps = 10, edges = 4;
    EXPECT_LE(bytes / sizeof(double), (steps * stages + 1) * (3 * n + 8) + steps * edges);
    const auto [part_bytes, several] = record(few_steps);
    EXPECT_GT(several, 2u);
    EXPECT_LT(part_bytes, few_steps + bytes / steps);
  }
}

// 1e5 steps of 10 elements would take (3n + 8) 8e5 bytes, 78 MB with n = 30.
TEST(AdjointRun, RecordsOfLongRunsAreWrittenInParts) {
  StrandRun run = swing("super_helix", "backward_euler");
  run.settings[0].second = "10";
  constexpr int steps = 100'000;
  run.options.step = 0.1 / steps;
  const auto system = run.make();
  AdjointRun adjoint(*system, run.make(), {}, {run.method, run.options});
  ASSERT_EQ(adjoint.start(), Status::ok);
  ASSERT_EQ(adjoint.advance(0.1), Status::ok);
  EXPECT_GT(adjoint.parts(), 1u);
  EXPECT_LT(adjoint.record_bytes(), 200e6);
}

INSTANTIATE_TEST_SUITE_P(Methods, AdjointOf, testing::ValuesIn(stage_methods()),
                         [](const auto& c) { return c.param; });

}  // namespace tress::test_adjoint
