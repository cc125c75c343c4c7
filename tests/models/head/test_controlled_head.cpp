#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "tests/models/head/arrangements.h"
#include "tests/models/head/mixed_hairs.h"
#include "tests/support/refusal.h"

/// Heads whose strands choose their steps by a tolerance.
namespace tress::test_controlled_head {

using namespace simulation;
using namespace testing_support;
using testing::HasSubstr;

class ControlledHead : public testing::TestWithParam<HeadMaker> {
 protected:
  static std::unique_ptr<Head> head(const HeadOptions& options, const HeadPack& pack,
                                    const std::vector<std::size_t>& which) {
    auto made = GetParam().make(options, pack);
    for (const std::size_t k : which) made->add(mixed_hair(k));
    return made;
  }
  static std::unique_ptr<Head> head(const HeadOptions& options, const HeadPack& pack) {
    std::vector<std::size_t> all(mixed);
    std::iota(all.begin(), all.end(), 0);
    return head(options, pack, all);
  }
};

// Of all lanes, in each kind of number.
TEST_P(ControlledHead, AStrandIsTheSameBitsInAnyCompany) {
  for (const auto& [number, tolerance] : {std::pair{HeadNumber::float64, 1e-3},
                                          {HeadNumber::float64, 1e-2},
                                          {HeadNumber::float32, 1e-2}}) {
    if (number == HeadNumber::float32 && !GetParam().narrow) continue;
    std::vector<std::vector<double>> want;
    for (const HeadPack& pack : packs_of_build()) {
      if (pack.number != number) continue;
      for (const std::size_t together : {1, 2, 1000}) {
        const auto all = head(mixed_options(tolerance), pack);
        const HeadWork work = advance(*all, 0, intervals, 1, together);
        EXPECT_TRUE(all->losses().empty());
        EXPECT_TRUE(tolerance < 1e-2 || work.rejected_by_error > 0);
        if (want.empty()) want = kept_of(*all);
        EXPECT_EQ(kept_of(*all), want) << pack.lanes << ' ' << together;
      }
      for (const std::vector<std::size_t>& some :
           {std::vector<std::size_t>{3}, {11}, {10, 2, 5, 7, 0}}) {
        const auto few = head(mixed_options(tolerance), pack, some);
        advance(*few, 0, intervals);
        const auto kept = kept_of(*few);
        for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(kept[i], want[some[i]]);
      }
    }
  }
}

// In lanes of one step, where they can: of 64 hairs 4 by 4, lanes without one are few,
// though one in four takes other steps.
TEST_P(ControlledHead, StrandsTakeAsManyStepsAsEachNeeds) {
  const auto steps_of = [](const std::vector<Strand>& all) {
    const auto made = GetParam().make(mixed_options(1e-2), wide);
    for (const Strand& one : all) made->add(one);
    return advance(*made, 0, intervals);
  };
  const long calm = steps_of({calm_hair()}).steps,
             lively = steps_of({lively_hair()}).steps;
  EXPECT_GE(2 * lively, 3 * calm);
  std::vector<Strand> all;
  all.reserve(64);
  for (int k = 0; k < 64; ++k) all.push_back(k % 4 == 0 ? lively_hair() : calm_hair());
  const HeadWork work = steps_of(all);
  EXPECT_EQ(work.steps, 16 * lively + 48 * calm);
  EXPECT_LE(static_cast<double>(work.lanes), 1.05 * static_cast<double>(work.iterations));
}

TEST_P(ControlledHead, GoesOnFromWhatIsKeptWithTheSameBits) {
  const auto first = head(mixed_options(1e-3), wide),
             second = head(mixed_options(1e-3), {HeadNumber::float64, 1});
  advance(*first, 0, 3);
  const auto kept = kept_of(*first);
  EXPECT_NE(kept_of(*second), kept);
  recall(*second, kept);
  EXPECT_EQ(kept_of(*second), kept);
  advance(*first, 3, intervals);
  advance(*second, 3, intervals);
  EXPECT_NE(kept_of(*first), kept);
  EXPECT_EQ(kept_of(*second), kept_of(*first));
}

// Edges that turn by more than 60 degrees get new reference frames, before shorter steps
// of their strand as well: those of rods at rest are known.
TEST(ControlledRods, RenewTheirFramesAtTheirOwnSteps) {
  const auto rods = der_head(mixed_options(1e-3), wide);
  rods->add(calm_hair());
  const std::size_t state =
      rods->kept() - 7 * mixed_elements - 3;  // frames and twists, loss, length
  const auto before = kept_of(*rods)[0];
  advance(*rods, 0, intervals);
  const auto after = kept_of(*rods)[0];
  double turned = 1;  // cosine
  for (std::size_t i = state; i < state + 7 * mixed_elements; i += 7) {
    turned = std::min(turned, dot(load3(&before[i]), load3(&after[i])));
    EXPECT_NEAR(norm(load3(&after[i])), 1, 1e-12);
  }
  EXPECT_LT(turned, 0.5);
}

// Strands that are lost for one reason or the other leave the rest as it is.
TEST_P(ControlledHead, LosesStrandsByNameAndGoesOn) {
  const auto whole = head(mixed_options(1e-3), wide),
             hurt = head(mixed_options(1e-3), wide);
  auto kept = kept_of(*hurt);
  kept[5][0] = std::numeric_limits<double>::quiet_NaN();
  recall(*hurt, kept);
  advance(*whole, 0, intervals);
  advance(*hurt, 0, intervals);
  const auto losses = hurt->losses();
  ASSERT_EQ(losses.size(), 1);
  EXPECT_EQ(losses[0].strand, 5);
  EXPECT_EQ(losses[0].step, 1);
  EXPECT_EQ(losses[0].time, 0);
  EXPECT_THAT(std::string(losses[0].reason), HasSubstr("no acceleration at the start"));
  const auto want = kept_of(*whole), got = kept_of(*hurt);
  for (std::size_t k = 0; k < mixed; ++k) {
    EXPECT_EQ(got[k] == want[k], k != 5) << k;
  }
}

// By few iterations many steps have no solution: shorter ones have, and the strands go
// on.
TEST_P(ControlledHead, TakesShorterStepsWhereNewtonsIterationFails) {
  HeadOptions options = mixed_options(1e-2);
  options.newton_iterations = 1;
  const auto few = head(options, wide);
  const HeadWork work = advance(*few, 0, intervals);
  EXPECT_GT(work.rejected_by_newton, 0);
  EXPECT_EQ(work.in_parts, 0);
  EXPECT_TRUE(few->losses().empty());
  EXPECT_GT(work.steps, advance(*head(mixed_options(1e-2), wide), 0, intervals).steps);
}

// The shortest step without a solution is taken alone, damped, or in parts.
TEST_P(ControlledHead, TakesItsShortestStepsAloneAndLosesStrandsWithoutOne) {
  HeadOptions options = mixed_options(0.9);
  options.min_step = interval;
  options.newton_iterations = 2;
  std::vector<std::vector<double>> want;
  for (const int lanes : {1, 4}) {
    const auto whole = head(options, {HeadNumber::float64, lanes});
    const HeadWork work = advance(*whole, 0, intervals);
    EXPECT_GT(work.in_parts, 0);
    for (const HeadLoss& loss : whole->losses()) {
      EXPECT_THAT(std::string(loss.reason), HasSubstr("nor for 64 parts of it"));
    }
    EXPECT_LT(whole->losses().size(), mixed);
    if (want.empty()) want = kept_of(*whole);
    EXPECT_EQ(kept_of(*whole), want);
  }
}

// Those that are left are the same bits as without the lost ones.
TEST_P(ControlledHead, LosesStrandsThatNeedShorterStepsThanAllowed) {
  HeadOptions options = mixed_options(1e-2);
  options.min_step = 6e-4;
  const auto some = GetParam().make(options, wide), calm = GetParam().make(options, wide);
  for (int k = 0; k < 6; ++k) some->add(k % 2 == 0 ? calm_hair() : lively_hair());
  calm->add(calm_hair());
  advance(*some, 0, intervals);
  advance(*calm, 0, intervals);
  const auto losses = some->losses();
  ASSERT_EQ(losses.size(), 3);
  const auto got = kept_of(*some), want = kept_of(*calm);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(losses[i].strand, 2 * i + 1);
    EXPECT_GE(losses[i].step, 1);
    EXPECT_THAT(std::string(losses[i].reason), HasSubstr("too short a step"));
    EXPECT_EQ(got[2 * i], want[0]);
  }
  EXPECT_TRUE(calm->losses().empty());
}

TEST_P(ControlledHead, RefusesWhatItCannotKeep) {
  const auto why = [](double tolerance, HeadNumber number, HeadMethod method) {
    HeadOptions options = mixed_options(tolerance);
    options.method = method;
    const int lanes = number == HeadNumber::float64 ? 4 : 8;
    return refusal([&] { GetParam().make(options, {number, lanes}); });
  };
  const auto tr_bdf2 = HeadMethod::tr_bdf2;
  EXPECT_EQ(why(1e-6, HeadNumber::float64, tr_bdf2), "");
  EXPECT_EQ(why(1e-2, HeadNumber::float32, tr_bdf2) == "", GetParam().narrow);
  EXPECT_THAT(why(1e-3, HeadNumber::float32, tr_bdf2), HasSubstr("use 64 bits"));
  EXPECT_THAT(why(1e-12, HeadNumber::float64, tr_bdf2), HasSubstr("do not resolve"));
  for (const double tolerance : {-1e-3, 1.0, std::nan("")}) {
    EXPECT_THAT(why(tolerance, HeadNumber::float64, tr_bdf2),
                HasSubstr("between 0 and 1"));
  }
  for (const HeadMethod method :
       {HeadMethod::linearly_implicit_euler, HeadMethod::linearly_implicit_midpoint,
        HeadMethod::backward_euler}) {
    EXPECT_THAT(why(1e-3, HeadNumber::float64, method), HasSubstr("use tr_bdf2"));
  }
}

INSTANTIATE_TEST_SUITE_P(All, ControlledHead, testing::ValuesIn(controlled_heads),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace tress::test_controlled_head
