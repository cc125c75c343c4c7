// The model of what a divided head costs: its regions' borders beside those that a head
// is divided into, its numbers found again in what it says, and what it predicts.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <system_error>
#include <vector>

#include "contract/read_file.h"
#include "experiments/divided_heads/cost_model.h"
#include "experiments/divided_heads/launch.h"
#include "experiments/divided_heads/predictions.h"
#include "experiments/divided_heads/scene.h"
#include "simulation/head/head_division.h"

namespace tress::test_divided_heads {

using namespace experiments;
using namespace experiments::divided_heads;

constexpr double eps = std::numeric_limits<double>::epsilon();

/// By hand, over the side of a square: halves share it, quarters have two sides of a half
/// each, of 8 the inner ones two of a half and one of a quarter, of 16 four of a quarter.
TEST(DividedBorder, IsThatOfTheRegionWithMost) {
  EXPECT_EQ(border(1), 0);
  EXPECT_EQ(border(2), 1);
  EXPECT_EQ(border(4), 1);
  EXPECT_EQ(border(8), 1.25);
  EXPECT_EQ(border(16), 1);
  EXPECT_EQ(border(64), 0.5);
  EXPECT_EQ(border(1024), 4 / 32.0);
}

/// Points on a lattice of spacing d that are divided as a head is, and how many of other
/// regions lie within a depth w of a region. Along a border of length b that is b w/d^2
/// but for a row of b/d points at its edge, and at each of at most four corners for the
/// part of w^2/d^2 that lies around it.
TEST(DividedBorder, CountsTheGhostsOfADividedScalp) {
  constexpr int side = 128;
  constexpr double d = 1.0 / side, w = 6.25 * d;
  std::vector<Vec> roots;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) roots.push_back({i * d, j * d, 0});
  }
  const std::vector<double> equal(roots.size(), 1);
  for (const int ranks : {1, 2, 4, 8, 16, 64}) {
    const simulation::HeadDivision division(roots, equal, ranks, 0);
    std::vector<Vec> least(static_cast<std::size_t>(ranks), {1, 1, 0}),
        most(least.size());
    for (std::size_t k = 0; k < roots.size(); ++k) {
      const auto r = static_cast<std::size_t>(division.owner(k));
      least[r] = {std::min(least[r].x, roots[k].x), std::min(least[r].y, roots[k].y), 0};
      most[r] = {std::max(most[r].x, roots[k].x), std::max(most[r].y, roots[k].y), 0};
    }
    double largest = 0;
    for (std::size_t r = 0; r < least.size(); ++r) {
      double ghosts = 0;
      for (std::size_t k = 0; k < roots.size(); ++k) {
        if (static_cast<std::size_t>(division.owner(k)) == r) continue;
        const auto beyond = [&](double x, double a, double b) {
          return std::max({a - x, x - b, 0.0});
        };
        ghosts += std::hypot(beyond(roots[k].x, least[r].x, most[r].x),
                             beyond(roots[k].y, least[r].y, most[r].y)) <= w
                      ? 1
                      : 0;
      }
      largest = std::max(largest, ghosts);
    }
    CostModel model;
    model.depth = w / d;
    const double strands = side * side, length = border(ranks) * side;
    EXPECT_NEAR(model.ghosts(strands, ranks), largest,
                length + 4 * model.depth * model.depth)
        << ranks;
  }
}

CostModel touching() {
  return {.kernel = {{1000, 5e-8}, {4000, 6e-8}},
          .cores = 2,
          .contacts = 2e-6,
          .edge = 12,
          .depth = 4,
          .ghost = 3e-6,
          .latency = 2e-5};
}

TEST(DividedCost, IsItsOwnAloneAndHalfOfItWithoutGhosts) {
  CostModel model = touching();
  const double near = std::log(3.0) / std::log(4.0),
               element =
                   (1 - near) * 5e-8 + near * 6e-8 + 2e-6 * (1 - 12 / std::sqrt(3000.0));
  EXPECT_NEAR(model.cost(3000, 1), 3000 * elements * element,
              3000 * elements * element * 8 * eps);
  EXPECT_EQ(model.efficiency(3000, 1), 1);
  model.depth = model.latency = 0;
  model.kernel.resize(1);
  EXPECT_NEAR(model.cost(3000, 2), model.cost(3000, 1) / 2,
              4 * eps * model.cost(3000, 2));
  EXPECT_EQ(model.efficiency(3000, 2), 1);
}

/// Of ten times as many hairs, as dense, ghosts are sqrt(10) times as many; never more
/// than there are.
TEST(DividedCost, GhostsAreTheRimOfACut) {
  const CostModel model = touching();
  EXPECT_NEAR(model.ghosts(1e6, 16) / model.ghosts(1e5, 16), std::sqrt(10), 8 * eps);
  EXPECT_EQ(model.ghosts(1e6, 1), 0);
  EXPECT_EQ(model.ghosts(4, 4), 3);
}

/// As many hairs on each rank: regions with four neighbours have as many ghosts, however
/// many ranks there are, and only agreement takes longer.
TEST(DividedCost, GrowsByLatencyAloneWhereRanksHaveAsManyHairs) {
  CostModel model = touching();
  constexpr double own = 5000;
  model.edge = 0;
  const auto without = [&](double ranks) {
    return model.cost(own * ranks, ranks) - model.latency * std::log2(ranks);
  };
  EXPECT_NEAR(without(4096), without(16), 64 * eps * without(16));
  EXPECT_LT(without(4), without(16));  // two neighbours
  EXPECT_LT(without(2), without(4));
}

std::vector<Measurement> measured_by(const CostModel& model, bool touch) {
  std::vector<Measurement> all;
  for (const double strands : {1000.0, 4000.0}) {
    const auto add = [&](double ranks, double beside) {
      all.push_back({.touch = touch,
                     .strands = strands,
                     .ranks = ranks,
                     .beside = beside,
                     .cores = model.cores,
                     .cost = model.cost(strands, ranks, beside),
                     .ghosts = model.ghosts(strands, ranks)});
    };
    add(1, 1);
    add(1, 2);
    add(2, 1);
    add(4, 1);
  }
  return all;
}

/// Differences of costs of order one lose what of them is left over: the kernel's share
/// for contacts, latency's and ghosts' shares of a step.
TEST(DividedCost, IsFoundAgainInWhatItSays) {
  const CostModel want = touching();
  CostModel apart = want;
  apart.contacts = apart.edge = apart.depth = apart.ghost = 0;
  std::vector<Measurement> all = measured_by(apart, false);
  const auto more = measured_by(want, true);
  all.insert(all.end(), more.begin(), more.end());
  const auto found = fit_cost(all);
  ASSERT_TRUE(found);
  const CostModel& got = found->touching;
  const double step = want.cost(4000, 2);
  ASSERT_EQ(got.kernel.size(), want.kernel.size());
  for (std::size_t i = 0; i < want.kernel.size(); ++i) {
    EXPECT_EQ(got.kernel[i].strands, want.kernel[i].strands);
    EXPECT_NEAR(got.kernel[i].cost, want.kernel[i].cost, 8 * eps * want.kernel[i].cost);
  }
  // A line through two places whose distance is half of the farther one.
  EXPECT_NEAR(got.contacts, want.contacts, 64 * eps * want.contacts);
  EXPECT_NEAR(got.edge, want.edge, 64 * eps * want.edge);
  EXPECT_NEAR(got.depth, want.depth, 8 * eps * want.depth);
  EXPECT_NEAR(got.latency, want.latency, 32 * eps * apart.cost(4000, 2));
  EXPECT_NEAR(got.ghost, want.ghost, 64 * eps * step / (want.ghosts(1000, 2) * elements));
  EXPECT_EQ(found->apart.contacts, 0);
  EXPECT_EQ(found->apart.depth, 0);
}

TEST(DividedCost, NeedsAMeasurementForEachOfItsNumbers) {
  CostModel apart = touching();
  apart.contacts = apart.edge = apart.depth = apart.ghost = 0;
  std::vector<Measurement> all = measured_by(apart, false);
  const auto more = measured_by(touching(), true);
  all.insert(all.end(), more.begin(), more.end());
  for (const bool touch : {false, true}) {
    for (const auto& [ranks, beside] : {std::pair(1, 1), {2, 1}}) {
      std::vector<Measurement> some = all;
      std::erase_if(some, [&](const Measurement& m) {
        return m.touch == touch && m.ranks == ranks && m.beside == beside;
      });
      EXPECT_FALSE(fit_cost(some)) << touch << ranks << beside;
    }
  }
}

Row row(const char* kind, const Measurement& m) {
  Row one;
  one.set("kind", kind).set("effects", m.touch ? "interaction" : "drag");
  one.set("strands", static_cast<int>(m.strands)).set("ranks", static_cast<int>(m.ranks));
  one.set("status", "ok");
  if (std::string_view(kind) == "predicted") return one;
  one.set("beside", static_cast<int>(m.beside)).set("cores", 2);
  one.set("cost_per_step_s", m.cost);
  if (m.ghosts > 0) one.set("ghosts_per_strand", m.ghosts * m.ranks / m.strands);
  return one;
}

/// Ranks that take turns on two cores take twice what the model says of four.
TEST(DividedPredictions, MeetWhatSetThemAndGoOnFromThere) {
  const CostModel model = touching();
  CostModel apart = model;
  apart.contacts = apart.edge = apart.depth = apart.ghost = 0;
  std::vector<Row> rows;
  for (const auto& m : measured_by(apart, false)) rows.push_back(row("measured", m));
  for (Measurement m : measured_by(model, true)) {
    if (m.ranks == 4) m.cost *= 2;
    rows.push_back(row("measured", m));
  }
  rows.push_back(
      row("predicted", {.touch = true, .strands = 1e6, .ranks = 256, .cost = 0}));
  std::vector<Row> without(rows.end() - 1, rows.end());
  add_predictions(without);
  EXPECT_FALSE(without.front().has("model_cost_per_step_s"));
  add_predictions(rows);
  // Of rows, numbers are read from 17 digits of text.
  for (const Row& one : rows) {
    if (one.text("kind") == "predicted" || one.text("effects") == "drag") continue;
    EXPECT_NEAR(one.number("model_off_rel"), 0, 1e3 * eps) << describe(one);
  }
  EXPECT_NEAR(rows.back().number("model_cost_per_step_s"), model.cost(1e6, 256),
              1e3 * eps * model.cost(1e6, 256));
  EXPECT_NEAR(rows.back().number("efficiency"), model.efficiency(1e6, 256), 1e3 * eps);
}

/// Where a hair costs the same whatever their number, one number of hairs says what
/// others take; a kernel that is half as much again at one of them is not foreseen there.
TEST(DividedPredictions, ForeseeHeadsOfOtherNumbers) {
  CostModel model = touching();
  model.kernel.resize(1);
  model.edge = 0;
  CostModel apart = model;
  apart.contacts = apart.depth = apart.ghost = 0;
  for (const bool alike : {true, false}) {
    std::vector<Row> rows;
    for (Measurement m : measured_by(apart, false)) {
      if (!alike && m.strands == 4000) m.cost *= 1.5;
      rows.push_back(row("measured", m));
    }
    for (const auto& m : measured_by(model, true)) rows.push_back(row("measured", m));
    add_predictions(rows);
    for (const Row& one : rows) {
      if (one.text("effects") == "interaction" || one.number("ranks") > 2) continue;
      const double off = one.number("held_out_off_rel");
      if (alike) {
        EXPECT_NEAR(off, 0, 1e3 * eps) << describe(one);
      } else if (one.number("strands") == 4000) {
        EXPECT_NEAR(off, 1 / 1.5 - 1, 0.01) << describe(one);
      }
    }
  }
}

/// The cap's area by its angle on a sphere of 0.1 m: 2 pi r^2 (1 - cos angle). The cosine
/// of a small angle leaves few digits of that: as many as eps over its share of the
/// sphere.
TEST(DividedScene, IsAsDenseWhateverItsNumberOfHairs) {
  for (const int strands : {1000, 4000, 100000}) {
    const double area = 2 * std::numbers::pi * 0.01 * (1 - std::cos(cap_angle(strands)));
    EXPECT_NEAR(strands / area, hair_density,
                8 * eps * hair_density * (4 * std::numbers::pi * 0.01 / area));
  }
}

TEST(DividedRuns, HaveAFolderThatNobodyElseCanReadOrForesee) {
  std::filesystem::path first;
  {
    const PrivateFolder one, other;
    first = one.path();
    EXPECT_NE(first, other.path());
    struct stat status {};
    ASSERT_EQ(::stat(first.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0700U);
  }
  EXPECT_FALSE(std::filesystem::exists(first));
}

TEST(DividedRuns, TakeEveryWordAsItIs) {
  const PrivateFolder folder;
  const std::string log = folder.path() / "log";
  const std::vector<std::string> words{"printf", "%s\n", "it's", "$(touch x)",
                                       "a b; exit"};
  EXPECT_TRUE(Launched(words, log).succeeds());
  EXPECT_EQ(read_file(log), "it's\n$(touch x)\na b; exit\n");
  EXPECT_FALSE(Launched({"false"}, log).succeeds());
  EXPECT_THROW(Launched({"no such program"}, log), std::system_error);
  // Somebody else's link in its place is not followed.
  const std::string victim = folder.path() / "victim", link = folder.path() / "link";
  std::filesystem::create_symlink(victim, link);
  EXPECT_THROW(Launched({"true"}, link), std::system_error);
  EXPECT_FALSE(std::filesystem::exists(victim));
}

}  // namespace tress::test_divided_heads
