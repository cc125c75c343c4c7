// Every strand model with every integrator and effect as one batch, and strand by strand.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "models/effects/catalogue.h"
#include "simulation/head/batch_matrix.h"
#include "simulation/head/head_run.h"
#include "simulation/run/world.h"
#include "tests/contracts/batch_runs.h"
#include "tests/support/thread_ranks.h"

namespace tress::simulation {
namespace {

using namespace testing_support;
using Way = BatchCase::Way;

constexpr double trapped = 10;  // m along y: no strand elsewhere is there

/// An effect of a plug-in: the load is no number on strands that are far along y, from
/// the middle of a run on.
class Trap final : public models::Effect {
 public:
  std::string_view name() const override { return "trap"; }
  models::Needs needs() const override { return {.position = true}; }
  void add_load(double t, const models::Points& p, InOut f) const noexcept override {
    if (t < 0.009 || p.x[1] < trapped / 2) return;
    std::ranges::fill(f, std::numeric_limits<double>::quiet_NaN());
  }
  void add_derivatives(double, const models::Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const models::Points&) const noexcept override { return 0; }
  double power(double, const models::Points&) const noexcept override { return 0; }
};

const bool trap_is_added = [] {
  models::add_effect(
      {"trap",
       "no number",
       "this test",
       {},
       [](const Parameters&, const models::RootMotion&)
           -> std::unique_ptr<const models::Effect> { return std::make_unique<Trap>(); }},
      "this test");
  return true;
}();

/// Runs it both ways.
void expect_the_same(const BatchCase& one) {
  const std::string text = "failed_strands = \"stay\"\n" + one.scene;
  const SceneOutline outline = parse_outline(text, "batch.toml");
  const Scene scene = parse_scene(text, "batch.toml");
  const auto run = batch(outline);
  EXPECT_EQ(run->lanes(), one.way == Way::lanes);
  const Course strands = of_strands(scene), together = of_batch(*run, scene);
  EXPECT_EQ(together.lost, strands.lost);
  ASSERT_EQ(together.frames.size(), strands.frames.size());
  if (one.way == Way::replicated && scene.interaction() == nullptr) {
    EXPECT_EQ(together.frames, strands.frames);
    return;
  }
  // Lanes: Newton's iterations end at 1e-10 of the typical coordinates, here a strand of
  // 10 cm; times of steps with exchanges differ by their rounding.
  EXPECT_LT(apart(together, strands), 1e-9 * 0.1);
}

class Batches : public testing::TestWithParam<const ModelEntry*> {};

TEST_P(Batches, AreTheSameAsStrandsWithEveryIntegrator) {
  int replicated = 0;
  for (const IntegratorEntry& integrator : integrator_catalogue()) {
    const BatchCase one = batch_case(*GetParam(), integrator, "[effects.gravity]\n");
    if (one.way == Way::none) continue;
    SCOPED_TRACE(fmt::format("{} {}: {}", GetParam()->id, integrator.id, one.reason));
    ASSERT_NE(one.way, Way::refused);
    replicated += one.way == Way::replicated ? 1 : 0;
    expect_the_same(one);
  }
  EXPECT_GT(replicated, 8);
}

/// Reasons of physics: strands that are one system.
bool is_one_system(std::string_view effect) {
  return effect == "strand_friction" || effect == "control_mesh";
}

TEST_P(Batches, AreTheSameAsStrandsWithEveryEffect) {
  const IntegratorEntry& integrator = find_integrator(
      GetParam()->id == "xpbd_cosserat" ? "xpbd" : "linearly_implicit_euler");
  for (const models::EffectEntry& effect : models::effects()) {
    std::string table = fmt::format("[effects.{}]\n", effect.id);
    if (effect.id == "strand_interaction") table += "coupling = \"lagged\"\n";
    const BatchCase one =
        batch_case(*GetParam(), integrator, "[effects.gravity]\n" + table);
    SCOPED_TRACE(fmt::format("{} {}: {}", GetParam()->id, effect.id, one.reason));
    if (one.way == Way::none) continue;
    EXPECT_EQ(one.way == Way::refused, is_one_system(effect.id));
    if (one.way != Way::refused && effect.id != "strand_interaction")
      expect_the_same(one);
  }
}

std::vector<const ModelEntry*> strand_models() {
  std::vector<const ModelEntry*> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand != nullptr) all.push_back(&model);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Models, Batches, testing::ValuesIn(strand_models()),
                         [](const auto& of) { return std::string(of.param->id); });

/// 64 strands, of which every fifth is in the trap. `only`: that strand alone, in the
/// same place.
std::string partly_failing(std::string_view model, std::string_view method, int only) {
  std::string text = fmt::format(
      "title = \"some fail\"\nduration_s = 0.02\nframes_per_s = 200\nfailed_strands = "
      "\"stay\"\n[model]\nid = \"{}\"\n[integrator]\nid = \"{}\"\ndt_s = 0.0025\n"
      "[material]\nname = \"hair.caucasian\"\n[effects.gravity]\n[effects.trap]\n",
      model, method);
  for (int k = 0; k < 64; ++k) {
    if (only >= 0 && k != only) continue;
    text += fmt::format(
        "[[strand]]\nposition_m = [0, {:.3f}, 0]\nlength_m = {}\nelements = 3\n",
        k % 5 == 2 ? trapped : 0.01 * k, 0.05 + 1e-4 * k);
  }
  return text;
}

class FailingStrands
    : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

// Where some strands fail, the others end with the same bits as alone.
TEST_P(FailingStrands, LeaveTheOthersAlone) {
  const auto& [model, method] = GetParam();
  const std::string all = partly_failing(model, method, -1);
  const SceneOutline outline = parse_outline(all, "batch.toml");
  ASSERT_TRUE(no_lanes(outline.scene));
  const auto run = batch(outline, 2);
  const Course together = of_batch(*run, outline.scene);
  ASSERT_EQ(together.lost.size(), 13U);
  const Course strands = of_strands(parse_scene(all, "batch.toml"));
  EXPECT_EQ(together.lost, strands.lost);
  EXPECT_EQ(together.frames, strands.frames);
  for (const int k : {0, 1, 3, 31, 63}) {
    const auto one = batch(parse_outline(partly_failing(model, method, k), "one.toml"));
    const Course alone = of_batch(*one, outline.scene);
    for (std::size_t f = 0; f < alone.frames.size(); ++f) {
      const std::vector<double>& x = together.frames[f];
      const auto begin = x.begin() + 12 * k;
      EXPECT_EQ(alone.frames[f], std::vector<double>(begin, begin + 12)) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Batches, FailingStrands,
    testing::Combine(testing::Values("super_clothoid", "der", "corde", "kirchhoff_nodal",
                                     "lifted_curls", "force_transport"),
                     testing::Values("linearly_implicit_euler", "backward_euler", "bdf2",
                                     "newmark")),
    [](const auto& of) {
      return fmt::format("{}_{}", std::get<0>(of.param), std::get<1>(of.param));
    });

// A world that recalls which strands have failed goes on as the one that saw it.
TEST(FailedStrands, StayInASnapshot) {
  const Scene scene = parse_scene(partly_failing("der", "bdf2", -1), "world.toml");
  World first(scene), second(scene);
  ASSERT_EQ(first.advance(0.015), Status::ok);
  ASSERT_EQ(first.lost().size(), 13U);
  EXPECT_THAT(first.lost().front().reason, testing::HasSubstr("not finite: trap"));
  const Snapshot half = first.snapshot();
  for (World* world : {&first, &second}) {
    world->restore(half);
    ASSERT_EQ(world->advance(0.02), Status::ok);
  }
  EXPECT_EQ(second.positions(), first.positions());
  EXPECT_EQ(second.lost().size(), 13U);
  EXPECT_EQ(second.velocities(), first.velocities());
}

TEST(FailedStrands, EndTheRunByDefault) {
  const std::string text = partly_failing("der", "backward_euler", -1);
  Scene scene = parse_scene(text, "world.toml");
  scene.failed_strands = FailedStrands::end_run;
  World world(scene);
  EXPECT_NE(world.advance(0.02), Status::ok);
  EXPECT_THAT(world.failure(), testing::HasSubstr("strand 2: "));
}

TEST(FailedStrands, AreRefusedWhereStrandsAreOneSystem) {
  const std::string text = partly_failing("der", "linearly_implicit_euler", -1);
  for (const auto& [table, why] :
       {std::pair{"[effects.strand_interaction]\ncoupling = \"monolithic\"\n",
                  "strands that are one system"},
        std::pair{"[effects.strand_friction]\n", "contacts are solved together"}}) {
    try {
      static_cast<void>(parse_scene(text + table, "world.toml"));
      ADD_FAILURE() << table;
    } catch (const InputError& no) {
      EXPECT_THAT(no.what(), testing::HasSubstr(why));
      EXPECT_THAT(no.what(), testing::HasSubstr("world.toml:4:"));
    }
  }
}

constexpr const char* rubbing =
    "title = \"b\"\nduration_s = 0.03\nframes_per_s = 100\n[model]\nid = \"der\"\n"
    "[integrator]\nid = \"backward_euler\"\ndt_s = 0.002\n[groom]\ncount = 7\n"
    "length_m = 0.06\nelements = 4\n[root]\nmotion = \"rotate\"\n[effects.gravity]\n"
    "[effects.strand_interaction]\ncoupling = \"lagged\"\n[[effects.body]]\n"
    "shape = \"sphere\"\nradius_m = 0.1\nfriction_law = \"exact\"\n";

std::vector<double> kept_of(HeadRun& run) {
  std::vector<double> all;
  run.by_chunks(run.strands(), [&](HeadRun::Numbers strands) { run.keep(strands, all); });
  return all;
}

// What is kept of replicated systems, contact forces and the guard's account included, is
// all that the rest of a run depends on.
TEST(ReplicatedHead, GoesOnWhereItWas) {
  const SceneOutline outline = parse_outline(rubbing, "batch.toml");
  const auto first = batch(outline), second = batch(outline);
  step_to(*first, outline.scene, 1);
  step_to(*first, outline.scene, 2);
  std::vector<double> half = kept_of(*first);
  for (HeadRun* run : {first.get(), second.get()}) {
    run->by_chunks(run->strands(),
                   [&](HeadRun::Numbers strands) { run->recall(strands, half); });
  }
  EXPECT_EQ(kept_of(*second), kept_of(*first));
  for (HeadRun* run : {first.get(), second.get()}) step_to(*run, outline.scene, 3);
  EXPECT_EQ(kept_of(*second), kept_of(*first));
  EXPECT_NE(kept_of(*first), half);
}

// Strands that touch see those of other ranks too.
TEST(ReplicatedHead, IsTheSameBitsForAnyNumberOfRanksAndThreads) {
  const SceneOutline outline = parse_outline(rubbing, "batch.toml");
  const auto whole = batch(outline);
  step_to(*whole, outline.scene, 1);
  const std::size_t want = whole->hash();
  const auto threaded = batch(outline, 3);
  step_to(*threaded, outline.scene, 1);
  EXPECT_EQ(threaded->hash(), want);
  for (const int size : {2, 3}) {
    std::optional<std::size_t> hash;
    testing_support::ThreadRanks::run(size, [&](Ranks& ranks) {
      HeadRun run(make_head(outline, {models::HeadNumber::float64, 4}, 1, ranks), 1,
                  ranks);
      step_to(run, outline.scene, 1);
      const std::size_t found = run.hash();
      if (ranks.first()) hash = found;
    });
    EXPECT_EQ(hash, want) << size;
  }
}

TEST(ReplicatedHead, HoldsStrandsAtRestAsAWorldDoes) {
  const std::string text =
      "title = \"b\"\nduration_s = 0.02\nframes_per_s = 100\nrest = \"inverse\"\n"
      "failed_strands = \"stay\"\n[model]\nid = \"der\"\n[integrator]\n"
      "id = \"backward_euler\"\ndt_s = 0.005\n[groom]\ncount = 3\nlength_m = 0.05\n"
      "elements = 4\n[effects.gravity]\n";
  const SceneOutline outline = parse_outline(text, "batch.toml");
  const auto run = batch(outline);
  const Scene scene = parse_scene(text, "batch.toml");
  const Course strands = of_strands(scene), together = of_batch(*run, scene);
  EXPECT_EQ(together.frames, strands.frames);
  EXPECT_TRUE(together.lost.empty());
}

/// As a batch and as strands: the same frames, and no strand fails.
void expect_a_batch_as_a_world(const std::string& text) {
  const auto run = batch(parse_outline(text, "batch.toml"));
  const Scene scene = parse_scene(text, "batch.toml");
  const Course strands = of_strands(scene), together = of_batch(*run, scene);
  EXPECT_EQ(together.frames, strands.frames);
  EXPECT_TRUE(together.lost.empty());
  EXPECT_TRUE(strands.lost.empty());
}

TEST(ReplicatedHead, HoldsStrandsBySupportsAsAWorldDoes) {
  for (const std::string model : {"super_helix", "der"}) {
    const std::string text =
        "title = \"b\"\nduration_s = 0.02\nframes_per_s = 100\n"
        "failed_strands = \"stay\"\n[model]\nid = \"" +
        model +
        "\"\n[integrator]\nid = \"backward_euler\"\ndt_s = 0.005\n"
        "[strand]\nlength_m = 0.05\nelements = 6\n[groom]\ncount = 2\nlength_m = 0.05\n"
        "elements = 6\n[effects.gravity]\n[[supports]]\nat = 0.5\n"
        "keyframes = [[0, 0.02, 0, 0.01]]\n[[supports]]\nstrand = 2\n"
        "kind = \"direction\"\n";
    SCOPED_TRACE(model);
    expect_a_batch_as_a_world(text);
  }
}

TEST(ReplicatedHead, TakesRotationVectorsThatLanesDoNotHave) {
  // A support holds the section of the tip, which turns with a rotation vector.
  for (const std::string support : {"", "[[supports]]\nkind = \"clamp\"\n"}) {
    const auto text = [&](const std::string& coordinates) {
      return "title = \"b\"\nduration_s = 0.02\nframes_per_s = 100\n"
             "failed_strands = \"stay\"\n[model]\nid = \"corde\"\n" +
             coordinates +
             "[integrator]\nid = \"backward_euler\"\ndt_s = 0.005\n[groom]\n"
             "count = 3\nlength_m = 0.05\nelements = 4\n[effects.gravity]\n" +
             support;
    };
    SCOPED_TRACE(support);
    const std::string vectors = text("coordinates = \"rotation_vector\"\n");
    const SceneOutline outline = parse_outline(vectors, "batch.toml");
    if (support.empty()) {
      EXPECT_THAT(no_lanes(outline.scene).value().reason,
                  testing::HasSubstr("coordinates = \"rotation_vector\""));
    }
    const auto run = batch(outline);
    EXPECT_FALSE(run->lanes());
    const Scene scene = parse_scene(vectors, "batch.toml");
    const Course strands = of_strands(scene), together = of_batch(*run, scene);
    EXPECT_EQ(together.frames, strands.frames);
    EXPECT_TRUE(strands.lost.empty());
    // A stiff penalty softens joints by 2 (u l)^2/norm, u l < 1 here.
    const Course stiff = of_strands(parse_scene(text("norm = 1e6\n"), "batch.toml"));
    EXPECT_LT(apart(strands, stiff), 2e-6 * 0.05);
    EXPECT_GT(apart(strands, stiff), 0);
  }
}

TEST(ReplicatedHead, DrivesStrandsAsAWorldDoes) {
  for (const std::string model : {"super_helix", "der"}) {
    const std::string text =
        "title = \"b\"\nduration_s = 0.02\nframes_per_s = 100\n"
        "failed_strands = \"stay\"\n[model]\nid = \"" +
        model +
        "\"\n[integrator]\nid = \"backward_euler\"\ndt_s = 0.005\n"
        "[groom]\ncount = 3\nlength_m = 0.05\nelements = 6\n[effects.gravity]\n"
        "[[effects.point_moment]]\nfollower_n_m = [1e-9, 1e-9, 0]\n"
        "[[effects.natural_shape]]\ncurvature_per_m = [[0, 0], [0.02, 20]]\n"
        "[[supports]]\nstrand = 1\nstiffness_n_per_m = 1e-3\n";
    SCOPED_TRACE(model);
    expect_a_batch_as_a_world(text);
  }
}

TEST(BatchMatrix, PrintsEveryCellAndItsReason) {
  const std::string text = batch_matrix();
  for (const ModelEntry* model : strand_models()) {
    EXPECT_THAT(text, testing::HasSubstr(std::string(model->id)));
  }
  EXPECT_THAT(text, testing::HasSubstr("no SIMD lanes for der"));
  EXPECT_THAT(text, testing::HasSubstr("strand_friction] solves the contacts"));
  EXPECT_THAT(text, testing::HasSubstr("monolithic coupling are one system"));
}

}  // namespace
}  // namespace tress::simulation
