// Guides of a groom: which, and what the others do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include "contract/input_error.h"
#include "simulation/export/full_hair.h"
#include "simulation/groom/guide_choice.h"
#include "simulation/run/readout.h"

namespace tress::test_guide_choice {

using namespace simulation;

Scene head(int count, int guides, int seed = 1) {
  return parse_scene("title = \"t\"\nduration_s = 0.1\nseed = " + std::to_string(seed) +
                         "\n[groom]\nelements = 6\ncount = " + std::to_string(count) +
                         "\nguides = " + std::to_string(guides) +
                         "\n[effects.gravity]\n[root]\nmotion = \"shake\"\n",
                     "t.toml");
}

TEST(GuideChoice, IsTheSameForTheSameSeedAscendingAndWithoutRepetition) {
  const std::vector<Strand> all = head(200, 0).strands;
  const auto chosen = choose_guides(all, 30, 4);
  EXPECT_EQ(chosen, choose_guides(all, 30, 4));
  std::set<std::vector<std::size_t>> others;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    others.insert(choose_guides(all, 30, seed));
  }
  EXPECT_GT(others.size(), 3U);
  EXPECT_EQ(chosen.size(), 30U);
  EXPECT_TRUE(std::ranges::is_sorted(chosen, std::ranges::less_equal{}));
  EXPECT_LT(chosen.back(), all.size());
  std::vector<std::size_t> every(all.size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  EXPECT_EQ(choose_guides(all, 200, 4), every);
  EXPECT_EQ(spread_about(all, every), 0);
}

/// Of clusters far from each other each gets its guide.
TEST(GuideChoice, EveryLockGetsAGuide) {
  std::vector<Strand> all;
  for (int i = 0; i < 60; ++i) {
    all.push_back(head(60, 0).strands[static_cast<std::size_t>(i)]);
    all.back().root.position = Vec{0.5 * (i % 6), 1e-3 * (i / 6), 0};
  }
  const auto chosen = choose_guides(all, 6, 1);
  std::vector<int> locks;
  for (const std::size_t i : chosen) locks.push_back(static_cast<int>(i % 6));
  EXPECT_THAT(locks, testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5));
}

/// On a head more guides are nearer, and nearer than as many drawn at random.
TEST(GuideChoice, IsNearerThanADraw) {
  const std::vector<Strand> all = head(300, 0).strands;
  std::vector<std::size_t> drawn(all.size());
  std::iota(drawn.begin(), drawn.end(), std::size_t{0});
  std::mt19937 random(2);
  double before = 1;
  for (const std::size_t guides : {10U, 30U, 100U}) {
    const double chosen = spread_about(all, choose_guides(all, guides, 1));
    EXPECT_LT(chosen, before);
    before = chosen;
    for (int draw = 0; draw < 5; ++draw) {
      std::shuffle(drawn.begin(), drawn.end(), random);
      EXPECT_LT(chosen, 0.9 * spread_about(all, std::span(drawn).first(guides)))
          << guides;
    }
  }
}

/// Those that are simulated and those that follow are the strands of the groom; at the
/// start each is where it belongs, and afterwards its root is on the head.
TEST(GroomWithGuides, AllStrandsAreThereAndStartAsThemselves) {
  const Scene whole = head(80, 0), scene = head(80, 25);
  EXPECT_EQ(scene.strands.size(), 25U);
  EXPECT_EQ(scene.followers.size(), 55U);
  World world(scene);
  Readout readout(scene, world);
  const FullHair hair(scene, readout.lines(), 0);
  EXPECT_EQ(hair.hairs(), 55U);
  const auto frame = [&] {
    const std::vector<Frame3d> read{readout.read(world)};
    return hair.frames(read).front().positions;
  };
  const auto at = [](const std::vector<float>& x, std::size_t i) {
    return Vec{x[3 * i], x[3 * i + 1], x[3 * i + 2]};
  };
  const std::vector<float> start = frame();
  ASSERT_EQ(start.size(), 3U * 80 * 7);
  for (std::size_t h = 0; h < 55; ++h) {
    const std::vector<Vec> own = initial_points(scene.followers[h]);
    // In single precision, places of 0.3 m.
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_LT(norm(at(start, 7 * (25 + h) + i) - own[i]), 1e-7);
    }
  }
  ASSERT_EQ(world.advance(0.1), Status::ok) << world.failure();
  const std::vector<float> later = frame();
  double moved = 0;
  for (std::size_t h = 0; h < 55; ++h) {
    const Vec root = scene.followers[h].root.at(0.1).x;
    EXPECT_LT(norm(at(later, 7 * (25 + h)) - root), 1e-7);
    moved =
        std::max(moved, norm(at(later, 7 * (25 + h) + 6) - at(start, 7 * (25 + h) + 6)));
  }
  EXPECT_GT(moved, 1e-3);
}

TEST(GroomWithGuides, OneGuideIsEnough) {
  const Scene scene = head(10, 1);
  World world(scene);
  const Readout readout(scene, world);
  EXPECT_EQ(FullHair(scene, readout.lines(), 0).hairs(), 9U);
}

TEST(GroomWithGuides, IsRefusedWhereItMakesNoSense) {
  EXPECT_THROW(head(10, 11), InputError);
  EXPECT_EQ(head(10, 10).followers.size(), 0U);
  const Scene scene = head(20, 5);
  World world(scene);
  const Readout readout(scene, world);
  EXPECT_THROW(FullHair(scene, readout.lines(), 3), InputError);
}

}  // namespace tress::test_guide_choice
