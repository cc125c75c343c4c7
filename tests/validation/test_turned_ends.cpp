#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "contract/input_error.h"
#include "experiments/validation/localised_buckling.h"
#include "experiments/validation/turned_ends.h"

namespace tress::test_turned_ends {

using namespace experiments;
using namespace experiments::validation;
using std::numbers::pi;

// Twice the first root of tan x = x; at M = 0 the column of Euler between clamps, near
// which T falls with M^2.
TEST(TwistThatBuckles, IsThatOfGreenhillAndOfEuler) {
  EXPECT_NEAR(twist_that_buckles(0), 2 * 4.493409457909064, 2e-4);
  const double first = twist_that_buckles(1 - 4 * pi * pi),
               second = twist_that_buckles(0.5 - 4 * pi * pi);
  EXPECT_NEAR(first * first / (second * second), 2, 0.02);
  EXPECT_NEAR(twist_that_buckles(1e6) / 2e3, 1, 1e-5);
  EXPECT_THROW(twist_that_buckles(-39.1), InputError);
  EXPECT_THROW(twist_that_buckles(std::nan("")), InputError);
}

// w = a + b s + c exp(i k s) + d exp(i l s) with k, l the roots of k^2 - M k + T = 0.
TEST(TwistThatBuckles, HasADeflectionThatTheClampsAdmit) {
  using Complex = std::complex<double>;
  const auto least = [](double moment, double tension) {
    const double root = std::sqrt(moment * moment - 4 * tension);
    Eigen::Matrix4cd rows;
    for (const int end : {0, 1}) {
      rows(2 * end, 0) = 1;
      rows(2 * end, 1) = end;
      rows(2 * end + 1, 0) = 0;
      rows(2 * end + 1, 1) = 1;
      for (const int k : {0, 1}) {
        const Complex rate(0, (moment + (k == 0 ? root : -root)) / 2);
        const Complex there = std::exp(rate * static_cast<double>(end));
        rows(2 * end, 2 + k) = there;
        rows(2 * end + 1, 2 + k) = rate * there;
      }
    }
    return Eigen::JacobiSVD<Eigen::Matrix4cd>(rows).singularValues()[3];
  };
  for (const double tension : {-20.0, 5.0, 60.0, 160.0}) {
    const double moment = twist_that_buckles(tension);
    EXPECT_LT(least(moment, tension), 1e-12) << tension;
    EXPECT_GT(least(1.01 * moment, tension), 1e-4) << tension;
  }
}

// Of the closed form of the infinite rod, at that rotation, the shortening at the jump is
// the largest.
TEST(LoopJump, IsTheLargestShorteningOfTheLocalisedHelix) {
  constexpr double twist_over_bend = 2.0 / 3;
  for (const double turns : {3.0, 6.0, 12.0}) {
    const double rotation = 2 * pi * turns;
    const LoopJump jump = loop_jump(rotation, twist_over_bend);
    const auto shortening = [&](double tilt) {
      const double decay =
          twist_over_bend * (rotation - 2 * tilt) * std::tan(tilt / 2) / 2;
      const LocalisedHelix helix{tilt, decay, 1 / twist_over_bend};
      EXPECT_NEAR(helix.turning() / rotation, 1, 1e-12);
      return helix.shortening();
    };
    EXPECT_NEAR(shortening(jump.tilt) / jump.shortening, 1, 1e-12);
    EXPECT_LT(shortening(jump.tilt - 0.01), jump.shortening);
    EXPECT_LT(shortening(jump.tilt + 0.01), jump.shortening);
  }
}

/// Measured over reference, by the model with its defaults.
double ratio(std::string_view test_name, std::string_view model, double turns,
             int elements) {
  const ValidationTest& test = find_validation_test(test_name);
  const auto variants = length_variants();
  const auto variant = std::ranges::find_if(
      variants, [&](const ModelVariant& v) { return v.model->id == model; });
  const Deadline deadline(600);
  return test.measure({*variant, elements, turns, deadline}) / test.reference(turns);
}

// The error falls with the square of the elements' length. 0.2 % are that of the slack.
TEST(TurnedEnds, BuckleAtTheTwistOfTheTheory) {
  EXPECT_NEAR(ratio("twist_buckling", "super_helix", 2.2, 40), 1, 0.01);
  const double coarse = 1 - ratio("twist_buckling", "der", 6, 57),
               fine = 1 - ratio("twist_buckling", "der", 6, 113);
  EXPECT_NEAR((coarse - 0.002) / (fine - 0.002), 113.0 * 113 / (57 * 57), 0.4);
}

TEST(TurnedEnds, JumpIntoALoopAtTheShorteningOfTheTheory) {
  EXPECT_NEAR(ratio("loop_jump", "super_clothoid", 6, 60), 1, 0.01);
  EXPECT_NEAR(ratio("loop_jump", "der", 6, 80), 1, 0.03);
}

TEST(TurnedEnds, WindUpAtTheAngleOfThePlies) {
  EXPECT_NEAR(ratio("plectoneme_supports", "corde", 12, 100), 1, 0.05);
}

}  // namespace tress::test_turned_ends
