#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "math/lane_math.h"
#include "math/lanes.h"

namespace tress::test_lane_math {

template <class T>
class LaneMath : public testing::Test {};
using Packs = testing::Types<PackOf<double, 1>, PackOf<double, 4>, PackOf<double, 8>,
                             PackOf<float, 8>, PackOf<float, 16>>;
TYPED_TEST_SUITE(LaneMath, Packs);

template <class T>
T filled(auto number) {
  T x;
  for (int lane = 0; lane < T::lanes; ++lane) set_lane(x, lane, number());
  return x;
}

TYPED_TEST(LaneMath, IsThatOfTheLibraryButForRounding) {
  constexpr double eps = std::numeric_limits<typename TypeParam::Scalar>::epsilon();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> even(-1, 1);
  for (int i = 0; i < 3000; ++i) {
    // Of all sizes; ratios on both sides of where formulas change.
    const auto angle =
        filled<TypeParam>([&] { return even(random) * std::pow(10, 4 * even(random)); });
    const auto positive =
        filled<TypeParam>([&] { return std::pow(10, 8 * even(random)); });
    const auto x = filled<TypeParam>(
        [&] { return i % 2 == 0 ? even(random) : 1 + even(random) / 9; });
    const auto y =
        filled<TypeParam>([&] { return even(random) * (i % 4 == 1 ? 0.3 : 1); });
    const auto turned = sine_cosine(angle);
    const TypeParam root = inverse_sqrt(positive), arc = arc_tangent(y, x);
    for (int lane = 0; lane < TypeParam::lanes; ++lane) {
      const auto of = [&](const TypeParam& z) { return lane_of(z, lane); };
      ASSERT_NEAR(of(turned.sine), std::sin(of(angle)), 2 * eps) << of(angle);
      ASSERT_NEAR(of(turned.cosine), std::cos(of(angle)), 2 * eps) << of(angle);
      ASSERT_NEAR(of(root) * std::sqrt(of(positive)), 1, 2 * eps) << of(positive);
      ASSERT_NEAR(of(arc), std::atan2(of(y), of(x)), 4 * eps) << of(y) << " " << of(x);
      ASSERT_EQ(of(magnitude(y)), std::abs(of(y)));
      ASSERT_EQ(of(larger(x, y)), std::max(of(x), of(y)));
    }
  }
}

TYPED_TEST(LaneMath, NeighboursDoNotMatter) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> even(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const auto x = filled<TypeParam>([&] { return even(random); });
    const auto y = filled<TypeParam>([&] { return even(random); });
    const TypeParam arc = arc_tangent(y, x);
    for (int lane = 0; lane < TypeParam::lanes; ++lane) {
      const TypeParam only =
          arc_tangent(TypeParam(lane_of(y, lane)), TypeParam(lane_of(x, lane)));
      ASSERT_EQ(lane_of(only, 0), lane_of(arc, lane));
    }
  }
  const TypeParam none(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(lane_of(inverse_sqrt(none), 0)));
  EXPECT_TRUE(std::isnan(lane_of(arc_tangent(none, none), 0)));
  EXPECT_TRUE(std::isnan(lane_of(sine_cosine(none).sine, 0)));
}

}  // namespace tress::test_lane_math
