#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "contract/input_error.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"

namespace tress::test_effects {

using namespace models;

struct Sample {
  std::vector<double> x{0.1, -0.4, 2.0, 1.0, 0.5, -0.3};
  std::vector<double> v{1.0, 0.2, -0.7, -0.1, 0.9, 0.4};
  std::vector<double> mass{0.3, 1.7};
  std::vector<double> length{0.2, 0.5};

  Points points() const { return {2, x, v, {}, mass, length}; }
};

std::vector<double> load(const Effect& effect, const Sample& at) {
  std::vector<double> f(6, 0.0);
  effect.add_load(0, at.points(), f);
  return f;
}

/// Power of the load, taken to be f.v.
double rate_of_work(const std::vector<double>& f, const std::vector<double>& v) {
  double sum = 0;
  for (std::size_t i = 0; i < f.size(); ++i) sum += f[i] * v[i];
  return sum;
}

/// dV/dt along x' = v: exact for potentials linear in x, as gravity's is.
double potential_rate(const Effect& effect, const Sample& at) {
  Sample later = at;
  for (std::size_t i = 0; i < 6; ++i) later.x[i] += at.v[i];
  return effect.potential(0, later.points()) - effect.potential(0, at.points());
}

void expect_power_balance(const Effect& effect) {
  const Sample at;
  const double work = rate_of_work(load(effect, at), at.v);
  EXPECT_GT(std::abs(work), 1e-3);
  // f.v = power - dV/dt; rounding of sums of 12 terms of size 30: 1e-14
  EXPECT_NEAR(work, effect.power(0, at.points()) - potential_rate(effect, at), 1e-13);
}

TEST(Gravity, WorkIsThePotentialItLoses) { expect_power_balance(Gravity({1, 2, -9.81})); }

TEST(LinearDrag, WorkIsItsPowerAndNegative) {
  const LinearDrag drag(0.7, 0.4);
  expect_power_balance(drag);
  EXPECT_LT(drag.power(0, Sample{}.points()), 0);
}

TEST(Gravity, PullsByMassAndAddsToWhatIsThere) {
  const Sample at;
  std::vector<double> f(6, 1.0);
  Gravity({0, 0, -9.81}).add_load(0, at.points(), f);
  EXPECT_EQ(f[0], 1.0);
  EXPECT_DOUBLE_EQ(f[2], 1.0 - 0.3 * 9.81);
  EXPECT_DOUBLE_EQ(f[5], 1.0 - 1.7 * 9.81);
}

TEST(LinearDrag, DampsByLengthAndByMass) {
  const Sample at;
  const auto f = load(LinearDrag(0.7, 0.4), at);
  EXPECT_DOUBLE_EQ(f[0], -(0.7 * 0.2 + 0.4 * 0.3) * 1.0);
  EXPECT_DOUBLE_EQ(f[4], -(0.7 * 0.5 + 0.4 * 1.7) * 0.9);
}

TEST(LinearDrag, DerivativeBlocksAreTheDifferenceOfTheLoad) {
  const LinearDrag drag(0.7, 0.4);
  const Sample at;
  std::vector<double> blocks(18, 0.0);
  drag.add_derivatives(0, at.points(), 3.0, 2.0, blocks);
  for (std::size_t p = 0; p < 2; ++p) {
    for (std::size_t j = 0; j < 3; ++j) {
      Sample moved = at;
      moved.v[3 * p + j] += 1;  // the load is linear, so any step is exact
      const auto f0 = load(drag, at);
      const auto f1 = load(drag, moved);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(blocks[9 * p + 3 * i + j], 2 * (f1[3 * p + i] - f0[3 * p + i]),
                    1e-14);
      }
    }
  }
  EXPECT_NE(blocks[0], 0);
}

TEST(Needs, AreTheUnionOfTheEffects) {
  Effects effects;
  EXPECT_FALSE(needs(effects).velocity);
  effects.push_back(std::make_unique<Gravity>(Vec{0, 0, -9.81}));
  EXPECT_FALSE(needs(effects).velocity || needs(effects).derivatives);
  effects.push_back(std::make_unique<LinearDrag>(0.1));
  EXPECT_TRUE(needs(effects).velocity && needs(effects).derivatives);
  EXPECT_FALSE(needs(effects).tangent || needs(effects).position);
  EXPECT_TRUE((Needs{.position = true} | Needs{}).position);
  EXPECT_TRUE((Needs{} | Needs{.position = true}).position);
}

TEST(Effects, RefuseNumbersOutsideTheirMeaning) {
  EXPECT_THROW(LinearDrag(-1), InputError);
  EXPECT_THROW(LinearDrag(1, -1), InputError);
  EXPECT_THROW(LinearDrag(1, std::nan("")), InputError);
  EXPECT_THROW(LinearDrag(std::nan("")), InputError);
  EXPECT_THROW(Gravity({0, std::nan(""), 0}), InputError);
}

}  // namespace tress::test_effects
