#include <gtest/gtest.h>

#include "contract/forms/natural_strains.h"
#include "tests/gradient/strand_runs.h"

namespace tress::test_start {

using namespace testing_support;

/// A hair of 0.1 m, straight, let go horizontally, its root moved sideways: 40 steps.
StrandRun swing(const std::string& method) {
  StrandRun run{&find_model("super_helix"), {}, method, {}, {}};
  run.settings = {{"elements", "10"},      {"internal_friction_kg_m3_s", "1e-10"},
                  {"drag_kg_m_s", "5e-5"}, {"initial", "straight"},
                  {"motion", "shake"},     {"amplitude_m", "0.005"},
                  {"frequency_hz", "3"}};
  run.options.step = 0.25 / 40;
  for (int k = 1; k <= 40; ++k) run.stops.push_back(run.options.step * k);
  return run;
}

/// Largest |d tip/d(natural twist)| over |d tip/d(natural curvature)|, of the first
/// element.
double twist_over_curvature(const std::string& method, GradientStart start) {
  const StrandRun run = swing(method);
  std::vector<RunParameter> parameters;
  for (std::size_t component = 0; component < 2; ++component) {
    parameters.push_back([&run, component](double s) {
      auto system = run.make();
      NaturalStrains& strains = *natural_strains(*system);
      std::vector<double> natural = strains.natural();
      natural[component] += 10 * s;
      strains.set_natural(natural);
      return system;
    });
  }
  const TipGradient found = tip_gradient(run, parameters, start);
  EXPECT_EQ(found.failure, "");
  return largest_of(found.by[0]) / largest_of(found.by[1]);
}

class GradientStartOf : public testing::TestWithParam<std::string> {};

// The natural twist of a straight strand of circular section hardly moves its tip: 8.7e-3
// of what a natural curvature does, with 320 steps of any method. It is far from the
// shape at the start, though, in which the twist has next to no inertia.
TEST_P(GradientStartOf, DampedIsFreeOfAShock) {
  const double ratio = twist_over_curvature(GetParam(), GradientStart::damped);
  EXPECT_GT(ratio, 1e-3);
  EXPECT_LT(ratio, 5e-2);
}

// What the damped start is for: methods that start from a0 = M^-1 f carry the shock on.
TEST_P(GradientStartOf, AsTheRunHasTheShockOfItsFirstAcceleration) {
  const double ratio = twist_over_curvature(GetParam(), GradientStart::as_run);
  const bool from_acceleration = GetParam() == "newmark" || GetParam() == "tr_bdf2" ||
                                 GetParam() == "generalized_alpha" ||
                                 GetParam() == "esdirk43";
  if (from_acceleration) {
    EXPECT_GT(ratio, 10);
  } else {
    EXPECT_LT(ratio, 5e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, GradientStartOf, testing::ValuesIn(stage_methods()),
                         [](const auto& c) { return c.param; });

}  // namespace tress::test_start
