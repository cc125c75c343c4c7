#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/validation/plectoneme.h"

namespace tress::test_plectoneme {

using namespace experiments;
using namespace experiments::validation;

// Small angles: T = (3/2) a^4 (1 - 2 a^2/3 + 4 a^2/3 + ...), so a is (2 T/3)^(1/4) but
// for a^2/6, and more with a^4.
TEST(PlyAngle, SolvesTheEquilibrium) {
  for (const double angle : {0.05, 0.3, 0.6}) {
    const double tension = std::pow(std::sin(angle), 4) * (0.5 + 1 / std::cos(2 * angle));
    EXPECT_NEAR(ply_angle(tension), angle, 1e-12);
  }
  const double first = std::pow(2e-6 / 3, 0.25);
  EXPECT_NEAR(ply_angle(1e-6) / first, 1 - first * first / 6, std::pow(first, 4));
}

// Up one helix and down the other, half a turn on, joined at the top by nothing. Chords
// of 2 e of angle: the tangent across two of them is off by e^2/6 of the part across the
// axis, the nearest point of a chord by its sagitta R e^2/2; e = 0.05.
TEST(Ply, OfTwoHelicesIsTheirsInRadiusAndAngle) {
  constexpr double radius = 4e-3, angle = 0.45, apart = 1e-3;
  const int n = 60;
  const double turn = apart * std::sin(angle) / radius, rise = apart * std::cos(angle);
  std::vector<double> x;
  for (int k = -n; k <= n; ++k) {
    const int up = n - std::abs(k);
    const double phi = turn * up, side = k < 0 ? 1 : -1;
    x.insert(x.end(),
             {side * radius * std::cos(phi), side * radius * std::sin(phi), rise * up});
  }
  const Ply found = ply(x, apart, 0.03, 2.4 * radius);
  const double half = turn / 2;
  EXPECT_GT(found.pairs, 30);
  EXPECT_NEAR(found.radius, radius, radius * half * half);
  EXPECT_NEAR(found.angle, angle, 4 * half * half);
}

TEST(Ply, OfAStraightLineIsNone) {
  std::vector<double> x;
  for (int k = 0; k < 100; ++k) x.insert(x.end(), {1e-3 * k, 0, 0});
  EXPECT_EQ(ply(x, 1e-3, 0.03, 0.01).pairs, 0);
}

// Without friction the clamp has its work back but for what drag and steps take; friction
// takes more where the plies slide.
TEST(Plectoneme, LosesWorkToFrictionWhenTwistedOnAndBack) {
  const auto variants = length_variants();
  const auto der = std::ranges::find_if(
      variants, [](const ModelVariant& v) { return v.model->id == "der"; });
  ASSERT_NE(der, variants.end());
  const auto lost = [&](double friction) {
    const TwistWork work = twist_on_and_back(*der, 125, friction, 2e-3, Deadline(600));
    EXPECT_GT(work.given, 0) << friction;
    return (work.given - work.returned) / work.given;
  };
  const double none = lost(0), some = lost(0.2);
  EXPECT_GT(none, 0);
  EXPECT_GT(some, 2 * none);
}

}  // namespace tress::test_plectoneme
