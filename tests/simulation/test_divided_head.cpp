// Heads that ranks divide among themselves: regions of the scalp, and the same bits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>

#include "contract/input_error.h"
#include "simulation/head/head_balance.h"
#include "simulation/head/head_run.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/strand_tables.h"
#include "tests/support/thread_ranks.h"

namespace tress::simulation {
namespace {

using testing_support::ThreadRanks;

std::vector<Vec> roots_on_a_ball(std::size_t count) {
  std::vector<Vec> roots;
  for (std::size_t k = 0; k < count; ++k) {
    const double z = 1 - (static_cast<double>(k) + 0.5) / static_cast<double>(count),
                 turn = 2.399963229728653 * static_cast<double>(k);
    roots.push_back({std::sqrt(1 - z * z) * std::cos(turn),
                     1.2 * std::sqrt(1 - z * z) * std::sin(turn), z});
  }
  return roots;
}

TEST(HeadDivision, GivesEveryStrandToOneRank) {
  constexpr std::size_t count = 1000;
  const std::vector<Vec> roots = roots_on_a_ball(count);
  const std::vector<double> cost(count, 1);
  std::set<std::size_t> seen;
  for (int rank = 0; rank < 7; ++rank) {
    const HeadDivision division(roots, cost, 7, rank);
    EXPECT_NEAR(static_cast<double>(division.own().size()), count / 7.0, 4);
    for (std::size_t i = 0; i < division.own().size(); ++i) {
      const std::size_t k = division.own()[i];
      EXPECT_TRUE(seen.insert(k).second);
      EXPECT_EQ(division.owner(k), rank);
      if (i > 0) {
        EXPECT_LT(division.number(i - 1), division.number(i));
      }
    }
  }
  EXPECT_EQ(seen.size(), count);
}

TEST(HeadDivision, RegionsAreOfEqualCost) {
  constexpr std::size_t count = 2000;
  const std::vector<Vec> roots = roots_on_a_ball(count);
  std::vector<double> cost(count);
  for (std::size_t k = 0; k < count; ++k) cost[k] = roots[k].y > 0 ? 3 : 1;
  const double all = std::accumulate(cost.begin(), cost.end(), 0.0);
  for (int rank = 0; rank < 4; ++rank) {
    double own = 0;
    const HeadDivision division(roots, cost, 4, rank);
    for (const std::size_t k : division.own()) own += cost[k];
    // Two cuts, each off by a strand at most.
    EXPECT_NEAR(own, all / 4, 2 * 3);
  }
}

// The first cut is across the longest side, y.
TEST(HeadDivision, RegionsAreHalvesOfTheScalp) {
  const std::vector<Vec> roots = roots_on_a_ball(500);
  const HeadDivision division(roots, std::vector<double>(500, 1), 2, 0);
  double least_of_other = 1e9, most = -1e9;
  for (std::size_t k = 0; k < 500; ++k) {
    double& end = division.owner(k) == 0 ? most : least_of_other;
    end = division.owner(k) == 0 ? std::max(end, roots[k].y) : std::min(end, roots[k].y);
  }
  EXPECT_LE(most, least_of_other);
}

TEST(HeadDivision, FindsOwnStrandsOfAList) {
  const std::vector<Vec> roots = roots_on_a_ball(300);
  const HeadDivision division(roots, std::vector<double>(300, 1), 3, 1);
  const std::vector<std::size_t> list{3, 17, 18, 40, 41, 42, 99, 150, 151, 280, 299};
  const auto found = division.own_among(list);
  EXPECT_EQ(found.size(), division.counts(list)[1]);
  EXPECT_GT(found.size(), 1U);
  std::vector<std::size_t> own;
  for (const std::size_t k : list) {
    if (division.owner(k) == 1) own.push_back(k);
  }
  for (const auto& one : found) EXPECT_EQ(division.own()[one.place], own[one.index]);
}

TEST(HeadDivision, OrdersItsPlacesByTheNumbers) {
  const std::vector<Vec> roots = roots_on_a_ball(300);
  const HeadDivision division(roots, std::vector<double>(300, 1), 3, 2);
  ASSERT_EQ(division.order().size(), division.own().size());
  for (std::size_t i = 0; i < division.own().size(); ++i) {
    EXPECT_EQ(division.order()[division.by_number()[i]], i);
  }
}

TEST(HeadBalance, SharesTheTimeOfARankAmongItsStrands) {
  const std::vector<Vec> roots = roots_on_a_ball(100);
  std::vector<double> unequal(100, 1);
  unequal[0] = 30;
  const HeadDivision division(roots, unequal, 2, 0);
  const std::vector<double> seconds{3, 1}, cost = cost_of_strands(division, seconds);
  std::vector<double> sums(2);
  for (std::size_t k = 0; k < 100; ++k) {
    sums[static_cast<std::size_t>(division.owner(k))] += cost[k];
    EXPECT_GT(cost[k], 0);
  }
  // Of a hundred roundings.
  for (const int rank : {0, 1}) {
    EXPECT_NEAR(sums[static_cast<std::size_t>(rank)],
                seconds[static_cast<std::size_t>(rank)], 3 * 100 * 2.3e-16);
  }
}

TEST(Ranks, TellEachOtherWhatTheyHave) {
  ThreadRanks::run(3, [](Ranks& mine) {
    const std::vector<double> all = mine.of_each(10.0 * mine.rank());
    EXPECT_EQ(all, (std::vector<double>{0, 10, 20}));
    std::vector<int> numbers(2, 5 + mine.rank());
    mine.as_first(std::span(numbers));
    EXPECT_EQ(numbers, (std::vector<int>{5, 5}));
  });
}

struct Scalp {
  std::string name, more, model = "super_helix";
  double h = 0.005;  // s
};
void PrintTo(const Scalp& a, std::ostream* out) {  // NOLINT
  *out << a.name << ' ' << a.model;
}
class DividedHead : public testing::TestWithParam<Scalp> {};

SceneOutline scene(const Scalp& scalp, int count) {
  return parse_outline(
      fmt::format("title = \"t\"\nduration_s = 1\nframes_per_s = 10\n[model]\n"
                  "id = \"{}\"\njacobian = \"elastic\"\n[integrator]\n"
                  "id = \"linearly_implicit_euler\"\ndt_s = 0.005\n[material]\n"
                  "name = \"hair.caucasian\"\n[groom]\ncount = {}\nelements = 4\n"
                  "length_m = 0.1\ncurl_variation = 0.5\nshape = \"helix\"\n"
                  "curl_radius_m = 0.01\ncurl_pitch_m = 0.02\n[root]\n"
                  "motion = \"rotate\"\naxis = [0, 0.6, 0.8]\nangle_rad = 1\n"
                  "frequency_hz = 2\n[effects.gravity]\n[effects.linear_drag]\n"
                  "drag_kg_m_s = 1e-4\n{}",
                  scalp.model, count, scalp.more),
      "head.toml");
}

struct Outcome {
  std::size_t hash = 0, most = 0;  // most: strands of a rank
  std::vector<double> x, kept;
  double ghosts = 0;
};

Outcome run(const SceneOutline& outline, const models::HeadPack& pack, int ranks,
            int threads, int steps, double h) {
  Outcome outcome;
  std::mutex guard;
  ThreadRanks::run(ranks, [&](Ranks& mine) {
    HeadRun head(make_head(outline, pack, threads, mine), threads, mine);
    for (int s = 0; s < steps; ++s) head.step(s * h, h);
    const std::size_t hash = head.hash();
    std::vector<double> x, kept;
    head.by_chunks(1000000, [&](HeadRun::Numbers all) {
      head.positions(steps * h, all, x);
      head.keep(all, kept);
    });
    const std::scoped_lock lock(guard);
    outcome.most = std::max(outcome.most, head.head().strands());
    if (head.halo() != nullptr) outcome.ghosts += head.halo()->work().ghosts;
    if (!mine.first()) return;
    outcome.hash = hash;
    outcome.x = x;
    outcome.kept = kept;
  });
  return outcome;
}

TEST_P(DividedHead, IsTheSameBitsForAnyNumberOfRanksAndThreads) {
  constexpr int count = 150, steps = 30;
  const SceneOutline outline = scene(GetParam(), count);
  for (const models::HeadPack& pack :
       {models::longest_pack(models::HeadNumber::float64),
        models::longest_pack(models::HeadNumber::float32)}) {
    const Outcome one = run(outline, pack, 1, 1, steps, GetParam().h);
    EXPECT_EQ(one.most, count);
    for (const auto& [ranks, threads] : {std::pair(2, 1), {3, 2}, {4, 1}}) {
      const Outcome more = run(outline, pack, ranks, threads, steps, GetParam().h);
      EXPECT_EQ(more.hash, one.hash) << ranks;
      EXPECT_EQ(more.x, one.x) << ranks;
      EXPECT_EQ(more.kept, one.kept) << ranks;
      EXPECT_LE(more.most, static_cast<std::size_t>(count / ranks + 2));
      const bool touch = GetParam().name == "interaction";
      EXPECT_EQ(more.ghosts > 0, touch);
    }
  }
}

// Strands change their ranks, and nothing else.
TEST_P(DividedHead, GoesOnWhenItIsDividedAnew) {
  constexpr int count = 100, steps = 30;
  const SceneOutline outline = scene(GetParam(), count);
  const models::HeadPack pack{models::HeadNumber::float64, 4};
  const Outcome one = run(outline, pack, 1, 1, 2 * steps, GetParam().h);
  for (const int ranks : {2, 4}) {
    std::optional<std::size_t> hash;
    ThreadRanks::run(ranks, [&](Ranks& mine) {
      const double h = GetParam().h;
      HeadRun before(make_head(outline, pack, 1, mine), 1, mine);
      for (int s = 0; s < steps; ++s) before.step(s * h, h);
      std::vector<double> cost(count, 1);
      for (std::size_t k = 0; k < count; ++k) {
        if (before.division().owner(k) == 0) cost[k] = 3;
      }
      HeadRun after(make_head(outline, pack, 1, mine, cost), 1, mine);
      std::vector<double> kept;
      before.by_chunks(33, [&](HeadRun::Numbers some) {
        before.keep(some, kept);
        after.recall(some, kept);
      });
      int moved = 0;
      for (std::size_t k = 0; k < count; ++k) {
        moved += before.division().owner(k) != after.division().owner(k) ? 1 : 0;
      }
      EXPECT_GT(moved, count / 10);
      for (int s = steps; s < 2 * steps; ++s) after.step(s * h, h);
      const std::size_t value = after.hash();
      if (mine.first()) hash = value;
    });
    EXPECT_EQ(hash, one.hash) << ranks;
  }
}

std::vector<Scalp> scalps() {
  std::vector<Scalp> all;
  for (const std::string model : {"super_helix", "super_clothoid", "articulated_chain"}) {
    all.push_back({"free", "", model});
    // By longer steps rigid links come apart on a body.
    all.push_back({"body",
                   "[effects.body]\nshape = \"ellipsoid\"\n"
                   "half_axes_m = [0.11, 0.1, 0.13]\nmoves = \"head\"\n",
                   model, model == "articulated_chain" ? 0.001 : 0.005});
    all.push_back(
        {"interaction", "[effects.strand_interaction]\nouter_radius_m = 0.008\n", model});
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Scalps, DividedHead, testing::ValuesIn(scalps()),
                         [](const auto& of) {
                           return of.param.name + '_' + of.param.model;
                         });

// A step looks where rates lead from here: x + h v but for terms of h^2.
TEST(HeadAhead, IsWhereRatesLeadTo) {
  const SceneOutline outline = scene({"free", ""}, 11);
  HeadOptions options{{.elements = 4, .longest = 0.1, .motion = outline.scene.head}};
  for (const auto& make :
       {helix_head, clothoid_head, chain_head, der_head, spring_head}) {
    const auto head = make(options, {models::HeadNumber::float64, 4});
    for (std::size_t k = 0; k < outline.series->size(); ++k) {
      head->add(outline.series->strand(k));
    }
    const auto scratch = head->scratch();
    double t = 0;
    for (int s = 0; s < 40; ++s, t += 1e-3) {
      for (std::size_t b = 0; b < head->blocks(); ++b) head->step(b, t, 1e-3, *scratch);
    }
    std::vector<double> x(4 * head->numbers()), v(x.size()), ahead(x.size()), bulge(4);
    head->motion(1, t, x, v);
    double most[2] = {};
    for (const int halved : {0, 1}) {
      const double h = halved == 1 ? 1e-4 : 2e-4;
      head->ahead(1, t, h, ahead, bulge);
      for (std::size_t i = 0; i < x.size(); ++i) {
        most[halved] = std::max(most[halved], std::abs(ahead[i] - x[i] - h * v[i]));
      }
      for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(bulge[k], 0.1 / 4 / 2);
    }
    EXPECT_GT(most[0], 1e-9);  // m, or this says little
    EXPECT_NEAR(most[0] / most[1], 4, 0.4);
    // Arcs lie beside their chords, edges on them.
    EXPECT_EQ(bulge[0] > 1e-5, make == helix_head || make == clothoid_head);
  }
}

TEST(DividedHead, NeedsAStrandForEachRank) {
  const SceneOutline outline = scene({"free", ""}, 2);
  ThreadRanks::run(3, [&](Ranks& mine) {
    EXPECT_THROW(make_head(outline, {models::HeadNumber::float64, 4}, 1, mine),
                 InputError);
  });
}

}  // namespace
}  // namespace tress::simulation
