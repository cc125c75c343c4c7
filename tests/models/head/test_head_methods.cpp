#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/models/head/der_strands.h"
#include "tests/models/head/hairs.h"
#include "tests/models/head/mixed_hairs.h"
#include "tests/support/apart.h"
#include "tests/support/refusal.h"

/// What methods of heads are beyond their steps one by one (test_reduced_head.cpp,
/// test_der_head.cpp): their order, steps of other lengths, steps whose equations are
/// hard to solve, and where they are refused.
namespace tress::test_head_methods {

using namespace simulation;
using testing::HasSubstr;
using testing_support::advance;
using testing_support::alone;
using testing_support::Case;
using testing_support::change_of_start;
using testing_support::exact;
using testing_support::exact_methods;
using testing_support::hair_models;
using testing_support::HairMethod;
using testing_support::HairModel;
using testing_support::head;
using testing_support::HeadMaker;
using testing_support::left_by_newton;
using testing_support::packs_of;
using testing_support::points;
using testing_support::refusal;
using testing_support::rod;
using testing_support::rod_options;
using testing_support::RodCase;
using testing_support::rods;
using testing_support::spring_masses;

/// Of four strands at t after so many steps of the method.
using After = std::function<std::vector<double>(const HairMethod&, double t, int steps)>;
std::vector<double> after(Head& all, double t, int steps) {
  advance(all, steps, t / steps);
  EXPECT_TRUE(all.losses().empty());
  return points(all, t);
}

void expect_order(const HairMethod& method, double t, int steps, const After& of) {
  const int order = method.method == HeadMethod::backward_euler ? 1 : 2;
  // Of second order by steps that are shorter by 4 at least: an error of it is smaller by
  // 4^2, which changes the power by log2(1 + 4^-2) at most.
  const std::vector<double> want = of(testing_support::tr_bdf2, t, 16 * steps);
  double before = apart(of(method, t, steps), want);
  for (const int more : {2, 4}) {
    const double error = apart(of(method, t, more * steps), want);
    EXPECT_NEAR(std::log2(before / error), order, 0.2) << more;
    EXPECT_GT(error, 1e-9);  // above what Newton's method leaves
    before = error;
  }
}

using Method = std::tuple<const HairModel*, const HairMethod*>;
class HeadMethods : public testing::TestWithParam<Method> {
 protected:
  static Case of(Case c, const HairMethod& method = *std::get<1>(GetParam())) {
    c.model = std::get<0>(GetParam());
    return exact(c, method);
  }
};

TEST_P(HeadMethods, ErrorsFallWithTheOrder) {
  // Half differences of clothoids vibrate faster than means.
  const int first = std::get<0>(GetParam()) == &testing_support::clothoids ? 256 : 128;
  expect_order(*std::get<1>(GetParam()), 0.064, first,
               [](const HairMethod& method, double t, int steps) {
                 return after(
                     *head(of({.name = "", .elements = 4, .moves = true}, method),
                           {HeadNumber::float64, 4}, 4),
                     t, steps);
               });
}

// As in test_reduced_head.cpp; accelerations of other steps before are on no even grid.
TEST_P(HeadMethods, StepsOfOtherLengthsAreThoseOfTheStrandAlone) {
  const Case c = of({.name = "", .moves = true});
  const double lengths[] = {1e-3, 1e-3, 1.4e-3, 5e-4, 5e-4, 2e-3, 1e-3};
  const int steps = static_cast<int>(std::size(lengths));
  const auto all = head(c, {HeadNumber::float64, 4}, 4);
  const auto scratch = all->scratch();
  double t = 0;
  for (const double h : lengths) {
    all->step(0, 1, t, h, *scratch);
    t += h;
  }
  std::vector<double> q(c.coordinates()), v(q.size());
  for (std::size_t k = 0; k < 4; ++k) {
    const auto want = alone(c, k, lengths, 1, 0),
               changed = alone(c, k, lengths, 1, change_of_start(c, steps));
    all->state(k, q, v);
    const double left = left_by_newton(c);
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + left * want.size);
    EXPECT_LE(apart(v, want.v), apart(changed.v, want.v) + left * want.rate);
    EXPECT_GT(apart(want.x, alone(c, k, 0, 0).x), 1e-4);
  }
}

// Of hairs let go in another shape than that at rest whole corrections fail.
class HardSteps : public HeadMethods {};
TEST_P(HardSteps, AreTheSameBitsForAnyLanes) {
  Case c = of({.name = "", .moves = true});
  c.sprung = true;
  std::size_t want[2] = {};
  for (const HeadPack& pack : packs_of(c)) {
    const auto all = head(c, pack, 9);
    const auto scratch = all->scratch();
    constexpr double h = 1.0 / 240;
    for (int s = 0; s < 2; ++s) all->step(0, all->blocks(), s * h, h, *scratch);
    const HeadWork& work = scratch->work;
    EXPECT_EQ(work.steps, 2 * 9);
    EXPECT_GT(work.retried, 0);
    EXPECT_GT(work.in_parts, 0);
    std::size_t& one = want[pack.number == HeadNumber::float64 ? 0 : 1];
    if (one == 0) one = all->hash();
    EXPECT_EQ(all->hash(), one) << pack.lanes;
  }
}

// One correction a step once two have been iterated, two stages a step.
TEST_P(HeadMethods, WorkIsThatOfTheMethod) {
  const auto all = head(of({}), testing_support::longest_doubles(), 16);
  const auto scratch = all->scratch();
  const auto step = [&](int s) { all->step(0, all->blocks(), s * 1e-3, 1e-3, *scratch); };
  for (int s = 0; s < 2; ++s) step(s);
  const HeadWork first = scratch->work;
  for (int s = 2; s < 12; ++s) step(s);
  const long more = scratch->work.iterations - first.iterations;
  const HairMethod& method = *std::get<1>(GetParam());
  if (method.method == HeadMethod::linearly_implicit_midpoint) {
    EXPECT_GT(first.iterations, 2 * 16);
    EXPECT_EQ(more, 10 * 16);
    EXPECT_EQ(scratch->work.retried, first.retried);
  } else {
    const int stages = method.method == HeadMethod::tr_bdf2 ? 2 : 1;
    EXPECT_GE(more, stages * 10 * 16);
    EXPECT_LE(more, stages * 10 * 16 * 4);
  }
}

std::string name_of(const testing::TestParamInfo<Method>& of) {
  return std::string(std::get<0>(of.param)->name) + std::get<1>(of.param)->name;
}
INSTANTIATE_TEST_SUITE_P(All, HeadMethods,
                         testing::Combine(testing::ValuesIn(hair_models),
                                          testing::ValuesIn(exact_methods)),
                         name_of);
// Steps in parts are those of the method: of clothoids, which take the most time, others
// than Newton's are `More`.
using testing_support::chains;
using testing_support::clothoids;
using testing_support::helices;
INSTANTIATE_TEST_SUITE_P(All, HardSteps,
                         testing::Combine(testing::Values(&helices, &chains),
                                          testing::ValuesIn(exact_methods)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Clothoids, HardSteps,
                         testing::Combine(testing::Values(&clothoids),
                                          testing::Values(&testing_support::newton)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(More, HardSteps,
                         testing::Combine(testing::Values(&clothoids),
                                          testing::Values(&testing_support::midpoint,
                                                          &testing_support::tr_bdf2)),
                         name_of);

/// Heads whose elements stretch.
using Stretched = std::tuple<const HeadMaker*, const HairMethod*>;
class StretchedMethods : public testing::TestWithParam<Stretched> {};

// So soft, and steps so short, that stretching is resolved.
TEST_P(StretchedMethods, ErrorsFallWithTheOrder) {
  const HeadMaker& maker = *std::get<0>(GetParam());
  const RodCase c{
      .name = "", .elements = 4, .moves = true, .sprung = false, .youngs_modulus = 1e7};
  expect_order(*std::get<1>(GetParam()), 0.032, 512,
               [&](const HairMethod& of, double t, int steps) {
                 HeadOptions options = rod_options(c);
                 options.method = of.method;
                 const auto all = maker.make(options, {HeadNumber::float64, 4});
                 for (std::size_t k = 0; k < 4; ++k) all->add(rod(c, k));
                 return after(*all, t, steps);
               });
}

INSTANTIATE_TEST_SUITE_P(All, StretchedMethods,
                         testing::Combine(testing::Values(&rods, &spring_masses),
                                          testing::ValuesIn(exact_methods)),
                         [](const auto& of) {
                           return std::string(std::get<0>(of.param)->name) +
                                  std::get<1>(of.param)->name;
                         });

TEST(HeadMethodsRefused, WithTheReason) {
  for (const HairMethod* method : exact_methods) {
    HeadOptions of_rods = rod_options({""});
    of_rods.method = method->method;
    EXPECT_THAT(refusal([&] {
                  spring_head(of_rods, {HeadNumber::float32, 8});
                }),
                HasSubstr("use 64 bits"));
    HeadOptions weightless = of_rods;
    weightless.rotary_inertia = false;
    const bool starts = method->method == HeadMethod::tr_bdf2;
    const bool midpoint = method->method == HeadMethod::linearly_implicit_midpoint;
    for (const auto make : {helix_head, chain_head, der_head}) {
      EXPECT_EQ(refusal([&] { make(of_rods, {}); }), "");
      const std::string why = refusal([&] { make(weightless, {}); });
      EXPECT_EQ(why != "", starts) << why;
      EXPECT_THAT(why, HasSubstr(starts ? "leave rotary_inertia on" : ""));
    }
    const HeadPack narrow{HeadNumber::float32, 8};
    for (const auto make : {chain_head, der_head}) {
      const std::string why = refusal([&] { make(of_rods, narrow); });
      EXPECT_EQ(why != "", midpoint) << why;
      EXPECT_THAT(why, HasSubstr(midpoint ? "use 64 bits" : ""));
    }
    EXPECT_EQ(refusal([&] { helix_head(of_rods, narrow); }), "");
    weightless.twist = false;
    for (const auto make : {helix_head, chain_head, spring_head}) {
      EXPECT_EQ(refusal([&] { make(weightless, {}); }), "");
    }
  }
}

}  // namespace tress::test_head_methods
