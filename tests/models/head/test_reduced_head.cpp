#include <gtest/gtest.h>

#include <algorithm>

#include "contract/forms/energetics.h"
#include "contract/input_error.h"
#include "tests/models/head/hairs.h"
#include "tests/support/apart.h"

namespace tress::test_reduced_head {

using namespace simulation;
using testing_support::advance;
using testing_support::Alone;
using testing_support::alone;
using testing_support::Case;
using testing_support::chains;
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
using testing_support::one_solve;
using testing_support::options;
using testing_support::packs_of;
using testing_support::packs_of_build;
using testing_support::points;
using testing_support::strand;

class ReducedHead : public testing::TestWithParam<Case> {};

// Both eliminate the same matrices in other orders of summation: some thousand roundings
// an element, of 1e-16 each, that add up as a random walk and are amplified alike. So
// they differ by no more than a relative change of the initial state by 1e-12 makes. Of
// chains by 3e-11: what hangs on a joint is as good as free to turn about it in a short
// step, so of its inertia about the joint, some elements^3 times that of a link, nothing
// but the joint's stiffness is left, and three digits cancel where bending of an element
// leaves some of it. Of clothoids by 4e-12: an element eliminates twice the unknowns,
// with four times the products. Where steps are iterated, a step leaves Newton's
// tolerance, which is a change of the state by as much.
TEST_P(ReducedHead, StrandsMoveAsTheyDoAlone) {
  const Case& c = GetParam();
  const int steps = c.method == &one_solve ? 100 : 50;
  constexpr std::size_t strands = 10;
  const auto all = head(c, longest_doubles(), strands);
  advance(*all, steps, c.step);
  const std::size_t n = c.coordinates(), each = all->numbers();
  std::vector<double> q(n), v(n), x(strands * each);
  std::size_t done = 0;
  for (std::size_t b = 0; b < all->blocks(); ++b) {
    const std::size_t size = all->strands_of(b) * each;
    all->positions(b, steps * c.step, std::span(x).subspan(done, size));
    done += size;
  }
  ASSERT_EQ(done, x.size());
  for (std::size_t k = 0; k < strands; ++k) EXPECT_FALSE(all->lost(k)) << k;
  // In both blocks, and of each kind that strands beside each other are.
  for (const std::size_t k : {0, 1, 5, 7, 9}) {
    SCOPED_TRACE(k);
    all->state(k, q, v);
    const Alone want = alone(c, k, steps, 0);
    const Alone changed = alone(c, k, steps, change_of_start(c, steps));
    const double left = left_by_newton(c);
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + left * want.size);
    EXPECT_LE(apart(v, want.v), apart(changed.v, want.v) + left * want.rate);
    const In points = std::span(x).subspan(k * each, each);
    EXPECT_LE(apart(points, want.x), apart(changed.x, want.x) + left * 0.25);
    // It has moved, or all of this says nothing.
    EXPECT_GT(apart(want.x, alone(c, k, 0, 0).x), 1e-4);
  }
}

TEST_P(ReducedHead, LanesAndInstructionsGiveTheSameBits) {
  std::size_t want[2] = {};
  for (const HeadPack& pack : packs_of(GetParam())) {
    const auto all = head(GetParam(), pack, 19);
    advance(*all, 20, GetParam().step);
    std::size_t& one = want[pack.number == HeadNumber::float64 ? 0 : 1];
    if (one == 0) one = all->hash();
    EXPECT_EQ(all->hash(), one) << pack.lanes;
  }
}

/// One solve in every case. The exact methods share what cases differ in: each case has
/// one of them, in turn, of clothoids the one that takes the least time, and curly hair
/// has all. The rest is `more`.
std::vector<Case> cases(bool more) {
  std::vector<Case> all = {{"Curly"},
                           {.name = "Moved", .moves = true},
                           {.name = "BendingOnly", .twist = false, .moves = true},
                           {.name = "FourPoints", .points = 4},
                           {.name = "Straight", .curl = 0},
                           {.name = "OneElement", .elements = 1, .points = 12},
                           {.name = "Fine", .elements = 40, .points = 4, .moves = true},
                           // Elements wind by up to 3 rad: other formulas.
                           {.name = "Tight", .points = 12, .curl = 5},
                           // Strands beside each other need different formulas.
                           {.name = "Uneven", .points = 12, .uneven = 5},
                           {.name = "InVacuum", .drag = 0, .mass_damping = 0}};
  const std::size_t both = all.size();
  for (std::size_t i = 0; i < both; ++i) {
    Case of_chains = all[i];
    of_chains.model = &chains;
    all.push_back(of_chains);
  }
  for (std::size_t i = 0; i < both; ++i) {
    Case of_clothoids = all[i];
    of_clothoids.model = &clothoids;
    all.push_back(of_clothoids);
  }
  // By up to 6 rad: in parts, lane by lane.
  all.push_back({.name = "Tightest", .points = 16, .curl = 11, .model = &clothoids});
  all.push_back({.name = "VeryUneven", .points = 16, .uneven = 11, .model = &clothoids});
  // By up to 6 rad; joints, whose unknowns are singular at 2 pi, by up to 5.
  all.push_back({.name = "Tightest", .points = 16, .curl = 11});
  all.push_back({.name = "VeryUneven", .points = 16, .uneven = 11});
  all.push_back({.name = "Tightest", .curl = 8, .model = &chains});
  all.push_back({.name = "VeryUneven", .uneven = 8, .model = &chains});
  const std::size_t once = all.size();
  for (std::size_t i = 0; i < once; ++i) {
    const Case c = all[i];
    const HairMethod* own = c.model == &clothoids ? &midpoint : exact_methods[i % 3];
    for (const HairMethod* method : exact_methods) {
      const bool first = method == own || c.name == "Curly";
      if (first != more) all.push_back(exact(c, *method));
    }
  }
  if (more) all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(once));
  return all;
}
std::string name_of(const testing::TestParamInfo<Case>& of) {
  return std::string(of.param.model->name) + of.param.name;
}
INSTANTIATE_TEST_SUITE_P(Cases, ReducedHead, testing::ValuesIn(cases(false)), name_of);
INSTANTIATE_TEST_SUITE_P(More, ReducedHead, testing::ValuesIn(cases(true)), name_of);

/// Energetics of the strand by itself, in the head's state.
Energy energy_alone(const Case& c, std::size_t k, double t, const Head& all,
                    const Effects& effects) {
  const auto system = c.model->alone(strand(c, k),
                                     {.dofs = c.twist ? 3 : 2,
                                      .jacobian = ReducedJacobian::elastic,
                                      .quadrature = c.points},
                                     effects);
  const std::size_t n = c.coordinates();
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
TEST_P(ReducedHead, EnergiesAreThoseOfTheStrandsAlone) {
  const Case& c = GetParam();
  constexpr int steps = 10;
  for (const int lanes : {1, longest_doubles().lanes}) {
    const auto all = head(c, {HeadNumber::float64, lanes}, 10);
    advance(*all, steps, c.step);
    const double t = steps * c.step;
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

/// The next pack of the same numbers, or the first, or the same if there is one alone.
HeadPack other_than(const HeadPack& pack) {
  std::vector<HeadPack> all = packs_of_build();
  std::erase_if(all, [&](const HeadPack& one) { return one.number != pack.number; });
  const auto at = std::ranges::find(all, pack.lanes, &HeadPack::lanes);
  return at + 1 == all.end() ? all.front() : *(at + 1);
}

class HeadOfModel : public testing::TestWithParam<Case> {};

TEST_P(HeadOfModel, GoesOnWithTheSameBitsInAHeadOfOtherLanes) {
  Case c = GetParam();
  c.moves = true;
  for (const HeadPack& pack : packs_of(c)) {
    const auto first = head(c, pack, 11);
    for (int s = 0; s < 20; ++s) {
      const auto scratch = first->scratch();
      for (std::size_t b = 0; b < first->blocks(); ++b)
        first->step(b, s * c.step, c.step, *scratch);
    }
    std::vector<double> kept(11 * first->kept());
    std::size_t done = 0;
    for (std::size_t b = 0; b < first->blocks(); ++b) {
      first->keep(b, std::span(kept).subspan(done));
      done += first->kept() * first->strands_of(b);
    }
    ASSERT_EQ(done, kept.size());
    const auto second = head(c, other_than(pack), 11);
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
        for (std::size_t b = 0; b < all->blocks(); ++b) {
          all->step(b, s * c.step, c.step, *scratch);
        }
      }
    }
    EXPECT_EQ(second->hash(), first->hash());
  }
}

// In units of length, gravity and mass; hairs let go by a head at rest. What a step
// leaves is rounding here, and enters as what Newton's tolerance leaves does. By longer
// steps single corrections end in hairs without a solution, of any numbers.
TEST_P(HeadOfModel, In32BitsDiffersByAHundredThousandthOfALengthAfterASecond) {
  if (packs_of(GetParam()).back().number == HeadNumber::float64) GTEST_SKIP();
  const bool single = GetParam().method == &midpoint;
  const int steps = single ? 1000 : 500;
  for (const int elements : {5, 20}) {
    Case c = GetParam();
    c.elements = elements;
    c.sprung = false;
    const auto wide = head(c, longest_doubles(), 16),
               narrow = head(c, longest_floats(), 16);
    advance(*wide, steps, 1.0 / steps);
    advance(*narrow, steps, 1.0 / steps);
    const std::vector<double> x = points(*wide, 1), y = points(*narrow, 1);
    EXPECT_LE(apart(x, y), std::max(1.0, c.method->left) * 1e-5 * 0.25) << elements;
    EXPECT_GT(apart(x, y), 0) << elements;
  }
}

// 7 of 40 strands cannot be computed: the others move as they do without them.
TEST_P(HeadOfModel, GoesOnWithoutStrandsThatAreLost) {
  const Case& c = GetParam();
  const auto fails = [](std::size_t k) { return k % 6 == 1; };
  for (const HeadPack& pack : packs_of(c)) {
    const auto sound = head(c, pack, 40), hurt = c.model->head(options(c), pack);
    std::size_t failing = 0;
    for (std::size_t k = 0; k < 40; ++k) {
      Strand one = strand(c, k);
      if (fails(k)) {
        ++failing;
        for (Segment& s : one.segments) s.initial = {1e200, -1e200, 1e200};
      }
      hurt->add(one);
    }
    ASSERT_EQ(failing, 7u);
    advance(*sound, 12, c.step);
    advance(*hurt, 12, c.step);
    const std::size_t n = c.coordinates();
    std::vector<double> q(n), v(n), want_q(n), want_v(n);
    for (std::size_t k = 0; k < 40; ++k) {
      EXPECT_EQ(hurt->lost(k), fails(k)) << k;
      EXPECT_FALSE(sound->lost(k));
      hurt->state(k, q, v);
      sound->state(k, want_q, want_v);
      if (fails(k)) {
        EXPECT_EQ(v, std::vector<double>(n)) << k;
      } else {
        EXPECT_EQ(q, want_q) << k;
        EXPECT_EQ(v, want_v) << k;
      }
    }
  }
}

// Even where its next step would be finite.
TEST_P(HeadOfModel, WhatIsLostStaysWhereItIs) {
  const Case& c = GetParam();
  for (const HeadPack& pack : packs_of(c)) {
    const auto sound = head(c, pack, 20), hurt = head(c, pack, 20);
    for (Head* all : {sound.get(), hurt.get()}) advance(*all, 10, c.step);
    hurt->lose(3);
    const std::size_t n = c.coordinates();
    std::vector<double> q(n), v(n), want_q(n), want_v(n), held(n);
    hurt->state(3, held, v);
    for (Head* all : {sound.get(), hurt.get()}) advance(*all, 10, c.step);
    for (std::size_t k = 0; k < 20; ++k) {
      hurt->state(k, q, v);
      sound->state(k, want_q, want_v);
      EXPECT_EQ(hurt->lost(k), k == 3);
      EXPECT_EQ(q, k == 3 ? held : want_q) << k;
      EXPECT_EQ(v, k == 3 ? std::vector<double>(n) : want_v) << k;
    }
  }
}

TEST_P(HeadOfModel, MemoryIsTheStateAndTwentyNumbers) {
  const Case& c = GetParam();
  const HeadPack pack = longest_doubles();
  const auto all = head(c, pack, 16);
  EXPECT_EQ(all->blocks(), 16u / static_cast<std::size_t>(pack.lanes));
  // Of an element coordinates, rates and rest; with the exact Jacobian accelerations from
  // which steps go on, and the size of corrections, which takes two numbers more. Two of
  // them have two numbers of when they were.
  const std::size_t n = c.coordinates();
  const std::size_t numbers = c.method == &one_solve                 ? 3 * n + 21
                              : c.method == &testing_support::newton ? 4 * n + 23
                                                                     : 5 * n + 25;
  EXPECT_LE(all->bytes(), 16u * numbers * sizeof(double));
}

TEST_P(HeadOfModel, InputIsRefusedWithTheReason) {
  const Case& c = GetParam();
  const auto all = c.model->head(options(c), {});
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
  EXPECT_THROW(c.model->head(options(c), {HeadNumber::float64, 16}), InputError);
  EXPECT_THROW(c.model->head(options({"", 0}), {}), InputError);
  EXPECT_THROW(c.model->head(options({"", 5, 40}), {}), InputError);
}

// Lanes that are done take strands of other blocks.
TEST_P(HeadOfModel, BlocksInOneCallGiveTheSameBits) {
  const Case& c = GetParam();
  for (const HeadPack& pack : packs_of(c)) {
    const auto apart = head(c, pack, 35), together = head(c, pack, 35);
    advance(*apart, 20, c.step);
    const auto scratch = together->scratch();
    for (int s = 0; s < 20; ++s) {
      together->step(0, together->blocks(), s * c.step, c.step, *scratch);
    }
    EXPECT_EQ(together->hash(), apart->hash());
  }
}

std::vector<Case> of_models() {
  std::vector<Case> all;
  for (const HairModel* model : hair_models) {
    const Case c{.name = std::string(model->name), .points = 4, .model = model};
    all.push_back(c);
    for (const HairMethod* method : exact_methods) all.push_back(exact(c, *method));
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Models, HeadOfModel, testing::ValuesIn(of_models()),
                         [](const auto& of) { return of.param.name; });

}  // namespace tress::test_reduced_head
