#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include "contract/input_error.h"
#include "models/contact/point_groups.h"
#include "models/effects/strand_interaction.h"
#include "tests/models/effects/polylines.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_strand_interaction {

using namespace models;

using namespace testing_support;

constexpr ContactLaw::Values values{
    .stiffness = 2e-4, .viscosity = 2e-3, .inner = 3e-3, .outer = 6e-3};

ContactLaw law() { return {values, "test"}; }

ContactLaw dry_law() {
  ContactLaw::Values dry = values;
  dry.viscosity = 0;
  return {dry, "test"};
}

/// Points that an effect acts on.
struct Own {
  std::vector<double> x, v, mass, length;

  void add(const Vec& at, const Vec& velocity, double carried) {
    x.insert(x.end(), {at.x, at.y, at.z});
    v.insert(v.end(), {velocity.x, velocity.y, velocity.z});
    mass.push_back(1);
    length.push_back(carried);
  }
  Points points() const {
    return {static_cast<int>(length.size()), x, v, {}, mass, length};
  }
};

std::vector<double> load(const Effect& effect, const Own& own) {
  std::vector<double> f(own.x.size());
  effect.add_load(0, own.points(), f);
  return f;
}

Vec total(const std::vector<double>& f) {
  Vec sum;
  for (std::size_t i = 0; i < f.size(); i += 3) sum = sum + load3(&f[i]);
  return sum;
}

/// A straight strand along x from x = 0, cut into segments, and points that carry it.
struct Straight {
  std::vector<double> x, v;
  Own own;

  Straight(double length, int segments, int carriers, const Vec& at,
           const Vec& velocity) {
    for (int i = 0; i <= segments; ++i) {
      const Vec place = at + Vec{length * i / segments, 0, 0};
      x.insert(x.end(), {place.x, place.y, place.z});
      v.insert(v.end(), {velocity.x, velocity.y, velocity.z});
    }
    for (int i = 0; i < carriers; ++i) {
      own.add(at + Vec{length * (i + 0.5) / carriers, 0, 0}, velocity, length / carriers);
    }
  }
};

std::vector<double> joined(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A point between each two material points, moving on from where they were.
std::vector<Own> carriers(const Polylines& strands) {
  std::vector<Own> all;
  std::size_t at = 0;
  for (const int points : strands.points) {
    Own own;
    for (int i = 0; i + 1 < points; ++i, at += 3) {
      const Vec x = load3(&strands.x[at]), v = load3(&strands.v[at]);
      own.add(0.7 * x + 0.3 * load3(&strands.x[at + 3]) + 1e-3 * v, v, 0.01);
    }
    at += 3;
    all.push_back(own);
  }
  return all;
}

/// Without a grid.
Vec expected_force(const Polylines& partners, std::size_t own, const Vec& x,
                   const Vec& v) {
  Vec sum;
  std::size_t first = 0;
  for (std::size_t k = 0; k < partners.points.size(); ++k) {
    const auto last = first + static_cast<std::size_t>(partners.points[k]) - 1;
    double least = std::numeric_limits<double>::infinity();
    Vec gap, u;
    for (std::size_t i = first; i < last; ++i) {
      const StraightPiece piece(load3(&partners.x[3 * i]), load3(&partners.x[3 * i + 3]));
      const double s = piece.nearest(x);
      const Vec d = x - piece.at(s);
      if (dot(d, d) >= least) continue;
      least = dot(d, d);
      gap = d;
      u = v - (1 - s) * load3(&partners.v[3 * i]) - s * load3(&partners.v[3 * i + 3]);
    }
    first = last + 1;
    if (k != own) sum = sum + law().force(gap, u);
  }
  return sum;
}

TEST(StrandInteraction, MeetsEveryOtherStrandOnceWhateverTheListsSaw) {
  Polylines strands(30, 8, 0.05, 0.01, 1, 11);
  StrandInteraction interaction(law(), strands.points);
  long touched = 0;
  for (int step = 0; step < 30; ++step) {
    interaction.update(strands.x, strands.v);
    const std::vector<Own> own = carriers(strands);
    for (std::size_t k = 0; k < own.size(); ++k) {
      const std::vector<double> f = load(*interaction.effect(k), own[k]);
      for (std::size_t i = 0; i < own[k].length.size(); ++i) {
        const Vec force =
            own[k].length[i] *
            expected_force(strands, k, load3(&own[k].x[3 * i]), load3(&own[k].v[3 * i]));
        if (dot(force, force) > 0) ++touched;
        // Sums of up to 29 forces of at most l (K P + D 2 m/s): 4e-5 N, times eps.
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_NEAR(f[3 * i + c], (&force.x)[c], 29 * 4e-5 * 2.3e-16);
        }
      }
    }
    strands.move(1e-3);
  }
  EXPECT_GT(touched, 1000);
  EXPECT_LT(interaction.partners().epochs(), 15);
}

/// Loads and derivatives of all strands at carriers(strands), whose points may have moved
/// on since the update.
std::vector<double> everything(const StrandInteraction& interaction,
                               const std::vector<std::unique_ptr<const Effect>>& effects,
                               const Polylines& strands) {
  std::vector<double> all;
  const std::vector<Own> own = carriers(strands);
  for (std::size_t k = 0; k < own.size(); ++k) {
    std::vector<double> f = load(*effects[k], own[k]), blocks(3 * f.size());
    effects[k]->add_derivatives(0, own[k].points(), 2, 3, blocks);
    std::vector<double> both(f.size()), both_blocks(blocks.size());
    effects[k]->add_both(0, own[k].points(), 2, 3, both, both_blocks);
    // Products are fused with sums in one and not in the other: some eps of 0.1.
    const auto same = [](double a, double b) { return std::abs(a - b) < 1e-16; };
    EXPECT_TRUE(std::ranges::equal(both, f, same));
    EXPECT_TRUE(std::ranges::equal(both_blocks, blocks, same));
    all.insert(all.end(), f.begin(), f.end());
    all.insert(all.end(), blocks.begin(), blocks.end());
  }
  EXPECT_TRUE(interaction.partners().updated());
  return all;
}

std::vector<std::unique_ptr<const Effect>> effects_of(
    const StrandInteraction& interaction, std::size_t strands) {
  std::vector<std::unique_ptr<const Effect>> all;
  for (std::size_t k = 0; k < strands; ++k) all.push_back(interaction.effect(k));
  return all;
}

/// Kept lists against new ones, to the last bit: motions from far less than the margin to
/// many times the reach, of own points within a step too, dense and sparse, two strands.
TEST(StrandInteraction, KeptListsMissNothingWhateverMoves) {
  for (const int count : {2, 25}) {
    for (const double box : {count == 2 ? 2e-3 : 0.02, count == 2 ? 5e-3 : 0.2}) {
      Polylines strands(count, 8, box, 0.01, 1, 5);
      StrandInteraction kept(law(), strands.points);
      const auto effects = effects_of(kept, strands.points.size());
      long felt = 0;
      for (int step = 0; step < 60; ++step) {
        kept.update(strands.x, strands.v);
        StrandInteraction fresh(law(), strands.points);
        fresh.update(strands.x, strands.v);
        // As during a step: twice from the same update, points moving on.
        for (const double h : {0.0, 1e-3, step % 7 == 0 ? 0.02 : 1e-4}) {
          Polylines later = strands;
          later.move(h);
          const auto expected =
              everything(fresh, effects_of(fresh, strands.points.size()), later);
          EXPECT_EQ(everything(kept, effects, later), expected);
          felt += std::ranges::count_if(expected, [](double f) { return f != 0; });
        }
        const double h[] = {1e-4, 3e-4, 1e-3, 1e-5, 0.03};
        strands.move((step / 8 % 2 == 0 ? 1 : -1) * h[step % 5]);
      }
      EXPECT_GT(felt, 100);
    }
  }
}

/// Lists are made anew where hair moves, not where it rests.
TEST(PointGroups, ListsHoldWhereHairIsSlow) {
  constexpr int each = 20;
  Polylines still(each, 8, 0.03, 0.01, 1, 2), moves(each, 8, 0.03, 0.01, 1, 7);
  std::vector<int> points = still.points;
  points.insert(points.end(), moves.points.begin(), moves.points.end());
  StrandPartners partners(points, 6e-3);
  PointGroups slow(partners, 0), fast(partners, each);
  const std::vector<double> length(8, 0.01), zero(still.v.size());
  const auto x_of = [](const Polylines& all) { return In(all.x).first(3 * 8); };
  const std::vector<double> start = moves.x;
  std::vector<double> far(start.size());
  for (int step = 0; step < 40; ++step) {
    // A metre away; first points stay, as the head does.
    for (std::size_t i = 0; i < far.size(); ++i) {
      const std::vector<double>& from = i % 27 < 3 ? start : moves.x;
      far[i] = from[i] + (i % 3 == 0 ? 1 : 0);
    }
    partners.hold(joined(still.x, far), joined(zero, moves.v), models::in_turn);
    slow.ready(x_of(still), length);
    fast.ready(In(far).first(3 * 8), length);
    moves.move(step / 8 % 2 == 0 ? 1e-3 : -1e-3);
  }
  EXPECT_EQ(slow.made(), 1);  // of its one group
  EXPECT_GT(fast.made(), 10);
}

/// Eight points in one register or four and four, at the update and after it; the last
/// group is not full.
TEST(PointGroups, InstructionsGiveTheSameBits) {
  if (!available(Instructions::avx512)) GTEST_SKIP() << "no AVX-512 here";
  Polylines strands(25, 13, 0.03, 0.01, 1, 9);
  StrandPartners partners(strands.points, 6e-3);
  std::vector<PointGroups> base, wide;
  for (int k = 0; k < 25; ++k) {
    base.emplace_back(partners, k, Instructions::base);
    wide.emplace_back(partners, k, Instructions::avx512);
  }
  const auto bits = [](const GroupLoads& loads) {
    std::vector<double> all(loads.by_velocity.begin(), loads.by_velocity.end());
    for (const GroupVectors* vectors :
         {&loads.force, &loads.by_place[0], &loads.by_place[1], &loads.by_place[2]}) {
      for (const GroupNumbers* numbers : {&vectors->x, &vectors->y, &vectors->z}) {
        all.insert(all.end(), numbers->begin(), numbers->end());
      }
    }
    return all;
  };
  long felt = 0;
  for (int step = 0; step < 20; ++step) {
    partners.extrapolate(0, 1e-3, strands.x, strands.v, in_turn);
    const std::vector<Own> own = carriers(strands);
    for (std::size_t k = 0; k < own.size(); ++k) {
      base[k].ready(own[k].x, own[k].length);
      wide[k].ready(own[k].x, own[k].length);
      for (std::size_t g = 0; g < base[k].groups(); ++g) {
        ASSERT_EQ(base[k].feels(g), wide[k].feels(g));
        for (const double elapsed : {0.0, 1e-3}) {
          GroupLoads by_base, by_wide;
          base[k].loads(g, law(), own[k].v, elapsed, by_base);
          wide[k].loads(g, law(), own[k].v, elapsed, by_wide);
          ASSERT_EQ(bits(by_base), bits(by_wide));
          felt += std::ranges::count_if(bits(by_base), [](double f) { return f != 0; });
        }
      }
    }
    strands.move(1e-3);
  }
  EXPECT_GT(felt, 10000);
}

TEST(StrandInteraction, ListsStandWhileAllMoveWithTheHead) {
  const Polylines rest(30, 8, 0.05, 0.01, 1, 11);
  StrandInteraction moving(law(), rest.points);
  const auto effects = effects_of(moving, rest.points.size());
  for (int step = 0; step < 40; ++step) {
    const Frame turn = rotation({0, 0.6, 0.8}, 0.2 * step);
    Polylines now = rest;
    for (std::size_t i = 0; i < now.x.size(); i += 3) {
      store3(turn * load3(&rest.x[i]) + Vec{0.1 * step, 0, 0}, &now.x[i]);
    }
    moving.update(now.x, now.v);
    StrandInteraction fresh(law(), rest.points);
    fresh.update(now.x, now.v);
    EXPECT_EQ(everything(moving, effects, now),
              everything(fresh, effects_of(fresh, rest.points.size()), now));
  }
  EXPECT_EQ(moving.partners().epochs(), 1);
}

TEST(StrandInteraction, LeavesOutStrandsThatAreNowhere) {
  for (const double lost : {std::nan(""), 1e4, 1e200}) {
    Polylines strands(20, 8, 0.04, 0.01, 1, 4), without = strands;
    for (std::size_t i = 0; i < 27; ++i) {
      strands.x[i] = lost;
      without.x[i] += 100;
    }
    StrandInteraction interaction(law(), strands.points), far(law(), strands.points);
    for (int step = 0; step < 5; ++step) {
      interaction.update(strands.x, strands.v);
      far.update(without.x, without.v);
      const auto found = everything(interaction, effects_of(interaction, 20), strands),
                 expected = everything(far, effects_of(far, 20), without);
      EXPECT_GT(std::ranges::count_if(found, [](double f) { return f != 0; }), 100);
      EXPECT_EQ(found, expected);
      for (Polylines* all : {&strands, &without}) all->move(1e-3);
    }
    // Where a place is none, nothing is sorted anew for it.
    EXPECT_EQ(interaction.partners().epochs(), far.partners().epochs());
  }
}

/// Far from where lists were made too: partners move by 8 reaches.
TEST(StrandInteraction, PartnersThatMoveAreMetWhereTheyAreThen) {
  const Polylines strands(20, 8, 0.05, 0.01, 1, 8);
  const double begin = 0.5, end = 0.55, t = 0.54;
  std::vector<double> straight = strands.x, curved = strands.x, late = strands.v,
                      y = strands.x, w = strands.v;
  for (std::size_t i = 0; i < y.size(); ++i) {
    // x + v s + a s^2/2 is a cubic, found from its ends.
    const double a = i % 3 == 0 ? 100 : -50, h = end - begin, s = t - begin;
    y[i] += h * strands.v[i] + h * h / 2 * a;
    w[i] += h * a;
    straight[i] += s * strands.v[i];
    curved[i] += s * strands.v[i] + s * s / 2 * a;
    late[i] += s * a;
  }
  StrandInteraction moving(law(), strands.points), there(law(), strands.points);
  const auto compare = [&](const std::vector<double>& x, const std::vector<double>& v) {
    there.update(x, v);
    Polylines moved = strands;
    moved.x = x;
    moved.v = v;
    const std::vector<Own> own = carriers(moved);
    double most = 0;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const auto effect = moving.effect(k);
      std::vector<double> f(own[k].x.size());
      effect->add_load(t, own[k].points(), f);
      const std::vector<double> expected = load(*there.effect(k), own[k]);
      for (std::size_t i = 0; i < f.size(); ++i) {
        most = std::max(most, std::abs(expected[i]));
        // Rounding of places of 1 m, on which the force depends by K and D w'.
        EXPECT_NEAR(f[i], expected[i], 1e-12 * std::abs(expected[i]) + 1e-17);
      }
      EXPECT_EQ(effect->next_breakpoint(t), end);
      EXPECT_GT(effect->next_breakpoint(end), 1e300);
    }
    EXPECT_GT(most, 1e-9);
  };
  moving.extrapolate(begin, end, strands.x, strands.v);
  compare(straight, strands.v);
  moving.interpolate(begin, end, strands.x, strands.v, y, w);
  compare(curved, late);
}

TEST(StrandInteraction, DoesNotDependOnHowStrandsAreCut) {
  const double length = 0.06, gap = 2e-3;
  const Vec fast{0.3, 0.1, -0.2};
  // Per length the law's force, at every point alike.
  const Vec force = length * law().force({0, 0, gap}, fast);
  for (const int segments : {1, 2, 13}) {
    for (const int points : {1, 4, 40}) {
      const Straight upper(length, 1, points, {0, 0, gap}, fast);
      const Straight lower(length, segments, 1, {}, {});
      StrandInteraction interaction(law(), {2, segments + 1});
      interaction.update(joined(upper.x, lower.x), joined(upper.v, lower.v));
      const Vec sum = total(load(*interaction.effect(0), upper.own));
      // Places are rounded to eps of 6 cm, the law's slope K: 1e-17 of 1e-5 N.
      const double rounding = 1e-14 * norm(force);
      EXPECT_NEAR(sum.x, force.x, rounding);
      EXPECT_NEAR(sum.y, force.y, rounding);
      EXPECT_NEAR(sum.z, force.z, rounding);
    }
  }
}

TEST(StrandInteraction, DerivativesAreDifferencesOfTheLoad) {
  // A partner of two segments that stretch and turn; points beside a segment and beyond
  // an end, in both parts of the law.
  const std::vector<double> own_strand{0, 0, 1, 0.1, 0, 1};
  const std::vector<double> x{0, 0, 0, 0.01, 0.002, 0, 0.02, 0, 0.001};
  const std::vector<double> v{0.1, 0.2, -0.1, 0.3, 0.1, 0.2, -0.4, 0, 0.5};
  StrandInteraction interaction(law(), {2, 3});
  interaction.update(joined(own_strand, x), joined(std::vector<double>(6), v));
  const auto effect = interaction.effect(0);
  const double carried = 0.01;
  for (const Vec at :
       {Vec{0.004, 0.0015, 0.001}, Vec{0.005, -0.002, 0.003}, Vec{0.017, 0.003, -0.001},
        Vec{-0.001, 0.001, 0.0005}, Vec{0.023, -0.002, 0.001}}) {
    const Vec speed{0.2, -0.3, 0.1};
    Own own;
    own.add(at, speed, carried);
    ASSERT_NE(dot(total(load(*effect, own)), Vec{1, 1, 1}), 0);
    std::vector<double> by_x(9), by_v(9), both(9);
    effect->add_derivatives(0, own.points(), 1, 0, by_x);
    effect->add_derivatives(0, own.points(), 0, 1, by_v);
    effect->add_derivatives(0, own.points(), 3, 5, both);
    for (std::size_t j = 0; j < 3; ++j) {
      const auto moved = [&](double step, std::vector<double> Own::*what) {
        Own there = own;
        (there.*what)[j] += step;
        return load(*effect, there);
      };
      const double size = 1e-3;  // m, over which the law changes
      const auto dx = central_difference(difference_step * size,
                                         [&](double e) { return moved(e, &Own::x); });
      const auto dv = central_difference(difference_step,
                                         [&](double e) { return moved(e, &Own::v); });
      // Forces l (K P + D u); truncation and rounding 3e-13 times ratios of derivatives.
      const double force = carried * (values.stiffness * values.inner + values.viscosity);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(by_x[3 * i + j], dx[i], 1e-9 * force / size);
        EXPECT_NEAR(by_v[3 * i + j], dv[i], 1e-9 * force);
        EXPECT_NEAR(both[3 * i + j], 3 * by_x[3 * i + j] + 5 * by_v[3 * i + j],
                    10 * 2.3e-16 * force / size);
      }
    }
  }
}

TEST(StrandInteraction, CountsAllOfItsWorkAsPower) {
  Polylines strands(10, 8, 0.03, 0.01, 1, 2);
  StrandInteraction interaction(law(), strands.points);
  interaction.update(strands.x, strands.v);
  const Own own = carriers(strands)[4];
  const auto effect = interaction.effect(4);
  const std::vector<double> f = load(*effect, own);
  double work = 0, size = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    work += f[i] * own.v[i];
    size += std::abs(f[i] * own.v[i]);
  }
  EXPECT_GT(size, 0);
  EXPECT_NEAR(effect->power(0, own.points()), work, 24 * 2.3e-16 * size);
  EXPECT_EQ(effect->potential(0, own.points()), 0);
}

TEST(StrandInteraction, GivesTheSameNumbersToManyThreads) {
  Polylines strands(40, 8, 0.05, 0.01, 1, 8);
  StrandInteraction interaction(law(), strands.points);
  interaction.update(strands.x, strands.v);
  const std::vector<Own> own = carriers(strands);
  const auto run = [&](std::size_t first, std::size_t stride,
                       std::vector<std::vector<double>>& all) {
    for (std::size_t k = first; k < own.size(); k += stride) {
      all[k] = load(*interaction.effect(k), own[k]);
    }
  };
  std::vector<std::vector<double>> alone(own.size()), together(own.size());
  run(0, 1, alone);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] { run(i, 4, together); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone, together);
}

TEST(StrandInteraction, LaggedPartnersMissMomentumInProportionToTheStep) {
  // The upper strand comes down at speed w onto the lower one at rest. Upper points are
  // pushed by K (P - d) at the gap d of now, lower ones at that of the last step, d + h
  // w: the sum is K L h w, viscous forces apart, which sum to zero.
  const double length = 0.06, gap = 2e-3, w = 0.1;
  for (const double h : {1e-3, 5e-4, 2.5e-4}) {
    const Straight upper(length, 6, 24, {0, 0, gap}, {0, 0, -w});
    const Straight lower(length, 6, 24, {}, {});
    const Straight before(length, 6, 24, {0, 0, gap + h * w}, {0, 0, -w});
    StrandInteraction interaction(law(), {7, 7});
    interaction.update(joined(before.x, lower.x), joined(before.v, lower.v));
    const Vec sum = total(load(*interaction.effect(0), upper.own)) +
                    total(load(*interaction.effect(1), lower.own));
    const double expected = values.stiffness * length * h * w;
    // rho against d changes the slope by P^3/d^3 1e-6 = 3e-6 of it.
    EXPECT_NEAR(sum.z, expected, 5e-6 * expected);
  }
}

TEST(StrandInteraction, StaysFiniteOnTopOfItself) {
  const Straight strand(0.06, 6, 24, {}, {0, 0, 1});
  StrandInteraction interaction(law(), {7, 7});
  interaction.update(joined(strand.x, strand.x), joined(strand.v, strand.v));
  const Vec sum = total(load(*interaction.effect(0), strand.own));
  // Gaps of eps of 6 cm times the law's largest slope, 1000 K, and the length.
  EXPECT_LE(norm(sum), 24 * 1e-17 * 0.2 * 0.06);
  std::vector<double> blocks(9 * 24);
  interaction.effect(0)->add_derivatives(0, strand.own.points(), 1, 1, blocks);
  for (const double entry : blocks) EXPECT_TRUE(std::isfinite(entry));
  EXPECT_EQ(interaction.touching_pairs(), 1);
  EXPECT_LE(interaction.mean_distance(), 1e-17);
}

TEST(StrandInteraction, DoesNothingBeforeTheFirstUpdateNorToPointsWithoutLength) {
  Straight strand(0.06, 6, 24, {}, {});
  StrandInteraction interaction(law(), {7, 7});
  EXPECT_EQ(total(load(*interaction.effect(0), strand.own)).z, 0);
  EXPECT_EQ(interaction.touching_pairs(), 0);
  EXPECT_EQ(interaction.mean_distance(), std::numeric_limits<double>::infinity());
  const Straight below(0.06, 6, 24, {0, 0, -1e-3}, {});
  interaction.update(joined(strand.x, below.x), joined(strand.v, below.v));
  EXPECT_GT(total(load(*interaction.effect(0), strand.own)).z, 0);
  strand.own.length.assign(24, 0.0);
  EXPECT_EQ(total(load(*interaction.effect(0), strand.own)).z, 0);
}

TEST(StrandInteraction, MeasuresHowStrandsCrowd) {
  for (const double gap : {1e-3, 4e-3, 0.1}) {
    const Straight upper(0.06, 6, 24, {0, 0, gap}, {});
    const Straight lower(0.06, 5, 24, {}, {});
    // A third one crosses far away, at right angles, over a distance of 0.5 and more.
    const std::vector<double> far{0.03, -0.05, 0.6 + gap, 0.03, 0.05, 0.6 + gap};
    StrandInteraction interaction(dry_law(), {7, 6, 2});
    interaction.update(joined(joined(upper.x, lower.x), far),
                       joined(joined(upper.v, lower.v), std::vector<double>(6)));
    EXPECT_EQ(interaction.touching_pairs(), gap < values.inner ? 1 : 0);
    // Two of 6 cm at `gap`; the third, 10 cm in 34 samples, at sqrt(0.6^2 + y^2).
    double third = 0;
    for (int k = 0; k < 34; ++k) third += std::hypot(0.6, 0.1 * (k + 0.5) / 34 - 0.05);
    const double mean = (0.12 * gap + 0.1 / 34 * third) / 0.22;
    EXPECT_NEAR(interaction.mean_distance(), mean, 1e-14);
  }
}

TEST(StrandInteraction, RefusesStrandsWithoutSegmentsAndTableEntriesThatAreNone) {
  EXPECT_THROW(StrandInteraction(law(), {5, 1}), InputError);
  Parameters parameters(strand_interaction_parameters(), "effects.strand_interaction");
  EXPECT_EQ(parameters.word("coupling"), "lagged");
  parameters.set("outer_radius_m", "0.001");
  EXPECT_THROW(StrandInteraction(parameters, {5, 5}), InputError);
}

}  // namespace tress::test_strand_interaction
