#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_measure.h"
#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/numerics/tip_track.h"
#include "simulation/scene_changes/typical_strands.h"
#include "tests/cost_of_accuracy/scratch.h"

namespace tress::test_scene_reference {

using namespace experiments;
using namespace experiments::cost_of_accuracy;

const char* const sagging = R"(
title = "a hair sags"
duration_s = 0.2
[model]
id = "der"
[strand]
elements = 5
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 5e-5
)";

constexpr ReferenceCut coarse{8, 4};

/// Nothing that any run gives, with digits to lose.
SceneReference invented(std::size_t frames) {
  SceneReference made;
  made.frames = frames;
  for (std::size_t i = 0; i < 3 * (frames + 1); ++i) {
    made.tips.tip.push_back(1.0 / (static_cast<double>(i) + 3));
    made.tips.other.push_back(1.0 / (static_cast<double>(i) + 3.000001));
  }
  made.tips.gap = 1.0 / 3;
  return made;
}

struct Kept {
  Scratch folder;
  Scene given = read_open_scene(folder.write("scene.toml", sagging));
  Comparison compare = comparison(given, 60, 0.5, 1);
  std::string key = reference_key(given, compare, coarse);

  void save(const SceneReference& reference) const {
    save_reference(folder.folder(), "scene", key, reference, compare, coarse);
  }
};

TEST(SceneReference, ComesBackToTheLastBit) {
  const Kept kept;
  const SceneReference made = invented(kept.compare.frames);
  kept.save(made);
  const auto back = load_reference(kept.folder.folder(), "scene", kept.key);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->frames, made.frames);
  EXPECT_EQ(back->tips.tip, made.tips.tip);
  EXPECT_EQ(back->tips.other, made.tips.other);
  EXPECT_EQ(back->tips.gap, made.tips.gap);
}

TEST(SceneReference, IsNotComputedTwice) {
  const Kept kept;
  const SceneReference made = invented(kept.compare.frames);
  kept.save(made);
  EXPECT_EQ(
      kept_reference(kept.given, kept.compare, coarse, kept.folder.folder(), "scene")
          .tips.tip,
      made.tips.tip);
}

TEST(SceneReference, OfAnotherSceneIsComputedAnew) {
  const Kept kept;
  kept.save(invented(kept.compare.frames));
  std::string heavier = sagging;
  heavier.replace(heavier.find("5e-5"), 4, "6e-5");
  const Scene other = read_open_scene(kept.folder.write("other.toml", heavier));
  const SceneReference fresh =
      kept_reference(other, kept.compare, coarse, kept.folder.folder(), "scene");
  EXPECT_NE(fresh.tips.tip, invented(kept.compare.frames).tips.tip);
  EXPECT_LT(fresh.tips.gap, 0.1);
  // It has taken the place of the old one.
  EXPECT_FALSE(load_reference(kept.folder.folder(), "scene", kept.key));
  EXPECT_TRUE(load_reference(kept.folder.folder(), "scene",
                             reference_key(other, kept.compare, coarse)));
}

TEST(SceneReference, KeyDependsOnTheComparisonAndTheCut) {
  const Kept kept;
  Comparison longer = kept.compare;
  ++longer.frames;
  EXPECT_NE(reference_key(kept.given, longer, coarse), kept.key);
  EXPECT_NE(reference_key(kept.given, kept.compare, coarse.refined()), kept.key);
}

TEST(SceneReference, DamagedOrMissingIsNone) {
  const Kept kept;
  EXPECT_FALSE(load_reference(kept.folder.folder(), "scene", kept.key));
  kept.save(invented(kept.compare.frames));
  const std::string meta = kept.folder.path("scene.meta.json");
  kept.folder.write("scene.csv", "t_s,strand\n0,0\n");
  EXPECT_FALSE(load_reference(kept.folder.folder(), "scene", kept.key));
  kept.save(invented(kept.compare.frames));
  EXPECT_TRUE(load_reference(kept.folder.folder(), "scene", kept.key));
  kept.folder.write("scene.meta.json", "{\"key\": ");
  EXPECT_FALSE(load_reference(kept.folder.folder(), "scene", kept.key));
}

// Orders 2 in step and element, both extrapolated: what is left falls at least as they
// do, by four, when both are halved.
TEST(SceneReference, ModelsAgreeBetterWhenRefined) {
  const Kept kept;
  const SceneReference first = scene_reference(kept.given, kept.compare, {16, 16});
  const SceneReference second =
      scene_reference(kept.given, kept.compare, ReferenceCut{16, 16}.refined());
  EXPECT_LT(second.tips.gap, first.tips.gap / 4);
  EXPECT_LT(second.tips.gap, 1e-3);
}

Scene lasting(const Scratch& folder, double seconds) {
  std::string text = sagging;
  text.replace(text.find("0.2"), 3, fmt::format("{}", seconds));
  return read_open_scene(folder.write("lasting.toml", text));
}

TEST(Comparison, ReachesTheEndOfTheScene) {
  const Scratch folder;
  const Scene given = lasting(folder, 0.033);  // 1.98 frames
  const Comparison compare = comparison(given, 60, 0, 1);
  EXPECT_EQ(compare.frames, 2u);
  EXPECT_EQ(compare.horizon(), 0.033);
  EXPECT_EQ(compare.time_of(1), 1 / 60.0);
  const Scene run = compared(given, compare);
  EXPECT_EQ(run.last_frame(), compare.frames);
  EXPECT_EQ(run.time_of(compare.frames), 0.033);
  EXPECT_NE(reference_key(given, compare, coarse),
            reference_key(given, {.frames = 2, .length = compare.length}, coarse));
  // Part of a scene, as requested, and whole frames.
  EXPECT_EQ(comparison(lasting(folder, 0.2), 60, 0.033, 1).horizon(), 0.033);
  EXPECT_EQ(comparison(lasting(folder, 0.2), 60, 0, 1).frames, 12u);
  EXPECT_EQ(comparison(lasting(folder, 1.9), 1, 0, 1).horizon(), 1.9);
}

// One time of comparison would be the end alone.
TEST(Comparison, HasSeveralTimesWithinAFrame) {
  const Scratch folder;
  const Scene given = lasting(folder, 0.004);
  const Comparison compare = comparison(given, 60, 0, 1);
  EXPECT_EQ(compare.frames, 4u);
  EXPECT_EQ(compare.rate, 1000);
  EXPECT_EQ(compare.horizon(), 0.004);
  EXPECT_EQ(compared(given, compare).last_frame(), 4u);
}

// Tips that are exact at t = 0 and 1 off from there on have the error 1 / length.
TEST(Comparison, LeavesOutTheStart) {
  const Comparison compare{.frames = 2, .strands = 2, .length = 4};
  std::vector<double> tip(18, 0.0);
  const std::vector<double> reference = tip;
  for (std::size_t i = 6; i < tip.size(); i += 3) tip[i] = 1;
  EXPECT_EQ(compared_error(tip, reference, compare), 0.25);
  tip.pop_back();
  EXPECT_EQ(compared_error(tip, reference, compare), never);
}

TEST(SceneReference, EndsWhereItsSidesPart) {
  Comparison compare{.rate = 10, .frames = 9, .strands = 1, .length = 1};
  SceneReference reference;
  reference.frames = 9;
  for (std::size_t frame = 0; frame <= 9; ++frame) {
    // They agree up to frame 5 and are 1 apart from there on.
    const double apart = frame > 5 ? 1 : 0;
    for (const double x : {1., 2., 3.}) {
      reference.tips.tip.push_back(x);
      reference.tips.other.push_back(x == 1. ? x + apart : x);
    }
  }
  EXPECT_EQ(agreed(reference, compare, 0.1).frames, 5u);
  EXPECT_EQ(agreed(reference, compare, 0.1).tips.gap, 0);
  EXPECT_EQ(agreed(reference, compare, 0.1).tips.tip.size(), 18u);
  // rms over frames 1 to 6: sqrt(1/6) = 0.41; over frames 1 to 7: 0.53.
  EXPECT_EQ(agreed(reference, compare, 0.42).frames, 6u);
  EXPECT_EQ(agreed(reference, compare, 1).frames, 9u);
  reference.tips.other[3] = 50;
  EXPECT_EQ(agreed(reference, compare, 0.1).frames, 1u);  // one at least
}

// Nine strands of a groom are alike, one is a curl, two are long: two typical ones are
// one of the nine and a long one, however strands are cut.
TEST(TypicalStrands, StandForTheGroom) {
  const auto groom = [](int elements) {
    std::vector<Strand> all;
    for (int i = 0; i < 12; ++i) {
      const double length = i > 9 ? 0.3 : 0.1 + 1e-4 * i;
      const Shape shape =
          i == 0 ? helix_shape(0.01, 0.02) : uniform_shape({0, 0.1 * i, 0});
      all.push_back(make_strand({}, {}, {elements, length, 1}, shape));
    }
    return all;
  };
  const std::vector<Strand> all = groom(8);
  const auto one = typical_strands(all, 1);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_GE(one.front(), 1u);
  EXPECT_LE(one.front(), 9u);
  const auto four = typical_strands(all, 4);
  ASSERT_EQ(four.size(), 4u);
  EXPECT_GE(four.back(), 10u);
  EXPECT_EQ(typical_strands(groom(20), 4), four);
  EXPECT_EQ(typical_strands(all, 99).size(), all.size());
  const std::vector<Strand> alike(5, all.front());
  EXPECT_EQ(typical_strands(alike, 2), (std::vector<std::size_t>{0, 2}));
}

const char* const elastic = R"(
title = "a hair sags"
duration_s = 0.2
[model]
id = "der"
[material]
name = "custom"
radius_m = 40e-6
youngs_modulus_pa = {}
poisson_ratio = 0.4
density_kg_m3 = 1300
internal_friction_kg_m3_s = 1e-10
[strand]
elements = 5
length_m = {}
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 5e-5
)";

// The change of a fine run stands for that of the rod: against a reference of a scene
// written with moduli and length 2 % up or down.
TEST(ChangedData, MoveTheTipAsTheRodItself) {
  Scratch folder;
  const auto with = [&](double factor) {
    return read_open_scene(folder.write(
        "s.toml", fmt::format(fmt::runtime(elastic), 3e9 * factor, 0.1 * factor)));
  };
  constexpr ReferenceCut cut{24, 16};
  const Scene scene = with(1);
  const Comparison compare = comparison(scene, 60, 0.2, 1);
  const SceneReference reference = scene_reference(scene, compare, cut);
  const ChangedTips moved =
      kept_changed_tips(scene, compare, reference, cut.halved(), folder.folder(), "s");
  const std::vector<double> up = scene_reference(with(1.02), compare, cut).tips.tip;
  const std::vector<double> down = scene_reference(with(0.98), compare, cut).tips.tip;
  // A move of about the change itself; of it the fine run is wrong by its own relative
  // error, of order (1/12)^2, times a few.
  EXPECT_GT(tip_error(up, reference.tips.tip, compare.length), 0.5 * data_change);
  EXPECT_GT(tip_error(down, reference.tips.tip, compare.length), 0.5 * data_change);
  constexpr double bound = 4 * data_change / (12 * 12);
  EXPECT_LT(tip_error(moved.up, up, compare.length), bound);
  EXPECT_LT(tip_error(moved.down, down, compare.length), bound);
  EXPECT_TRUE(load_reference(folder.folder(), "s.changed",
                             reference_key(scene, compare, cut.halved())));
}

}  // namespace tress::test_scene_reference
