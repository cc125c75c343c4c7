#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/dual.h"
#include "math/pack.h"
#include "tests/support/variable.h"

namespace tress::test_numbers {

constexpr double eps = std::numeric_limits<double>::epsilon();

const std::array<double, 4> first{1.5, -2.25, 1e-3, 7};
const std::array<double, 4> second{0.3, 4, -12, 1e5};

TEST(Pack, ArithmeticIsLaneByLane) {
  const Pack x = Pack::load(first.data());
  const Pack y = Pack::load(second.data());
  Pack up = x, down = x;
  up += y;
  down -= y;
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    const double a = first[static_cast<std::size_t>(lane)];
    const double b = second[static_cast<std::size_t>(lane)];
    EXPECT_EQ(x[lane], a);
    EXPECT_EQ((x + y)[lane], a + b);
    EXPECT_EQ((x - y)[lane], a - b);
    EXPECT_EQ((x * y)[lane], a * b);
    EXPECT_EQ((x / y)[lane], a / b);
    EXPECT_EQ((-x)[lane], -a);
    EXPECT_EQ((2.0 * x)[lane], 2 * a);
    EXPECT_EQ((x - 1.0)[lane], a - 1);
    EXPECT_EQ(up[lane], a + b);
    EXPECT_EQ(down[lane], a - b);
  }
}

TEST(Pack, SetsAndSums) {
  Pack x(1.0);
  x.set(2, 5.0);
  EXPECT_EQ(x[1], 1);
  EXPECT_EQ(x[2], 5);
  EXPECT_EQ(sum(x), 8);
  EXPECT_EQ(sum(Pack()), 0);
}

/// Every operation that needs no more of the scalar than arithmetic.
template <class T>
T rational(const T& x, const T& y) {
  T z = x * y - 2.0 / x;
  z += y * y * 0.5;
  z -= 3.0 * x;
  return -z / (1.0 + x * x);
}

// Lanes and scalars may fuse different products of a sum. Each of the dozen roundings is
// at most eps / 2 of a term; the largest term is below 10 times 1 + |f| here.
TEST(Dual, OfPacksHoldsADualInEveryLane) {
  const std::array<double, 4> xs{1.5, -2.25, 0.4, 7};
  const std::array<double, 4> ys{0.3, 4, -1.2, 0.9};
  using P = Dual<2, Pack>;
  P x(Pack::load(xs.data())), y(Pack::load(ys.data()));
  x.part[0] = 1;
  y.part[1] = 1;
  const P got = rational(x, y);
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    const auto k = static_cast<std::size_t>(lane);
    const Dual<2> one = rational(testing_support::variable<2>(xs[k], 0),
                                 testing_support::variable<2>(ys[k], 1));
    EXPECT_NEAR(got.value[lane], one.value, 60 * eps * (1 + std::abs(one.value)));
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(got.part[i][lane], one.part[i], 60 * eps * (1 + std::abs(one.part[i])));
      EXPECT_GT(std::abs(one.part[i]), 1e-3);
    }
  }
}

TEST(Dual, TakesTheFirstDerivatives) {
  const double x = 1.7, y = 0.6;
  const auto f =
      rational(testing_support::variable<2>(x, 0), testing_support::variable<2>(y, 1));
  const double z = x * y - 2 / x + y * y / 2 - 3 * x;
  const double d = 1 + x * x;
  EXPECT_NEAR(f.value, -z / d, 8 * eps);
  EXPECT_NEAR(f.part[0], -(y + 2 / (x * x) - 3) / d + z * 2 * x / (d * d), 8 * eps);
  EXPECT_NEAR(f.part[1], -(x + y) / d, 8 * eps);
}

TEST(Dual, NestedTakesTheSecondDerivatives) {
  const double x = 0.8, y = 1.9;
  const auto f =
      sin(testing_support::variable2<2>(x, 0)) *
          sqrt(testing_support::variable2<2>(y, 1)) +
      cos(testing_support::variable2<2>(x, 0)) / testing_support::variable2<2>(y, 1);
  const double sine = std::sin(x), cosine = std::cos(x), root = std::sqrt(y);
  EXPECT_NEAR(f.value.value, sine * root + cosine / y, 8 * eps);
  EXPECT_NEAR(f.part[0].value, cosine * root - sine / y, 8 * eps);
  EXPECT_NEAR(f.part[1].value, sine / (2 * root) - cosine / (y * y), 8 * eps);
  EXPECT_NEAR(f.part[0].part[0], -sine * root - cosine / y, 8 * eps);
  EXPECT_NEAR(f.part[0].part[1], cosine / (2 * root) + sine / (y * y), 8 * eps);
  EXPECT_NEAR(f.part[1].part[1], -sine / (4 * root * y) + 2 * cosine / (y * y * y),
              8 * eps);
}

}  // namespace tress::test_numbers
