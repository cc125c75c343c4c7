#include <gtest/gtest.h>

#include <numeric>

#include "contract/input_error.h"
#include "tests/models/head/hairs.h"
#include "tests/support/apart.h"

namespace tress::test_helix_head {

using namespace models;
using testing_support::advance;
using testing_support::Alone;
using testing_support::alone;
using testing_support::Case;
using testing_support::head;
using testing_support::options;
using testing_support::packs;
using testing_support::strand;

constexpr double h = testing_support::hair_step;

class HelixHead : public testing::TestWithParam<Case> {};

// Both eliminate the same matrices in other orders of summation: some thousand roundings
// an element, of 1e-16 each, that add up as a random walk and are amplified alike. So
// they differ by no more than a relative change of the initial state by 1e-12 makes.
TEST_P(HelixHead, StrandsMoveAsTheyDoAlone) {
  const Case& c = GetParam();
  constexpr int steps = 100;
  constexpr std::size_t strands = 10;
  const auto all = head(c, {HeadNumber::float64, 8}, strands);
  advance(*all, steps);
  const auto n = static_cast<std::size_t>(3 * c.elements);
  std::vector<double> q(n), v(n), x(strands * (n + 3));
  std::size_t done = 0;
  for (std::size_t b = 0; b < all->blocks(); ++b) {
    const std::size_t size = all->strands_of(b) * (n + 3);
    all->positions(b, steps * h, std::span(x).subspan(done, size));
    done += size;
  }
  ASSERT_EQ(done, x.size());
  for (std::size_t k = 0; k < strands; ++k) {
    SCOPED_TRACE(k);
    EXPECT_FALSE(all->lost(k));
    all->state(k, q, v);
    const Alone want = alone(c, k, steps, 0);
    const Alone changed = alone(c, k, steps, 1e-12);
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q));
    EXPECT_LE(apart(v, want.v), apart(changed.v, want.v));
    const In points = std::span(x).subspan(k * (n + 3), n + 3);
    EXPECT_LE(apart(points, want.x), apart(changed.x, want.x));
    // It has moved, or all of this says nothing.
    EXPECT_GT(apart(want.x, alone(c, k, 0, 0).x), 1e-4);
  }
}

TEST_P(HelixHead, LanesAndInstructionsGiveTheSameBits) {
  std::size_t want[2] = {};
  for (const HeadPack& pack : packs) {
    for (const Instructions set : {Instructions::base, Instructions::avx512}) {
      if (!available(set)) continue;
      const auto all = head(GetParam(), {pack.number, pack.lanes, set}, 19);
      advance(*all, 50);
      std::size_t& one = want[pack.number == HeadNumber::float64 ? 0 : 1];
      if (one == 0) one = all->hash();
      EXPECT_EQ(all->hash(), one) << pack.lanes << ' ' << name(set);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, HelixHead,
    testing::Values(Case{"Curly"}, Case{.name = "Moved", .moves = true},
                    Case{.name = "BendingOnly", .twist = false, .moves = true},
                    Case{.name = "FourPoints", .points = 4},
                    Case{.name = "Straight", .curl = 0},
                    Case{.name = "OneElement", .elements = 1, .points = 12},
                    Case{.name = "Fine", .elements = 40, .points = 4, .moves = true},
                    // Elements wind by up to 3 and by up to 6 rad: other formulas.
                    Case{.name = "Tight", .points = 12, .curl = 5},
                    Case{.name = "Tightest", .points = 16, .curl = 11},
                    // Strands beside each other need different formulas.
                    Case{.name = "Uneven", .points = 12, .uneven = 5},
                    Case{.name = "VeryUneven", .points = 16, .uneven = 11},
                    Case{.name = "InVacuum", .drag = 0, .mass_damping = 0}),
    [](const auto& of) { return of.param.name; });

/// Energetics of the strand by itself, in the head's state.
Energy energy_alone(const Case& c, std::size_t k, double t, const Head& all,
                    const Effects& effects) {
  const auto system = super_helix(
      strand(c, k),
      {.dofs = c.twist ? 3 : 2, .tangent = ReducedTangent::stiff, .quadrature = c.points},
      effects);
  const auto n = static_cast<std::size_t>(3 * c.elements);
  std::vector<double> q(n), v(n);
  all.state(k, q, v);
  if (!c.twist) {
    for (auto* x : {&q, &v}) {
      std::vector<double> bent;
      for (std::size_t i = 0; i < n; ++i) {
        if (i % 3 != 0) bent.push_back((*x)[i]);
      }
      *x = bent;
    }
  }
  return system->energetics()->energy(t, q, v);
}

// The same sums in another order, over some 3 (elements points) products that do not
// cancel but for the places of points: 1e-12 of the largest terms.
TEST_P(HelixHead, EnergiesAreThoseOfTheStrandsAlone) {
  const Case& c = GetParam();
  constexpr int steps = 50;
  for (const int lanes : {1, 8}) {
    const auto all = head(c, {HeadNumber::float64, lanes}, 10);
    advance(*all, steps);
    const double t = steps * h;
    std::vector<HeadEnergy> each(10);
    std::size_t done = 0;
    for (std::size_t b = 0; b < all->blocks(); ++b) {
      all->energies(b, t, std::span(each).subspan(done));
      done += all->strands_of(b);
    }
    for (std::size_t k = 0; k < 10; ++k) {
      SCOPED_TRACE(k);
      const Energy bare = energy_alone(c, k, t, *all, {});
      const Energy heavy =
          energy_alone(c, k, t, *all, {std::make_shared<Gravity>(options(c).gravity)});
      const double weight = strand(c, k).mass() * 9.9 * 2;  // of some 2 m of height
      EXPECT_GT(bare.kinetic, 0);
      EXPECT_NEAR(each[k].kinetic, bare.kinetic, 1e-12 * bare.kinetic);
      EXPECT_NEAR(each[k].elastic, bare.potential, 1e-12 * bare.potential);
      EXPECT_NEAR(each[k].gravity, heavy.potential - bare.potential,
                  1e-12 * (weight + bare.potential));
      EXPECT_GT(each[k].fastest, 0);
      std::vector<double> x(all->strands_of(0) * all->numbers());
      if (lanes != 1 || k != 0) continue;
      all->positions(0, t, x);
      EXPECT_LE(norm(each[0].tip - load3(&x[x.size() - 3])), 1e-15);
    }
  }
}

TEST(HelixHeadKept, GoesOnWithTheSameBitsInAHeadOfOtherLanes) {
  const Case c{.name = "", .points = 4, .moves = true};
  for (const HeadPack& pack : packs) {
    const auto first = head(c, pack, 11);
    for (int s = 0; s < 20; ++s) {
      const auto scratch = first->scratch();
      for (std::size_t b = 0; b < first->blocks(); ++b)
        first->step(b, s * h, h, *scratch);
    }
    std::vector<double> kept(11 * first->kept());
    std::size_t done = 0;
    for (std::size_t b = 0; b < first->blocks(); ++b) {
      first->keep(b, std::span(kept).subspan(done));
      done += first->kept() * first->strands_of(b);
    }
    ASSERT_EQ(done, kept.size());
    const HeadPack other{pack.number, pack.lanes == 8 ? 16 : 8};
    const auto second = head(
        c, pack.number == HeadNumber::float64 ? HeadPack{pack.number, 4} : other, 11);
    EXPECT_NE(second->hash(), first->hash());
    done = 0;
    for (std::size_t b = 0; b < second->blocks(); ++b) {
      second->recall(b, std::span(kept).subspan(done));
      done += second->kept() * second->strands_of(b);
    }
    EXPECT_EQ(second->hash(), first->hash());
    for (Head* all : {first.get(), second.get()}) {
      const auto scratch = all->scratch();
      for (int s = 20; s < 40; ++s) {
        for (std::size_t b = 0; b < all->blocks(); ++b) all->step(b, s * h, h, *scratch);
      }
    }
    EXPECT_EQ(second->hash(), first->hash());
  }
}

// In units of length, gravity and mass; hairs let go by a head at rest.
TEST(HelixHeadOf32Bits, DiffersByAHundredThousandthOfALengthAfterASecond) {
  for (const int elements : {5, 20}) {
    const Case c{.name = "", .elements = elements, .points = 4, .sprung = false};
    const auto wide = head(c, {HeadNumber::float64, 8}, 16),
               narrow = head(c, {HeadNumber::float32, 16}, 16);
    advance(*wide, 500, 2e-3);
    advance(*narrow, 500, 2e-3);
    const auto n = 3 * static_cast<std::size_t>(elements + 1);
    std::vector<double> x(16 * n), y(16 * n);
    wide->positions(0, 1, std::span(x).first(8 * n));
    wide->positions(1, 1, std::span(x).last(8 * n));
    narrow->positions(0, 1, y);
    EXPECT_LE(apart(x, y), 1e-5 * 0.25) << elements;
    EXPECT_GT(apart(x, y), 0) << elements;
  }
}

// 11 of 64 strands cannot be computed: the others move as they do without them.
TEST(HelixHeadWithLosses, OtherStrandsGoOn) {
  const Case c{"", 10, 4};
  const auto fails = [](std::size_t k) { return k % 6 == 1; };
  for (const HeadPack& pack : packs) {
    const auto sound = head(c, pack, 64), hurt = helix_head(options(c), pack);
    std::size_t failing = 0;
    for (std::size_t k = 0; k < 64; ++k) {
      Strand one = strand(c, k);
      if (fails(k)) {
        ++failing;
        for (Segment& s : one.segments) s.initial = {1e200, -1e200, 1e200};
      }
      hurt->add(one);
    }
    ASSERT_EQ(failing, 11u);
    advance(*sound, 30);
    advance(*hurt, 30);
    std::vector<double> q(30), v(30), want_q(30), want_v(30);
    for (std::size_t k = 0; k < 64; ++k) {
      EXPECT_EQ(hurt->lost(k), fails(k)) << k;
      EXPECT_FALSE(sound->lost(k));
      hurt->state(k, q, v);
      sound->state(k, want_q, want_v);
      if (fails(k)) {
        EXPECT_EQ(v, std::vector<double>(30)) << k;
      } else {
        EXPECT_EQ(q, want_q) << k;
        EXPECT_EQ(v, want_v) << k;
      }
    }
  }
}

// Even where its next step would be finite.
TEST(HelixHeadWithLosses, WhatIsLostStaysWhereItIs) {
  const Case c{"", 10, 4};
  for (const HeadPack& pack : packs) {
    const auto sound = head(c, pack, 20), hurt = head(c, pack, 20);
    for (Head* all : {sound.get(), hurt.get()}) advance(*all, 10);
    hurt->lose(3);
    std::vector<double> q(30), v(30), want_q(30), want_v(30), held(30);
    hurt->state(3, held, v);
    for (Head* all : {sound.get(), hurt.get()}) advance(*all, 10);
    for (std::size_t k = 0; k < 20; ++k) {
      hurt->state(k, q, v);
      sound->state(k, want_q, want_v);
      EXPECT_EQ(hurt->lost(k), k == 3);
      EXPECT_EQ(q, k == 3 ? held : want_q) << k;
      EXPECT_EQ(v, k == 3 ? std::vector<double>(30) : want_v) << k;
    }
  }
}

TEST(HelixHeadMemory, IsTheStateAndTwentyNumbers) {
  const Case c{"", 10, 4};
  const auto all = head(c, {HeadNumber::float64, 8}, 16);
  EXPECT_EQ(all->blocks(), 2u);
  EXPECT_LE(all->bytes(), 16u * (10 * 9 + 21) * sizeof(double));
}

TEST(HelixHeadInput, IsRefusedWithTheReason) {
  const Case c{"", 10, 4};
  const auto all = helix_head(options(c), {});
  EXPECT_THROW(all->add(strand({"", 9, 4}, 0)), InputError);
  Strand graded = strand(c, 0);
  graded.segments[3].length *= 1.5;
  EXPECT_THROW(all->add(graded), InputError);
  Strand thinner = strand(c, 0);
  thinner.segments[3].section.a1 *= 0.5;
  EXPECT_THROW(all->add(thinner), InputError);
  Strand loose = strand(c, 0);
  loose.free_root = FreeRoot{};
  EXPECT_THROW(all->add(loose), InputError);
  Strand tree = strand(c, 0);
  tree.segments[3].parent = 0;
  EXPECT_THROW(all->add(tree), InputError);
  EXPECT_EQ(all->strands(), 0u);
  EXPECT_EQ(all->blocks(), 0u);
  EXPECT_THROW(helix_head(options(c), {HeadNumber::float64, 16}), InputError);
  EXPECT_THROW(helix_head(options({"", 0}), {}), InputError);
  EXPECT_THROW(helix_head(options({"", 5, 40}), {}), InputError);
}

}  // namespace tress::test_helix_head
