#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "contract/input_error.h"
#include "models/effects/body.h"
#include "models/effects/catalogue.h"
#include "models/effects/constant_force.h"
#include "models/effects/exact_body.h"
#include "models/effects/self_contact.h"
#include "models/effects/strand_interaction.h"
#include "models/effects/tether.h"
#include "models/head/semidefinite.h"
#include "models/reduced/definite_block.h"
#include "tests/models/effects/sphere_grid.h"
#include "tests/models/head/hairs.h"
#include "tests/support/apart.h"

namespace tress::test_head_effects {

using namespace simulation;
using testing_support::advance;
using testing_support::Alone;
using testing_support::alone;
using testing_support::Case;
using testing_support::change_of_start;
using testing_support::clothoids;
using testing_support::exact;
using testing_support::exact_methods;
using testing_support::hair_models;
using testing_support::HairMethod;
using testing_support::HairModel;
using testing_support::head;
using testing_support::left_by_newton;
using testing_support::longest_doubles;
using testing_support::longest_floats;
using testing_support::midpoint;
using testing_support::options;
using testing_support::packs_of;
using testing_support::packs_of_build;
using testing_support::sphere_samples;
using testing_support::strand;

constexpr double h = testing_support::hair_step;

// So soft that strands which overlap it at first move by centimetres in 10 ms and not by
// metres; friction and damping of the order of the spring's force.
constexpr BodyContact soft{
    .stiffness = 0.05, .damping = 0.5, .friction = 0.4, .slip = 0.02, .offset = 1e-3};

std::shared_ptr<const Effect> body(BodyShape shape, const Vec& x,
                                   std::optional<RootMotion> follows = {}) {
  return std::make_shared<Body>(std::move(shape),
                                StrandPlace{x, rotation({0.6, 0, 0.8}, 0.7)}, soft,
                                std::move(follows));
}

RootMotion moving_head() {
  const Case moves{.name = "", .moves = true};
  return options(moves).motion;
}

Tether::Settings pulled() {
  return {.at = 0.7, .stiffness = 1e-3, .damping = 1e-5, .target = {0.2, 0, 1.4}};
}

/// All strands where they are at first, each near some of the others.
std::shared_ptr<StrandInteraction> neighbours(std::size_t strands,
                                              const HairModel& model) {
  const Case c{.name = "", .model = &model};
  const auto all = head(c, {HeadNumber::float64, 4}, strands);
  std::vector<double> x(strands * all->numbers()), v(x.size());
  for (std::size_t b = 0, first = 0; b < all->blocks(); ++b) {
    const std::size_t size = all->strands_of(b) * all->numbers();
    all->motion(b, 0, std::span(x).subspan(first, size),
                std::span(v).subspan(first, size));
    first += size;
  }
  const std::vector<int> points(strands, c.elements + 1);
  auto made = std::make_shared<StrandInteraction>(
      ContactLaw({.stiffness = 0.02, .viscosity = 1e-3, .inner = 0.02, .outer = 0.03},
                 "test"),
      points);
  made->update(x, v);
  return made;
}

constexpr std::size_t strands = 10;

/// The exact methods share what effects do to a step: each case has one of them, in turn,
/// of clothoids the one that takes the least time, and hair on a sphere has all. The rest
/// is `more`.
std::vector<Case> cases_of(const HairModel& model, bool more) {
  const Vec low{0.12, 0.08, 1.43};
  const auto one = [](const char* name, Effects effects) {
    return Case{.name = name, .effects = std::move(effects)};
  };
  std::vector<Case> all = {
      one("OnAPlane", {body(Plane{}, {0.1, 0, 1.5})}),
      one("OnASphere", {body(Sphere{0.1}, low)}),
      one("OnACapsule", {body(Capsule{0.06, 0.1}, low)}),
      one("OnAnEllipsoid", {body(Ellipsoid({0.08, 0.1, 0.12}), low)}),
      one("OnAGrid", {body(DistanceGrid(sphere_samples(0.1, 0.15, 31), "test"), low)}),
      one("OnTwoBodiesAndATether", {body(Sphere{0.1}, low), body(Plane{}, {0.1, 0, 1.47}),
                                    std::make_shared<Tether>(pulled())}),
      one("Pushed", {std::make_shared<ConstantForce>(Vec{1e-4, -2e-4, 0}, Vec{1, 2, 3}),
                     std::make_shared<ConstantForce>(Vec{}, Vec{1, 2, 3})}),
      one("Viscous", {std::make_shared<LinearDrag>(3e-5, 0.2)}),
  };
  for (const char* id : {"quadratic_drag", "wind"}) {
    const EffectEntry& entry = find_effect(id, "test");
    all.push_back(
        one(id, {entry.make(Parameters(entry.parameters, "test"), RootMotion{})}));
  }
  Case follows =
      one("OnAMovingHead", {body(Ellipsoid({0.08, 0.1, 0.12}), low, moving_head())});
  follows.moves = true;
  all.push_back(follows);
  Case bends = one("BendingOnly", {body(Sphere{0.1}, low)});
  bends.twist = false;
  all.push_back(bends);
  Case uneven = one("OnAnEllipsoidUneven", {body(Ellipsoid({0.08, 0.1, 0.12}), low)});
  uneven.points = 12;
  uneven.uneven = 5;
  all.push_back(uneven);
  Case interacts{.name = "Interacting"};
  interacts.own = [of = neighbours(strands, model)](std::size_t k) {
    // The effect refers to it.
    return Effects{std::shared_ptr<const Effect>(
        of->effect(k).release(), [of](const Effect* effect) { delete effect; })};
  };
  all.push_back(interacts);
  for (Case& c : all) c.model = &model;
  Case above = one("AboveAPlane", {body(Plane{}, {0.1, 0, 1.4})});
  above.model = &model;
  // Rigid links whirl: a relative change of 1e-15 grows to 0.1 m within 30 steps.
  above.steps = 20;
  std::vector<Case> exact_ones{above};
  for (const Case& c : all) {
    const bool bodies_alone =
        !c.own && std::ranges::all_of(c.effects, [](const auto& effect) {
          return effect->rigid_contact() != nullptr || effect->viscosity();
        });
    // What a plane cuts through is thrown out of it: such steps are shortened.
    if (bodies_alone && c.name != "OnAPlane") exact_ones.push_back(c);
  }
  if (more) all.clear();
  for (std::size_t i = 0; i < exact_ones.size(); ++i) {
    const Case& c = exact_ones[i];
    const HairMethod* own = &model == &clothoids ? &midpoint : exact_methods[i % 3];
    for (const HairMethod* method : exact_methods) {
      const bool first = method == own || c.name == "OnASphere";
      if (first != more) all.push_back(exact(c, *method));
    }
  }
  return all;
}

std::vector<Case> cases(bool more) {
  std::vector<Case> all;
  for (const HairModel* model : hair_models) {
    for (const Case& c : cases_of(*model, more)) all.push_back(c);
  }
  return all;
}

class HeadWithEffects : public testing::TestWithParam<Case> {};

// As in test_reduced_head.cpp: what a relative change of 1e-12 of the start makes, of
// chains one of 3e-11.
TEST_P(HeadWithEffects, StrandsMoveAsTheyDoAlone) {
  const Case& c = GetParam();
  const int steps = c.steps;
  const auto all = head(c, longest_doubles(), strands);
  advance(*all, steps, c.step);
  const std::size_t n = c.coordinates(), each = all->numbers();
  std::vector<double> q(n), v(n), x(strands * each), u(x.size());
  for (std::size_t b = 0, done = 0; b < all->blocks(); ++b) {
    const std::size_t size = all->strands_of(b) * each;
    all->motion(b, steps * c.step, std::span(x).subspan(done, size),
                std::span(u).subspan(done, size));
    done += size;
  }
  Case bare = c;
  bare.effects.clear();
  bare.own = {};
  std::size_t moved = 0;
  for (std::size_t k = 0; k < strands; ++k) {
    SCOPED_TRACE(k);
    EXPECT_FALSE(all->lost(k));
    all->state(k, q, v);
    const Alone want = alone(c, k, steps, 0),
                changed = alone(c, k, steps, change_of_start(c, steps));
    const double left = left_by_newton(c);
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + left * want.size);
    EXPECT_LE(apart(v, want.v), apart(changed.v, want.v) + left * want.rate);
    EXPECT_LE(apart(In(x).subspan(k * each, each), want.x),
              apart(changed.x, want.x) + left * 0.25);
    // A rate turns what follows, of length L at most, over L at most.
    EXPECT_LE(apart(In(u).subspan(k * each, each), want.u),
              apart(changed.u, want.u) +
                  0.25 * 0.25 * (apart(changed.v, want.v) + left * want.rate));
    if (moved < 2) moved += apart(want.x, alone(bare, k, steps, 0).x) > 1e-6 ? 1 : 0;
  }
  EXPECT_GE(moved, 2U);  // of whose points by more than a micrometre by the effects
}

TEST_P(HeadWithEffects, LanesGiveTheSameBits) {
  const Case& c = GetParam();
  constexpr int steps = 25;
  std::size_t want = 0;
  std::vector<double> points;  // as other strands see them
  for (const HeadPack& pack : packs_of_build(false)) {
    const auto all = head(c, pack, strands);
    advance(*all, steps, c.step);
    const std::size_t each = all->numbers();
    std::vector<double> x(2 * strands * each);
    for (std::size_t b = 0, first = 0; b < all->blocks(); ++b) {
      const std::size_t size = all->strands_of(b) * each;
      all->motion(b, steps * c.step, std::span(x).subspan(first, size),
                  std::span(x).subspan(strands * each + first, size));
      first += size;
    }
    if (points.empty()) {
      want = all->hash();
      points = x;
    }
    EXPECT_EQ(all->hash(), want) << pack.lanes;
    EXPECT_EQ(x, points) << pack.lanes;
  }
  if (packs_of(c).back().number == HeadNumber::float64) return;
  const auto f8 = head(c, {HeadNumber::float32, 8}, strands),
             f16 = head(c, longest_floats(), strands);
  advance(*f8, steps, c.step);
  advance(*f16, steps, c.step);
  EXPECT_EQ(f8->hash(), f16->hash());
}

std::string name_of(const testing::TestParamInfo<Case>& of) {
  return std::string(of.param.model->name) + of.param.name;
}
INSTANTIATE_TEST_SUITE_P(Cases, HeadWithEffects, testing::ValuesIn(cases(false)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(More, HeadWithEffects, testing::ValuesIn(cases(true)), name_of);

struct State {
  std::vector<double> q, v;
  bool operator==(const State&) const = default;
};
State state(const Head& of, std::size_t k) {
  const std::size_t n = of.kept_of_state() / 2;
  State s{std::vector<double>(n), std::vector<double>(n)};
  of.state(k, s.q, s.v);
  return s;
}

/// The tip of a strand at the start.
Vec tip(const Case& c, std::size_t k) {
  const Alone at = alone(c, k, 0, 0);
  return load3(&at.x[at.x.size() - 3]);
}

class HeadWithEffectsOnSome : public testing::TestWithParam<const HairModel*> {};

// A ball of 4 mm at one tip, and a tether on one strand: the strands beside them have the
// bits of a head without, whatever their neighbours in a block do.
TEST_P(HeadWithEffectsOnSome, OthersAreTheSameBits) {
  Case c{.name = "", .model = GetParam()};
  const Case bare = c;
  const Vec at = tip(c, 5) + Vec{2e-3, 0, 0};
  c.effects = {body(Sphere{4e-3}, at)};
  c.own = [](std::size_t k) {
    return k == 2 ? Effects{std::make_shared<Tether>(pulled())} : Effects{};
  };
  constexpr int steps = 20;
  for (const HeadPack& pack : packs_of_build()) {
    const auto some = head(c, pack, 11), none = head(bare, pack, 11);
    advance(*some, steps);
    advance(*none, steps);
    for (std::size_t k = 0; k < 11; ++k) {
      if (k != 2 && k != 5) {
        EXPECT_GT(norm(tip(bare, k) - at), 0.012) << k;  // or the sphere may touch it
      }
      EXPECT_EQ(state(*some, k) == state(*none, k), k != 2 && k != 5) << k;
    }
  }
}

// The load of the same ball is infinite.
TEST_P(HeadWithEffectsOnSome, AStrandThatABodyLosesLeavesOthersAlone) {
  Case c{.name = "", .model = GetParam()};
  const Case bare = c;
  BodyContact hard = soft;
  hard.stiffness = 1e308;
  c.effects = {std::make_shared<Body>(
      Sphere{4e-3}, StrandPlace{tip(c, 5) + Vec{2e-3, 0, 0}, {}}, hard)};
  for (const HeadPack& pack : packs_of_build()) {
    const auto some = head(c, pack, 11), none = head(bare, pack, 11);
    const State before = state(*none, 5);
    advance(*some, 20);
    advance(*none, 20);
    for (std::size_t k = 0; k < 11; ++k) {
      EXPECT_EQ(some->lost(k), k == 5) << k;
      if (k != 5) {
        EXPECT_EQ(state(*some, k), state(*none, k)) << k;
      }
    }
    EXPECT_EQ(state(*some, 5), before);
  }
}

TEST_P(HeadWithEffectsOnSome, ThatNeedMoreThanPointsAreRefused) {
  const ContactLaw law({.stiffness = 1, .viscosity = 0, .inner = 1e-3, .outer = 2e-3},
                       "test");
  const Effects refused[] = {
      {std::make_shared<SelfContact>(law, 0.02)},
      {std::make_shared<ExactBody>(Plane{}, StrandPlace{},
                                   ExactContact{soft.normal(), false, 0.3, 0})}};
  for (const Effects& effects : refused) {
    Case c{.name = "", .effects = effects, .model = GetParam()};
    EXPECT_THROW(c.model->head(options(c), {}), InputError);
    c.effects.clear();
    const auto all = c.model->head(options(c), {});
    EXPECT_THROW(all->add(strand(c, 0), effects), InputError);
    EXPECT_EQ(all->strands(), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, HeadWithEffectsOnSome, testing::ValuesIn(hair_models),
                         [](const auto& of) { return std::string(of.param->name); });

/// Random symmetric matrices: of any signs, of rank 1 and 2, with equal eigenvalues.
std::vector<std::array<double, 9>> matrices() {
  std::mt19937 random(1);
  std::normal_distribution<double> number;
  std::vector<std::array<double, 9>> all;
  for (int i = 0; i < 400; ++i) {
    Frame f = rotation((1 / 3.0) * Vec{1, 2, 2}, number(random));
    f = f * rotation({0, 0.6, 0.8}, number(random));
    double values[] = {number(random), number(random), number(random)};
    if (i % 5 == 1) values[1] = 0;
    if (i % 5 == 2) values[1] = values[0];
    if (i % 5 == 3) values[0] = values[1] = values[2];
    if (i % 5 == 4) values[0] = values[1] = 0;
    const double scale = std::pow(10.0, 3 * number(random));
    const Mat3 m = scale * turned(f, diagonal({values[0], values[1], values[2]}));
    all.push_back({m.r0.x, (m.r0.y + m.r1.x) / 2, (m.r0.z + m.r2.x) / 2,
                   (m.r0.y + m.r1.x) / 2, m.r1.y, (m.r1.z + m.r2.y) / 2,
                   (m.r0.z + m.r2.x) / 2, (m.r1.z + m.r2.y) / 2, m.r2.z});
  }
  return all;
}

// Both are exact but for rounding: some tens of eps of the matrix.
TEST(Semidefinite, IsTheProjectionByEigenvectors) {
  using T = PackOf<double, 4>;
  const auto all = matrices();
  std::size_t changed = 0;
  for (std::size_t i = 0; i + 4 <= all.size(); i += 4) {
    Symmetric3<T> b;
    for (int lane = 0; lane < 4; ++lane) {
      const auto& m = all[i + static_cast<std::size_t>(lane)];
      b.xx.set(lane, m[0]);
      b.yy.set(lane, m[4]);
      b.zz.set(lane, m[8]);
      b.xy.set(lane, m[1]);
      b.xz.set(lane, m[2]);
      b.yz.set(lane, m[5]);
    }
    const Symmetric3<T> found = semidefinite(b, T(1));
    for (int lane = 0; lane < 4; ++lane) {
      const auto& m = all[i + static_cast<std::size_t>(lane)];
      auto want = m;
      make_semidefinite(want);
      changed += want != m ? 1 : 0;
      const double got[] = {found.xx[lane], found.xy[lane], found.xz[lane],
                            found.xy[lane], found.yy[lane], found.yz[lane],
                            found.xz[lane], found.yz[lane], found.zz[lane]};
      EXPECT_LE(apart(got, want), 1e-14 * (std::abs(m[0]) + std::abs(m[4]) +
                                           std::abs(m[8]) + 3 * std::abs(m[1])))
          << i << ' ' << lane;
    }
  }
  EXPECT_GT(changed, 100U);
}

// Packs start from the surface, doubles from a bound: the same root, within the rounding
// of distances, some eps of the size; where a few steps do not find it, the same search.
TEST(BodyShapesInLanes, AnEllipsoidIsAsFarAsByOneSearchEach) {
  using T = PackOf<double, 4>;
  constexpr double eps = std::numeric_limits<double>::epsilon();
  std::mt19937 random(2);
  std::normal_distribution<double> number;
  for (const Vec& axes : {Vec{0.08, 0.1, 0.12}, Vec{1, 0.1, 0.01}, Vec{0.3, 0.3, 0.3}}) {
    const Ellipsoid shape(axes);
    for (int i = 0; i < 200; ++i) {
      Vec3<T> x;
      Vec of[4];
      for (int lane = 0; lane < 4; ++lane) {
        const Vec n{number(random), number(random), number(random)};
        const double scale = (i % 2 == 0 ? 1 + 1e-3 * number(random) : 3.0) / norm(n);
        of[lane] = scale * Vec{axes.x * n.x, axes.y * n.y, axes.z * n.z};
        set_lane(x, lane, of[lane]);
      }
      const NearestOf<T> found = shape.nearest(x);
      const Mat3Of<T> curvature = shape.curvature(x, found);
      for (int lane = 0; lane < 4; ++lane) {
        const Distance want = shape.distance(of[lane]);
        EXPECT_NEAR(found.to.value[lane], want.value, 100 * eps * norm(of[lane]));
        EXPECT_LE(norm(lane_of(found.to.gradient, lane) - want.gradient), 1e-12);
        const Mat3 k = shape.curvature(of[lane]);
        EXPECT_LE(norm(lane_of(curvature.r0, lane) - k.r0), 1e-10 * (1 + norm(k.r0)));
      }
    }
  }
}

}  // namespace tress::test_head_effects
