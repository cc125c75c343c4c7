// A batch keeps the account of its method's dissipation as its strands do by themselves,
// or prints why it has none.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "tests/contracts/batch_runs.h"

namespace tress::test_batch_dissipation {

using namespace testing_support;

/// What a batch of this model and its strands one by one print of their method's energy.
struct Accounts {
  std::unique_ptr<HeadRun> batch;
  std::unique_ptr<World> strands;
};

Accounts accounts(const std::string& model, const std::string& method,
                  const std::string& rest = "") {
  const std::string text =
      "title = \"b\"\nduration_s = 0.06\nframes_per_s = 50\n" + rest +
      "[model]\nid = \"" + model + "\"\n[integrator]\nid = \"" + method +
      "\"\ndt_s = 0.001\n[groom]\ncount = 5\nlength_variation = 0.5\n"
      "length_m = 0.05\nelements = 4\n[root]\nmotion = \"shake\"\n"
      "[effects.gravity]\n[effects.linear_drag]\n";
  const SceneOutline outline = parse_outline(text, "batch.toml");
  const Scene scene = parse_scene(text, "batch.toml");
  Accounts made{batch(outline, 2), std::make_unique<World>(scene)};
  of_batch(*made.batch, scene);
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    EXPECT_EQ(made.strands->advance(scene.time_of(frame)), Status::ok);
  }
  return made;
}

class DissipationOfBatches : public testing::TestWithParam<const char*> {};

// Systems of their own take the same steps, and are judged after the same ones.
TEST_P(DissipationOfBatches, IsTheSumOverItsStrands) {
  for (const char* const method : {"backward_euler", "bdf2", "newmark"}) {
    const Accounts of = accounts(GetParam(), method);
    ASSERT_FALSE(of.batch->lanes()) << method;
    const auto together = of.batch->dissipation(), strands = of.strands->dissipation();
    ASSERT_TRUE(together && strands) << of.batch->no_dissipation();
    EXPECT_EQ(of.batch->no_dissipation(), "");
    EXPECT_GT(std::abs(strands->dissipated), 0);
    EXPECT_DOUBLE_EQ(together->dissipated, strands->dissipated) << method;
    EXPECT_DOUBLE_EQ(together->uncertain, strands->uncertain);
    EXPECT_DOUBLE_EQ(together->available, strands->available);
    EXPECT_DOUBLE_EQ(together->moved, strands->moved);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, DissipationOfBatches,
                         testing::Values("kirchhoff_nodal", "force_transport",
                                         "lifted_curls"),
                         [](const auto& of) { return std::string(of.param); });

// Lanes refuse; strands by themselves keep the account that the reason names.
TEST(DissipationOfLanes, IsRefusedWithAReason) {
  for (const char* const model : {"super_helix", "mass_spring", "der", "corde"}) {
    const Accounts of = accounts(model, "backward_euler");
    ASSERT_TRUE(of.batch->lanes()) << model;
    EXPECT_FALSE(of.batch->dissipation());
    EXPECT_THAT(of.batch->no_dissipation(), testing::HasSubstr("give --as strands"));
    EXPECT_TRUE(of.strands->dissipation());
    EXPECT_EQ(of.strands->no_dissipation(), "");
  }
}

TEST(DissipationOfBatches, IsRefusedForTheSameReasonsAsOfStrands) {
  for (const auto& [rest, reason] :
       {std::pair{"guard = false\n", "without a guard"},
        std::pair{"[[effects.body]]\nshape = \"plane\"\ncentre_m = [0, 0, -1]\n"
                  "friction_law = \"exact\"\n",
                  "impulses of exact contact"},
        std::pair{"[effects.strand_interaction]\ncoupling = \"lagged\"\n",
                  "strands that touch"}}) {
    const Accounts of = accounts("lifted_curls", "backward_euler", rest);
    EXPECT_FALSE(of.batch->dissipation()) << reason;
    EXPECT_THAT(of.batch->no_dissipation(), testing::HasSubstr(reason));
    EXPECT_EQ(of.strands->no_dissipation(), of.batch->no_dissipation());
  }
}

}  // namespace tress::test_batch_dissipation
