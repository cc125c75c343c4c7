#include <gtest/gtest.h>

#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "tests/models/head/arrangements.h"
#include "tests/models/head/der_strands.h"
#include "tests/models/head/exact_methods.h"
#include "tests/models/head/mixed_hairs.h"
#include "tests/support/apart.h"

namespace tress::test_der_head {

using namespace simulation;
using namespace testing_support;
using integrators::make_integrator;

using Method = HairMethod;
constexpr Method methods[] = {one_solve, newton, midpoint, tr_bdf2};

/// Single corrections need shorter steps, in the head or alone: a tenth of `h`.
double step_of(const Method& method, double h) {
  return method.method == HeadMethod::linearly_implicit_midpoint ? h / 10 : h;
}

/// Numbers that its head can have: single corrections have 64 bits.
std::vector<HeadPack> packs_of(const Method& method) {
  return packs_of_build(method.method != HeadMethod::linearly_implicit_midpoint);
}

std::unique_ptr<Head> head(const RodCase& c, const Method& method, HeadPack pack,
                           std::size_t strands) {
  HeadOptions options = rod_options(c);
  options.method = method.method;
  auto all = der_head(options, pack);
  for (std::size_t k = 0; k < strands; ++k) all->add(rod(c, k));
  return all;
}

void advance(Head& all, int steps, double h, std::size_t together = 100) {
  const auto scratch = all.scratch();
  for (int s = 0; s < steps; ++s) {
    for (std::size_t b = 0; b < all.blocks(); b += together) {
      all.step(b, std::min(all.blocks(), b + together), s * h, h, *scratch);
    }
  }
}

/// A strand by itself after the same steps: points, coordinates in the head's order.
struct Alone {
  std::vector<double> q, v, x;
};
Alone alone(const RodCase& c, const Method& method, std::size_t k, int steps, double h,
            double change) {
  const auto system = rod_alone(c, k, method.left > 0 ? "exact" : "elastic");
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n);
  system->initial_state(q, v);
  const Vec root = rod(c, k).root.at(0).x;
  for (std::size_t i = 0; i < n; ++i) {
    const double from = i < n / 4 * 3 ? (&root.x)[i % 3] : 0;
    q[i] += (i % 2 == 0 ? change : -change) * (q[i] - from);
  }
  Options options;
  options.step = h;
  const auto method_of = make_integrator(method.id, *system, options);
  EXPECT_EQ(method_of->start(0, q, v), Status::ok);
  EXPECT_EQ(method_of->advance(steps * h), Status::ok) << method_of->failure();
  Alone end;
  end.x.resize(3 * static_cast<std::size_t>(c.elements + 1));
  system->material_points()->positions(steps * h, method_of->q(), end.x);
  end.q = as_edges(method_of->q(), load3(end.x.data()));
  end.v = as_edges(method_of->v(), {});
  return end;
}

class DerHead : public testing::TestWithParam<RodCase> {};

// Both eliminate the same matrices in other orders. An edge rounded by 1e-16 of itself is
// to the springs what a change of the state by as much is: a hundred steps of forty edges
// add up some thousand of them, amplified alike. So strands differ by no more than a
// relative change of the initial state by 1e-11 makes, and by roundings of what they are.
// The head renews references a step later: an angle that has just become 0 is left out.
// By tr_bdf2 steps of these strands without friction have no solution after some 20 ms,
// in the head or alone. By linearly_implicit_midpoint they are the ones that are
// compared: the head's Jacobian lacks slopes of friction, which show where one correction
// is a step; with friction test_head_methods.cpp has the order of the errors.
TEST_P(DerHead, StrandsMoveAsTheyDoAlone) {
  const RodCase& c = GetParam();
  constexpr int steps = 100;
  constexpr std::size_t strands = 10;
  for (const Method& method : methods) {
    if (method.method == HeadMethod::tr_bdf2 && c.friction == 0) continue;
    const double h = step_of(method, 1e-3);
    if (h < 1e-3 && c.friction > 0) continue;
    SCOPED_TRACE(method.id);
    const auto all = head(c, method, longest_doubles(), strands);
    advance(*all, steps, h);
    const auto n = static_cast<std::size_t>(c.elements);
    std::vector<double> q(4 * n), v(4 * n), x(strands * 3 * (n + 1));
    std::size_t done = 0;
    for (std::size_t b = 0; b < all->blocks(); ++b) {
      const std::size_t size = all->strands_of(b) * 3 * (n + 1);
      all->positions(b, steps * h, std::span(x).subspan(done, size));
      done += size;
    }
    ASSERT_EQ(done, x.size());
    for (std::size_t k = 0; k < strands; ++k) {
      SCOPED_TRACE(k);
      EXPECT_FALSE(all->lost(k));
      all->state(k, q, v);
      const Alone want = alone(c, method, k, steps, h, 0);
      const Alone changed = alone(c, method, k, steps, h, 1e-11);
      for (std::size_t i = 3; i < q.size(); i += 4) {
        if (want.q[i] != 0) continue;
        q[i] = 0;
        v[i] = want.v[i];
      }
      // Newton's tolerance, over a step, as a change of the state.
      const double solved = 1e-13 + method.left_after(steps);
      const double length = 0.25, rate = 60;
      EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + solved);
      EXPECT_LE(apart(v, want.v), apart(changed.v, want.v) + solved * rate);
      const In points = std::span(x).subspan(k * 3 * (n + 1), 3 * (n + 1));
      EXPECT_LE(apart(points, want.x), apart(changed.x, want.x) + solved * length);
      // It has moved, or all of this says nothing.
      EXPECT_GT(apart(want.x, alone(c, method, k, 0, h, 0).x), 1e-4);
    }
  }
}

// States agree to some 1e-11 of a strand, stretches of 1e-5 of an edge then to 1e-6: so
// does their energy, which is a part of the elastic one.
TEST_P(DerHead, EnergiesAndVelocitiesAreThoseOfTheStrandsAlone) {
  const RodCase& c = GetParam();
  constexpr int steps = 20;
  constexpr double h = 1e-3, t = steps * h;
  const Method& method = one_solve;
  const auto n = static_cast<std::size_t>(c.elements);
  const auto all = head(c, method, longest_doubles(), 8);
  advance(*all, steps, h);
  std::vector<HeadEnergy> each(8);
  std::vector<double> x(8 * all->numbers()), v(8 * all->numbers());
  for (std::size_t b = 0, k = 0; b < all->blocks(); k += all->strands_of(b++)) {
    const std::size_t from = k * all->numbers(),
                      size = all->strands_of(b) * all->numbers();
    all->energies(b, t, std::span(each).subspan(k, all->strands_of(b)));
    all->motion(b, t, std::span(x).subspan(from, size), std::span(v).subspan(from, size));
  }
  for (std::size_t k = 0; k < 8; ++k) {
    SCOPED_TRACE(k);
    const auto system = rod_alone(c, k, "elastic");
    Options options;
    options.step = h;
    std::vector<double> q0(4 * n), v0(4 * n), u(3 * (n + 1));
    system->initial_state(q0, v0);
    const auto one = make_integrator("linearly_implicit_euler", *system, options);
    ASSERT_EQ(one->start(0, q0, v0), Status::ok);
    ASSERT_EQ(one->advance(t), Status::ok);
    const Energy want = system->energetics()->energy(t, one->q(), one->v());
    EXPECT_GT(want.kinetic, 0);
    EXPECT_NEAR(each[k].kinetic, want.kinetic, 1e-6 * want.kinetic);
    const double weight = rod(c, k).mass() * 9.9 * 2;  // of some 2 m of height
    EXPECT_NEAR(each[k].elastic + each[k].gravity, want.potential,
                1e-12 * weight + 1e-6 * each[k].elastic);
    EXPECT_GT(each[k].elastic, 0);
    system->material_points()->velocities(t, one->q(), one->v(), u);
    const In got = In(v).subspan(k * all->numbers(), all->numbers());
    EXPECT_LE(apart(got, u), 1e-8 * each[k].fastest);
    double fastest = 0;
    for (std::size_t i = 0; i <= n; ++i) {
      fastest = std::max(fastest, norm(load3(&got[3 * i])));
    }
    EXPECT_NEAR(each[k].fastest, fastest, 1e-12 * fastest);
    EXPECT_LE(norm(each[k].tip - load3(&x[(k + 1) * all->numbers() - 3])), 1e-14);
  }
}

TEST(DerHeadKept, GoesOnWithTheSameBitsInAHeadOfOtherLanes) {
  const RodCase c{.name = "", .moves = true, .speed = 3};  // with new references
  for (const Method& method : methods) {
    const double h = step_of(method, 1e-3);
    const auto first = head(c, method, {HeadNumber::float64, 4}, 11),
               second = head(c, method, {HeadNumber::float64, 1}, 11);
    advance(*first, 20, h);
    EXPECT_NE(second->hash(), first->hash());
    recall(*second, kept_of(*first));
    EXPECT_EQ(second->hash(), first->hash());
    for (Head* of : {first.get(), second.get()}) {
      const auto scratch = of->scratch();
      for (int s = 20; s < 60; ++s) of->step(0, of->blocks(), s * h, h, *scratch);
    }
    EXPECT_EQ(second->hash(), first->hash());
  }
}

TEST_P(DerHead, LanesRefillsAndInstructionsGiveTheSameBits) {
  const RodCase& c = GetParam();
  for (const Method& method : methods) {
    SCOPED_TRACE(method.id);
    const double h = method.left > 0 ? step_of(method, 1.0 / 120) : 1e-3;
    std::size_t want = 0;
    for (const auto& [pack, together] : arrangements()) {
      const auto all = head(c, method, pack, 27);
      advance(*all, 10, h, together);
      if (want == 0) want = all->hash();
      EXPECT_EQ(all->hash(), want) << pack.lanes << " " << together;
    }
    if (packs_of(method).back().number == HeadNumber::float64) continue;
    const auto f8 = head(c, method, {HeadNumber::float32, 8}, 19),
               f16 = head(c, method, longest_floats(), 19);
    advance(*f8, 10, h);
    advance(*f16, 10, h);
    EXPECT_EQ(f8->hash(), f16->hash());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, DerHead,
    testing::Values(RodCase{"Curly"}, RodCase{.name = "Moved", .moves = true},
                    RodCase{.name = "Straight", .curl = 0},
                    RodCase{.name = "OneEdge", .elements = 1, .curl = 0.3},
                    // Joints are twisted by more than half a turn.
                    RodCase{.name = "Wound", .elements = 5, .twist = 80},
                    RodCase{.name = "Fine", .elements = 40, .moves = true},
                    RodCase{.name = "Tight", .curl = 4},
                    RodCase{.name = "InVacuum", .drag = 0, .mass_damping = 0},
                    RodCase{.name = "WithoutFriction", .friction = 0},
                    // Edges turn by more than 60 degrees: new references.
                    RodCase{.name = "Whipped", .moves = true, .speed = 3},
                    RodCase{.name = "Soft", .youngs_modulus = 1e8}),
    [](const auto& of) { return of.param.name; });

// In units of length, gravity and mass; hairs let go by a head at rest. What a step
// leaves is rounding here, and enters as what Newton's tolerance leaves does.
TEST(DerHeadOf32Bits, DiffersByAHundredThousandthOfALengthAfterASecond) {
  for (const Method& method : methods) {
    if (packs_of(method).back().number == HeadNumber::float64) continue;
    SCOPED_TRACE(method.id);
    for (const int elements : {5, 20}) {
      const RodCase c{.name = "", .elements = elements, .sprung = false};
      const auto wide = head(c, method, longest_doubles(), 16),
                 narrow = head(c, method, longest_floats(), 16);
      advance(*wide, 500, 2e-3);
      advance(*narrow, 500, 2e-3);
      const std::vector<double> x = points(*wide, 1), y = points(*narrow, 1);
      EXPECT_LE(apart(x, y), std::max(1.0, method.left) * 1e-5 * 0.25) << elements;
      EXPECT_GT(apart(x, y), 0) << elements;
    }
  }
}

// 11 of 64 strands cannot be computed: the others move as they do without them.
TEST(DerHeadWithLosses, OtherStrandsGoOn) {
  const RodCase c{""};
  const auto fails = [](std::size_t k) { return k % 6 == 1; };
  for (const Method& method : methods) {
    SCOPED_TRACE(method.id);
    for (const HeadPack& pack : packs_of(method)) {
      const auto sound = head(c, method, pack, 64);
      HeadOptions options = rod_options(c);
      options.method = method.method;
      const auto hurt = der_head(options, pack);
      std::size_t failing = 0;
      for (std::size_t k = 0; k < 64; ++k) {
        Strand one = rod(c, k);
        if (fails(k)) {
          ++failing;
          for (Segment& s : one.segments) s.natural = {1e200, -1e200, 1e200};
        }
        hurt->add(one);
      }
      ASSERT_EQ(failing, 11u);
      advance(*sound, 10, step_of(method, 2e-3));
      advance(*hurt, 10, step_of(method, 2e-3));
      std::vector<double> q(40), v(40), want_q(40), want_v(40);
      for (std::size_t k = 0; k < 64; ++k) {
        EXPECT_EQ(hurt->lost(k), fails(k)) << k;
        EXPECT_FALSE(sound->lost(k));
        hurt->state(k, q, v);
        sound->state(k, want_q, want_v);
        if (fails(k)) {
          EXPECT_EQ(v, std::vector<double>(40)) << k;
        } else {
          EXPECT_EQ(q, want_q) << k;
          EXPECT_EQ(v, want_v) << k;
        }
      }
      const std::vector<HeadLoss> losses = hurt->losses();
      ASSERT_EQ(losses.size(), 11u);
      EXPECT_EQ(losses[1].strand, 7u);
      EXPECT_EQ(losses[1].step, 1);
      EXPECT_EQ(losses[1].time, 0);
      EXPECT_NE(losses[1].reason, "");
    }
  }
}

TEST(DerHeadMemory, IsTheState) {
  // q, v, a, rest strain, reference axes and twist of each edge; root and material. With
  // two accelerations, when they were.
  EXPECT_LE(head({""}, newton, longest_doubles(), 16)->bytes(),
            16U * (10 * (3 * 4 + 10) + 25) * sizeof(double));
  EXPECT_LE(head({""}, tr_bdf2, longest_doubles(), 16)->bytes(),
            16U * (10 * (4 * 4 + 10) + 27) * sizeof(double));
}

TEST(DerHeadInput, IsRefusedWithTheReason) {
  const RodCase c{""};
  HeadOptions options = rod_options(c);
  options.twist = false;
  EXPECT_THROW(der_head(options, {}), InputError);
  options.twist = true;
  options.newton_iterations = 0;
  EXPECT_THROW(der_head(options, {}), InputError);
  HeadOptions weightless = rod_options(c);
  weightless.rotary_inertia = false;
  EXPECT_NO_THROW(der_head(weightless, {}));
  weightless.method = HeadMethod::tr_bdf2;
  EXPECT_THROW(der_head(weightless, {}), InputError);
  EXPECT_THROW(der_head(rod_options(c), {HeadNumber::float64, 16}), InputError);
}

}  // namespace tress::test_der_head
