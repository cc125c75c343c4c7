#include <gtest/gtest.h>

#include <tuple>

#include "contract/forms/energetics.h"
#include "models/effects/constant_force.h"
#include "tests/models/head/arrangements.h"
#include "tests/models/head/mixed_hairs.h"
#include "tests/models/head/spring_strands.h"

/// Heads of rods with a quaternion for every edge, by the methods that they have, against
/// the same strands by themselves.
namespace tress::test_quaternion_head {

using namespace simulation;
using namespace testing_support;

struct Rods {
  const char* id;
  std::unique_ptr<Head> (*make)(const HeadOptions&, const HeadPack&);
};
void PrintTo(const Rods& r, std::ostream* out) { *out << r.id; }  // NOLINT
constexpr Rods all_rods[] = {{"corde", corde_head}, {"xpbd_cosserat", cosserat_head}};

/// Single corrections need shorter steps, in the head or alone.
double step_of(const HairMethod& method) {
  return method.method == HeadMethod::backward_euler ? 1e-3 : 1e-4;
}

/// On bodies, or none, with options of the model, let go in their rest shape: sprung ones
/// whirl so fast that steps have several solutions.
struct Acted {
  std::string name;
  RodCase c;
  Effects effects = {};
  std::vector<std::pair<std::string, std::string>> options = {};
};
void PrintTo(const Acted& a, std::ostream* out) { *out << a.name; }  // NOLINT
std::vector<Acted> all_acted() {
  std::vector<Acted> all;
  for (RodCase c : spring_cases) {
    c.sprung = false;
    all.push_back({c.name, c});
  }
  for (const SpringBodies& b : spring_bodies) {
    all.push_back({"On" + b.name, case_of(b), effects_of(b, case_of(b))});
  }
  all.push_back(
      {"OtherNorm", {.name = "", .moves = true, .sprung = false}, {}, {{"norm", "30"}}});
  return all;
}

Parameters parameters_of(const Rods& rods, const Acted& acted) {
  Parameters all(find_model(rods.id).parameters, "test");
  for (const auto& [key, value] : acted.options) all.set(key, value);
  return all;
}
HeadOptions options_of(const Rods& rods, const Acted& acted, const HairMethod& method) {
  HeadOptions options = rod_options(acted.c);
  options.method = method.method;
  options.effects = acted.effects;
  if (!acted.options.empty()) options.model = parameters_of(rods, acted);
  return options;
}
std::unique_ptr<Head> head(const Rods& rods, const Acted& acted, const HairMethod& method,
                           const HeadPack& pack, std::size_t strands) {
  auto all = rods.make(options_of(rods, acted, method), pack);
  for (std::size_t k = 0; k < strands; ++k) all->add(rod(acted.c, k));
  return all;
}

/// A strand by itself, in a head's coordinates.
struct Alone {
  std::vector<double> q, v, x;
  Energy energy;
};
std::vector<double> in_edges(In q, const Vec& x0) {
  const std::size_t n = q.size() / 7;
  std::vector<double> all(7 * n);
  for (std::size_t i = 0; i < n; ++i) {
    store3(load3(&q[3 * i]) - (i == 0 ? x0 : load3(&q[3 * i - 3])), &all[7 * i]);
    std::copy_n(&q[3 * n + 4 * i], 4, &all[7 * i + 3]);
  }
  return all;
}
/// From a start that differs by `change`.
Alone alone(const Rods& rods, const Acted& acted, const HairMethod& method, std::size_t k,
            int steps, double change = 0) {
  const HeadOptions o = rod_options(acted.c);
  Effects effects = {std::make_shared<Gravity>(o.gravity),
                     std::make_shared<LinearDrag>(o.drag, o.mass_damping)};
  effects.insert(effects.end(), acted.effects.begin(), acted.effects.end());
  const auto system =
      find_model(rods.id).on_strand(rod(acted.c, k), parameters_of(rods, acted), effects);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n);
  system->initial_state(q, v);
  const Vec root = rod(acted.c, k).root.at(0).x;
  for (std::size_t i = 0; i < n; ++i) {
    const double from = i < 3 * n / 7 ? (&root.x)[i % 3] : 0;
    q[i] += (i % 2 == 0 ? change : -change) * (q[i] - from);
  }
  const double h = step_of(method), t = steps * h;
  const auto of = spring_method(method, *system, h);
  EXPECT_EQ(of->start(0, q, v), Status::ok);
  EXPECT_EQ(of->advance(t), Status::ok) << of->failure();
  Alone end{{}, {}, std::vector<double>(3 * n / 7 + 3), {}};
  system->material_points()->positions(t, of->q(), end.x);
  end.q = in_edges(of->q(), load3(end.x.data()));
  end.v = in_edges(of->v(), {});
  end.energy = system->energetics()->energy(t, of->q(), of->v());
  return end;
}

using Case = std::tuple<Rods, Acted, const HairMethod*>;
std::string name_of(const testing::TestParamInfo<Case>& of) {
  const auto& [rods, acted, method] = of.param;
  return std::string(rods.id) + "_" + acted.name + "_" + method->name;
}
class QuaternionHead : public testing::TestWithParam<Case> {
 protected:
  static const Rods& rods() { return std::get<0>(GetParam()); }
  static const Acted& acted() { return std::get<1>(GetParam()); }
  static const HairMethod& method() { return *std::get<2>(GetParam()); }
};

// Both have the same equations of a step, Jacobians and stresses, so that they come to
// the same solution, each to Newton's tolerance in every step. So strands differ by no
// more than such a change of the start makes, beside roundings: 1e-13 of coordinates of
// order 1, times the rate of 60/s at which these strands move.
TEST_P(QuaternionHead, StrandsMoveAsTheyDoAlone) {
  const double step = step_of(method());
  const int steps = step < 1e-3 ? 200 : 60;
  constexpr std::size_t strands = 5;
  constexpr double rate = 60;
  const auto all = head(rods(), acted(), method(), longest_doubles(), strands);
  advance_springs(*all, steps, step);
  const auto elements = static_cast<std::size_t>(acted().c.elements);
  const std::size_t n = 7 * elements, points = 3 * (elements + 1);
  std::vector<double> q(n), v(n), u;
  std::vector<HeadEnergy> energies(strands);
  const std::vector<double> x = spring_points(*all, steps * step, u);
  for (std::size_t b = 0, done = 0; b < all->blocks(); done += all->strands_of(b++)) {
    all->energies(b, steps * step, std::span(energies).subspan(done, all->strands_of(b)));
  }
  const double change = 1e-11 + method().left_after(steps);
  for (std::size_t k = 0; k < strands; ++k) {
    SCOPED_TRACE(k);
    EXPECT_FALSE(all->lost(k));
    all->state(k, q, v);
    const Alone want = alone(rods(), acted(), method(), k, steps),
                changed = alone(rods(), acted(), method(), k, steps, change),
                start = alone(rods(), acted(), method(), k, 0);
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + 1e-13);
    EXPECT_LE(apart(v, want.v), apart(changed.v, want.v) + 1e-13 * rate);
    const In own = In(x).subspan(k * points, points);
    EXPECT_LE(apart(own, want.x), apart(changed.x, want.x) + 1e-13);
    const double moved = apart(want.x, start.x);
    EXPECT_GT(moved, 1e-4);  // or this says nothing
    EXPECT_LT(apart(changed.x, want.x), 1e-2 * moved);
    const double potential = energies[k].elastic + energies[k].gravity,
                 size = std::abs(want.energy.potential) + want.energy.kinetic;
    if (!acted().effects.empty()) continue;  // which have a potential, too
    EXPECT_NEAR(energies[k].kinetic, want.energy.kinetic,
                1e-12 * size + std::abs(changed.energy.kinetic - want.energy.kinetic));
    EXPECT_NEAR(
        potential, want.energy.potential,
        1e-12 * size + std::abs(changed.energy.potential - want.energy.potential));
  }
}

TEST_P(QuaternionHead, LanesRefillsAndInstructionsGiveTheSameBits) {
  const double step = step_of(method());
  std::size_t want = 0;
  for (const auto& [pack, together] : arrangements()) {
    const auto all = head(rods(), acted(), method(), pack, 19);
    advance_springs(*all, 10, step, together);
    if (want == 0) want = all->hash();
    EXPECT_EQ(all->hash(), want) << pack.lanes << " " << together;
  }
}

/// But for single long edges of xpbd_cosserat by tr_bdf2, whose shear, of the section's
/// inertia alone, is too fast for such steps: any change of the start grows.
std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const Rods& rods : all_rods) {
    for (const Acted& acted : all_acted()) {
      for (const HairMethod* method : exact_methods) {
        const bool shears = rods.make == cosserat_head && acted.c.elements == 1;
        if (!shears || method != &tr_bdf2) all.emplace_back(rods, acted, method);
      }
    }
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(All, QuaternionHead, testing::ValuesIn(all_cases()), name_of);

using EachCase = std::tuple<Rods, const HairMethod*>;
class EachQuaternionMethod : public testing::TestWithParam<EachCase> {
 protected:
  static const Rods& rods() { return std::get<0>(GetParam()); }
  static const HairMethod& method() { return *std::get<1>(GetParam()); }
};

TEST_P(EachQuaternionMethod, GoesOnWithTheSameBitsInAHeadOfOtherLanes) {
  const double step = step_of(method());
  const Acted acted{"", {.name = "", .moves = true, .sprung = false}};
  const auto first = head(rods(), acted, method(), {HeadNumber::float64, 1}, 11),
             second = head(rods(), acted, method(), wide, 11);
  advance_springs(*first, 20, step);
  EXPECT_NE(second->hash(), first->hash());
  recall(*second, kept_of(*first));
  EXPECT_EQ(second->hash(), first->hash());
  for (Head* of : {first.get(), second.get()}) {
    const auto scratch = of->scratch();
    for (int s = 20; s < 40; ++s) of->step(0, of->blocks(), s * step, step, *scratch);
  }
  EXPECT_EQ(second->hash(), first->hash());
}

// 11 of 64 strands cannot be computed: the others move as they do without them.
TEST_P(EachQuaternionMethod, LosesStrandsByNameAndGoesOn) {
  const double step = step_of(method());
  const Acted acted{"", {.name = "", .sprung = false}};
  const auto fails = [](std::size_t k) { return k % 6 == 1; };
  for (const HeadPack& pack : packs_of_build(false)) {
    const auto sound = head(rods(), acted, method(), pack, 64),
               hurt = head(rods(), acted, method(), pack, 0);
    for (std::size_t k = 0; k < 64; ++k) {
      Strand one = rod(acted.c, k);
      if (fails(k)) {
        for (Segment& s : one.segments) s.natural = {1e200, -1e200, 1e200};
      }
      hurt->add(one);
    }
    advance_springs(*sound, 10, step);
    advance_springs(*hurt, 10, step);
    std::vector<double> q(70), v(70), want_q(70), want_v(70);
    for (std::size_t k = 0; k < 64; ++k) {
      ASSERT_EQ(hurt->lost(k), fails(k)) << k;
      hurt->state(k, q, v);
      sound->state(k, want_q, want_v);
      EXPECT_TRUE(fails(k) || q == want_q) << k;
      EXPECT_EQ(v, fails(k) ? std::vector<double>(70) : want_v) << k;
    }
    const std::vector<HeadLoss> losses = hurt->losses();
    ASSERT_EQ(losses.size(), 11U);
    EXPECT_EQ(losses[1].strand, 7U);
    EXPECT_NE(losses[1].reason, "");
  }
}

INSTANTIATE_TEST_SUITE_P(All, EachQuaternionMethod,
                         testing::Combine(testing::ValuesIn(all_rods),
                                          testing::ValuesIn(exact_methods)),
                         [](const auto& of) {
                           return std::string(std::get<0>(of.param).id) + "_" +
                                  std::get<1>(of.param)->name;
                         });

// Friction on stretch, which no other case has.
TEST(QuaternionHeadOptions, AreThoseOfTheModel) {
  Acted acted{"", {.name = "", .moves = true, .sprung = false}};
  const auto off = [&] {
    const auto all = head(all_rods[0], acted, newton, wide, 1);
    advance_springs(*all, 40, step_of(newton));
    std::vector<double> q(70), v(70);
    all->state(0, q, v);
    const Alone want = alone(all_rods[0], acted, newton, 0, 40),
                changed = alone(all_rods[0], acted, newton, 0, 40,
                                1e-11 + newton.left_after(40));
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + 1e-13);
    return want.q;
  };
  const std::vector<double> usual = off();
  acted.options = {{"coupling", "20"}, {"norm", "300"}, {"stretch_friction_n_s", "1e-3"}};
  EXPECT_GT(apart(off(), usual), 1e-5);  // or this says nothing
}

// Sums of some hundred roundings of 6e-8 of a strand's length: 1e-5 of it.
TEST(QuaternionHeadOf32Bits, MovesAsThatOf64) {
  constexpr double h = 1e-3;
  constexpr int steps = 320;
  for (const Rods& rods : all_rods) {
    for (const HairMethod* method : {&newton, &tr_bdf2}) {
      std::vector<std::vector<double>> x;
      std::vector<double> u;
      for (const HeadPack& pack :
           {longest_doubles(), HeadPack{HeadNumber::float32, 8}, longest_floats()}) {
        HeadOptions options = mixed_options(0);
        options.method = method->method;
        options.newton_tolerance = Options{}.newton_tolerance;
        const auto all = rods.make(options, pack);
        for (std::size_t k = 0; k < mixed; ++k) all->add(mixed_hair(k));
        advance_springs(*all, steps, h);
        EXPECT_TRUE(all->losses().empty());
        x.push_back(spring_points(*all, steps * h, u));
      }
      const double length = mixed_hair(0).length();
      EXPECT_LE(apart(x[1], x[0]), 1e-5 * length);
      EXPECT_NE(x[1], x[0]);
      EXPECT_EQ(x[2], x[1]);
    }
  }
}

TEST(QuaternionHeadInput, IsRefusedWithTheReason) {
  const Acted acted{"", {.name = "", .sprung = false}};
  for (const Rods& rods : all_rods) {
    EXPECT_THROW(head(rods, acted, one_solve, {}, 1), InputError);
    EXPECT_THROW(head(rods, acted, newton, {HeadNumber::float64, 16}, 1), InputError);
    EXPECT_THROW(head(rods, acted, midpoint, {HeadNumber::float32, 8}, 1), InputError);
    Acted pushed = acted;
    pushed.effects = {std::make_shared<ConstantForce>(Vec{1e-4, 0, 0}, Vec{1, 2, 3})};
    EXPECT_THROW(head(rods, pushed, newton, {}, 1), InputError);
    const auto all = head(rods, acted, newton, {}, 1);
    EXPECT_THROW(all->add(rod(acted.c, 0), pushed.effects), InputError);
  }
}

}  // namespace tress::test_quaternion_head
