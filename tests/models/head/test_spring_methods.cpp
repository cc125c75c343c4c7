#include <gtest/gtest.h>

#include <optional>
#include <tuple>

#include "tests/models/head/arrangements.h"
#include "tests/models/head/mixed_hairs.h"
#include "tests/models/head/spring_strands.h"
#include "tests/support/bare_system.h"

/// Heads of springs by the methods with the exact Jacobian; by linearly_implicit_euler in
/// test_spring_head.cpp.
namespace tress::test_spring_methods {

using namespace simulation;
using namespace testing_support;

/// Single corrections need shorter steps, in the head or alone: a tenth of `h`.
double step_of(const HairMethod& method, double h) {
  return method.method == HeadMethod::linearly_implicit_midpoint ? h / 10 : h;
}

/// Springs of a case, or on bodies, let go in their rest shape: sprung ones whirl so fast
/// that steps have no solution, or turn back. Nor have those of straight hairs with
/// friction, whose direction jumps where a joint without rest angle becomes straight.
struct Acted {
  std::string name;
  RodCase c;
  Effects effects = {};
};
void PrintTo(const Acted& a, std::ostream* out) { *out << a.name; }  // NOLINT
std::vector<Acted> all_acted() {
  std::vector<Acted> all;
  for (RodCase c : spring_cases) {
    c.sprung = false;
    if (c.curl == 0) c.friction = 0;
    all.push_back({c.name, c});
  }
  for (const SpringBodies& b : spring_bodies) {
    all.push_back({"On" + b.name, case_of(b), effects_of(b, case_of(b))});
  }
  return all;
}

using Method = std::tuple<Acted, const HairMethod*>;
class SpringMethods : public testing::TestWithParam<Method> {
 protected:
  static const RodCase& c() { return std::get<0>(GetParam()).c; }
  static const Effects& effects() { return std::get<0>(GetParam()).effects; }
  static const HairMethod& method() { return *std::get<1>(GetParam()); }
};

// Both have the same equations of a step, tangents and stresses, so that they come to the
// same solution, each to Newton's tolerance, over edges, in every step. So strands differ
// by no more than such a change of the start makes, beside roundings as in
// test_spring_head.cpp.
TEST_P(SpringMethods, StrandsMoveAsTheyDoAlone) {
  const double h = step_of(method(), 1e-3);
  const int steps = h < 1e-3 ? 200 : 60;
  constexpr std::size_t strands = 10;
  const double solved = method().left_after(steps);
  const auto all = springs(c(), method(), longest_doubles(), strands, effects());
  advance_springs(*all, steps, h);
  const auto n = static_cast<std::size_t>(3 * c().elements);
  std::vector<double> q(n), v(n), u;
  const std::vector<double> x = spring_points(*all, steps * h, u);
  double seen = 0;  // of the bodies
  for (std::size_t k = 0; k < strands; ++k) {
    SCOPED_TRACE(k);
    EXPECT_FALSE(all->lost(k));
    all->state(k, q, v);
    const SpringAlone want = spring_alone(c(), method(), k, steps, h, 0, effects()),
                      changed = spring_alone(c(), method(), k, steps, h, 1e-11 + solved,
                                             effects());
    const double rate = 60;
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + 1e-13);
    EXPECT_LE(apart(v, want.v), apart(changed.v, want.v) + 1e-13 * rate);
    EXPECT_LE(apart(In(x).subspan(k * (n + 3), n + 3), want.x),
              apart(changed.x, want.x) + 1e-13);
    const double moved = apart(want.x, spring_alone(c(), method(), k, 0, h, 0).x);
    EXPECT_GT(moved, 1e-4);  // or this says nothing
    EXPECT_LT(apart(changed.x, want.x), 1e-2 * moved);
    seen = std::max(seen, apart(spring_alone(c(), method(), k, steps, h, 0).x, want.x));
  }
  EXPECT_EQ(seen > 1e-4, !effects().empty()) << seen;
}

TEST_P(SpringMethods, LanesRefillsAndInstructionsGiveTheSameBits) {
  const double h = step_of(method(), 1.0 / 120);
  std::size_t want = 0;
  for (const auto& [pack, together] : arrangements()) {
    const auto all = springs(c(), method(), pack, 27, effects());
    advance_springs(*all, 10, h, together);
    if (want == 0) want = all->hash();
    EXPECT_EQ(all->hash(), want) << pack.lanes << " " << together;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SpringMethods,
                         testing::Combine(testing::ValuesIn(all_acted()),
                                          testing::ValuesIn(exact_methods)),
                         [](const auto& of) {
                           return std::get<0>(of.param).name +
                                  std::get<1>(of.param)->name;
                         });

class EachSpringMethod : public testing::TestWithParam<const HairMethod*> {};

TEST_P(EachSpringMethod, GoesOnWithTheSameBitsInAHeadOfOtherLanes) {
  const RodCase c{.name = "", .moves = true};
  const double h = step_of(*GetParam(), 1e-3);
  const auto first = springs(c, *GetParam(), {HeadNumber::float64, 1}, 11),
             second = springs(c, *GetParam(), {HeadNumber::float64, 4}, 11);
  advance_springs(*first, 20, h);
  EXPECT_NE(second->hash(), first->hash());
  recall(*second, kept_of(*first));
  EXPECT_EQ(second->hash(), first->hash());
  for (Head* of : {first.get(), second.get()}) {
    const auto scratch = of->scratch();
    for (int s = 20; s < 60; ++s) of->step(0, of->blocks(), s * h, h, *scratch);
  }
  EXPECT_EQ(second->hash(), first->hash());
}

// 11 of 64 strands cannot be computed: the others move as they do without them.
TEST_P(EachSpringMethod, LosesStrandsByNameAndGoesOn) {
  const RodCase c{""};
  const auto fails = [](std::size_t k) { return k % 6 == 1; };
  const double h = step_of(*GetParam(), 2e-3);
  for (const HeadPack& pack : packs_of_build(false)) {
    const auto sound = springs(c, *GetParam(), pack, 64),
               hurt = springs(c, *GetParam(), pack, 0);
    for (std::size_t k = 0; k < 64; ++k) {
      Strand one = rod(c, k);
      if (fails(k)) {
        for (Segment& s : one.segments) s.natural = {1e200, -1e200, 1e200};
      }
      hurt->add(one);
    }
    advance_springs(*sound, 10, h);
    advance_springs(*hurt, 10, h);
    std::vector<double> q(30), v(30), want_q(30), want_v(30);
    for (std::size_t k = 0; k < 64; ++k) {
      ASSERT_EQ(hurt->lost(k), fails(k)) << k;
      hurt->state(k, q, v);
      sound->state(k, want_q, want_v);
      EXPECT_TRUE(fails(k) || q == want_q) << k;
      EXPECT_EQ(v, fails(k) ? std::vector<double>(30) : want_v) << k;
    }
    const std::vector<HeadLoss> losses = hurt->losses();
    ASSERT_EQ(losses.size(), 11U);
    EXPECT_EQ(losses[1].strand, 7U);
    EXPECT_EQ(losses[1].step, 1);
    EXPECT_NE(losses[1].reason, "");
  }
}

/// Straight, wavy and curled hairs, soft and stiff ones, by itself, on a head that moves.
struct Hair {
  /// `bare`: with stresses of each state in the tangent.
  Hair(const HairMethod& by, std::size_t k, double h, const Effects& effects = {},
       bool bare = false, double change = 0) {
    const HeadOptions o = mixed_options(0);
    Strand strand = mixed_hair(k);
    strand.root.rotations = o.motion.rotations;
    strand.root.centre = o.motion.position;
    system = spring_alone(strand, o, by, effects);
    without.emplace(*system);
    const auto n = static_cast<std::size_t>(system->layout().coordinates);
    std::vector<double> q(n), v(n);
    system->initial_state(q, v);
    for (std::size_t i = 0; i < n; ++i) {
      q[i] += (i % 2 == 0 ? change : -change) * (q[i] - (&strand.root.position.x)[i % 3]);
    }
    method = spring_method(by, bare ? *without : *system, h);
    EXPECT_EQ(method->start(0, q, v), Status::ok);
  }
  std::vector<double> after(double t) {
    EXPECT_EQ(method->advance(t), Status::ok) << method->failure();
    std::vector<double> x(3 * (mixed_elements + 1));
    system->material_points()->positions(t, method->q(), x);
    return x;
  }

  std::unique_ptr<System> system;
  std::optional<BareSystem> without;
  std::unique_ptr<Integrator> method;
};

// As above; both iterate whole corrections, of frames' usual steps on bodies as well.
TEST_P(EachSpringMethod, StraightWavyAndCurledHairsMoveAsTheyDoAlone) {
  const bool once = GetParam()->method == HeadMethod::linearly_implicit_midpoint;
  const double h = once ? 2e-4 : 1.0 / 300;
  const int steps = once ? 1000 : 60;
  const double t = steps * h, changed_by = 1e-11 + GetParam()->left_after(steps);
  for (const Effects& effects : {Effects{}, mixed_body()}) {
    HeadOptions options = mixed_options(0);
    options.method = GetParam()->method;
    options.newton_tolerance = Options{}.newton_tolerance;
    options.effects = effects;
    const auto head = spring_head(options, wide);
    for (std::size_t k = 0; k < mixed; ++k) head->add(mixed_hair(k));
    advance_springs(*head, steps, h);
    std::vector<double> u;
    const std::vector<double> x = spring_points(*head, t, u);
    int touched = 0;
    for (std::size_t k = 0; k < mixed; ++k) {
      SCOPED_TRACE(k);
      const std::vector<double> want = Hair(*GetParam(), k, h, effects).after(t),
                                changed =
                                    Hair(*GetParam(), k, h, effects, false, changed_by)
                                        .after(t);
      EXPECT_LE(apart(In(x).subspan(k * want.size(), want.size()), want),
                apart(changed, want) + 1e-13);
      const double moved = apart(Hair(*GetParam(), k, h).after(0), want);
      EXPECT_GT(moved, 1e-2);  // or this says nothing
      EXPECT_LT(apart(changed, want), 1e-2 * moved);
      if (!effects.empty()) {
        touched += apart(Hair(*GetParam(), k, h).after(t), want) > 1e-3 ? 1 : 0;
      }
    }
    EXPECT_TRUE(effects.empty() || touched >= 3) << touched;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EachSpringMethod, testing::ValuesIn(exact_methods),
                         [](const auto& of) { return std::string(of.param->name); });

/// Iterations of them in 0.4 s.
struct Effort {
  long steps = 0, iterations = 0;
};
Effort effort_alone(const HairMethod& by, double h, bool bare) {
  Effort sum;
  for (std::size_t k = 0; k < mixed; ++k) {
    Hair one(by, k, h, {}, bare);
    EXPECT_EQ(one.method->advance(0.4), Status::ok) << one.method->failure();
    sum.steps += one.method->stats().steps;
    sum.iterations += one.method->stats().newton_iterations;
  }
  return sum;
}
HeadWork work_of_head(const HairMethod& method, double h, int times) {
  HeadOptions options = mixed_options(0);
  options.method = method.method;
  options.newton_tolerance = Options{}.newton_tolerance;
  const auto head = spring_head(options, wide);
  for (std::size_t k = 0; k < times * mixed; ++k) head->add(mixed_hair(k % mixed));
  const auto scratch = head->scratch();
  for (int s = 0; s < std::lround(0.4 / h); ++s) {
    head->step(0, head->blocks(), s * h, h, *scratch);
  }
  EXPECT_TRUE(head->losses().empty());
  return scratch->work;
}

// Lanes keep the stresses from the start of a step on, strands by themselves from that of
// a stage on: the second one of tr_bdf2 may take an iteration more in one step of ten.
// With stresses of each state a fourth more at least would be needed.
TEST(SpringNewton, ConvergesAsThatOfTheStrandAlone) {
  for (const HairMethod* method : {&newton, &tr_bdf2}) {
    for (const double h : {1.0 / 300, 1.0 / 120}) {
      const HeadWork work = work_of_head(*method, h, 1);
      const Effort alone = effort_alone(*method, h, false),
                   bare = effort_alone(*method, h, true);
      ASSERT_EQ(work.steps, alone.steps);
      EXPECT_EQ(work.retried, 0);
      EXPECT_LE(static_cast<double>(work.iterations),
                static_cast<double>(alone.iterations) +
                    (method == &newton ? 0 : 0.1) * static_cast<double>(alone.steps));
      EXPECT_GT(static_cast<double>(bare.iterations),
                1.25 * static_cast<double>(alone.iterations));
    }
  }
}

// In blocks as many as a call has, by whole corrections: lanes_per_iteration of
// experiments/heads. Strands that are retried one by one take a whole pack each.
TEST(SpringNewton, WastesFewLanes) {
  for (const HairMethod* method : {&newton, &tr_bdf2}) {
    for (const auto& [h, most] : {std::pair{1.0 / 120, 1.2}, {1.0 / 30, 1.5}}) {
      const HeadWork work = work_of_head(*method, h, 4);
      EXPECT_LE(static_cast<double>(work.lanes),
                most * static_cast<double>(work.iterations));
    }
  }
}

}  // namespace tress::test_spring_methods
