#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "contract/input_error.h"
#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/cost_of_accuracy/trial_scene.h"
#include "simulation/scene_text/write_scene.h"
#include "tests/cost_of_accuracy/scratch.h"

namespace tress::test_trial_scene {

using namespace experiments;
using namespace experiments::cost_of_accuracy;
using experiments::cost_of_accuracy::Method;

const char* const curly = R"(
title = "curly # not a comment"
frames_per_s = 50
[model]
id = "mass_spring"
torsion = "altitude"
[integrator]
id = "backward_euler"
dt_s = 0.004
[material]
name = "hair.african"
[strand]
elements = 17
shape = "material"
[effects.gravity]
[[effects.body]]
shape = "sphere"
)";

TEST(TrialScene, HasTheChoiceAndNothingElseChanged) {
  const Scratch folder;
  const Scene given = read_open_scene(folder.write("curly.toml", curly));
  const Method method{{&find_model("super_helix"),
                       {{"modes", "bend"}, {"jacobian", "elastic"}},
                       "implicit_midpoint"}};
  const Scene scene = trial_scene(given, method, 9, 7, 60);
  EXPECT_EQ(scene.model->id, "super_helix");
  EXPECT_EQ(scene.model_options.word("modes"), "bend");
  EXPECT_EQ(scene.model_options.word("jacobian"), "elastic");
  EXPECT_EQ(scene.integrator, "implicit_midpoint");
  EXPECT_EQ(scene.options.step, 1.0 / (60 * 7));  // to the last bit
  EXPECT_EQ(scene.options.linear, LinearKind::automatic);
  EXPECT_EQ(scene.frame_rate, 60);
  ASSERT_EQ(scene.strands.size(), 1u);
  EXPECT_EQ(scene.strands.front().segments.size(), 9u);
  // A sum of 17 lengths, each rounded.
  EXPECT_NEAR(scene.strands.front().length(), given.strands.front().length(), 17e-17);
  EXPECT_EQ(scene.strands.front().segments.front().natural.x,
            given.strands.front().segments.front().natural.x);
  EXPECT_EQ(scene.effects.size(), given.effects.size());
  EXPECT_EQ(scene.title, given.title);
  EXPECT_EQ(scene.duration, given.duration);
}

TEST(TrialScene, ElementsShareWhatBendsTheStrandAtRest) {
  const Scratch folder;
  const std::string file = folder.write("curly.toml", curly);
  const Scene given = read_open_scene(file);
  Method method{{&find_model("super_helix"), {}, "implicit_midpoint"}};
  method.cut_at_rest = true;
  const auto& strand = trial_scene(given, method, 9, 7, 60).strands.front();
  ASSERT_EQ(strand.segments.size(), 9u);
  const auto [least, most] =
      std::ranges::minmax(strand.segments, {}, &models::Segment::length);
  EXPECT_GT(most.length, 1.2 * least.length);
  // A row says so, and so does the scene that is written.
  Row row;
  set_method(method, row);
  row.set("elements", 9).set("dt_s", 1.0 / 420);
  EXPECT_TRUE(configuration(row).method.cut_at_rest);
  EXPECT_EQ(configuration(row).accuracy.step, 1.0 / 420);
  EXPECT_NE(scene_text(trial_scene(given, method, 9, 7, 60)).find("mesh = \"rest\""),
            std::string::npos);
  // Cuts are no physics.
  std::string at_rest = curly;
  at_rest.replace(at_rest.find("elements = 17"), 13, "mesh = \"rest\"");
  const Scene cut = read_open_scene(folder.write("cut.toml", at_rest));
  const auto among = [](const Scene& scene, bool both) {
    const MethodChoice choice{.models = {"super_helix"},
                              .integrators = {"implicit_midpoint"},
                              .options = {"none"},
                              .cuts_at_rest = both};
    return methods(scene, choice).size();
  };
  EXPECT_EQ(among(given, true), 2 * among(given, false));
  EXPECT_EQ(among(cut, true), among(cut, false));
}

TEST(TrialScene, PhysicsDoesNotDependOnWhatIsChosen) {
  const Scratch folder;
  std::string other = curly;
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"mass_spring\"\ntorsion = \"altitude", "der"},
        {"backward_euler", "rk4"},
        {"elements = 17", "elements = 5"},
        {"[effects.gravity]", "# said otherwise\n\n[effects.gravity]"}}) {
    other.replace(other.find(from), from.size(), to);
  }
  const auto of = [&folder](const std::string& text) {
    return physics(read_open_scene(folder.write("scene.toml", text)));
  };
  EXPECT_EQ(of(curly), of(other));
  other.replace(other.find("african"), 7, "asian");
  EXPECT_NE(of(curly), of(other));
}

std::string ball(int distance) {
  std::string text = "4 4 4\n0 0 -1\n1\n";
  for (int i = 0; i < 64; ++i) text += std::to_string(distance) + "\n";
  return text;
}

// The same wherever the folder lies, another where the file has something else.
TEST(TrialScene, PhysicsDependsOnWhatNamedFilesHave) {
  const Scratch one, other;
  const auto of = [](const Scratch& folder, int distance) {
    folder.write("ball.txt", ball(distance));
    return physics(read_open_scene(
        folder.write("sdf.toml",
                     "title = \"sdf\"\n[strand]\n[effects.body]\nshape = \"sdf\"\n"
                     "sdf_file = \"ball.txt\"\n")));
  };
  const std::string first = of(one, 9);
  EXPECT_EQ(first, of(other, 9));
  EXPECT_NE(first, of(other, 8));
}

TEST(TrialScene, RefusesASceneWithoutStrands) {
  const Scratch folder;
  const std::string file =
      folder.write("bead.toml",
                   "title = \"bead\"\n[model]\nid = \"bead_on_wire\"\n[integrator]\n"
                   "id = \"backward_euler\"\nformulation = \"index3\"\n");
  EXPECT_NO_THROW(read_scene(file));
  EXPECT_THROW(read_open_scene(file), InputError);
}

TEST(TrialScene, RefusesStrandsThatTouch) {
  const Scratch folder;
  const std::string file =
      folder.write("two.toml",
                   "title = \"two\"\n[[strand]]\n[[strand]]\nposition_m = [0, 0.01, 0]\n"
                   "[effects.strand_interaction]\n");
  EXPECT_NO_THROW(read_scene(file));
  EXPECT_THROW(read_open_scene(file), InputError);
}

TEST(Methods, AreAllThatCanDoTheScene) {
  const Scratch folder;
  const Scene given = read_open_scene(folder.write("curly.toml", curly));
  const auto all = methods(given, {});
  for (const Method& method : all) {
    EXPECT_NO_THROW(trial_scene(given, method, 6, 1, 60))
        << method.model->id << ' ' << method.integrator;
  }
  const auto has = [&all](std::string_view model, std::string_view choice,
                          std::string_view word) {
    return std::ranges::any_of(all, [&](const Method& method) {
      return method.model->id == model && method.word(choice) == word;
    });
  };
  EXPECT_TRUE(has("super_helix", "modes", "bend"));
  EXPECT_TRUE(has("super_helix", "solver", "sparse"));
  EXPECT_FALSE(has("super_helix", "solver", "recursive_plain"));  // it loses digits
  for (const Method& method : with_other_words(given, all.front(), "solver")) {
    EXPECT_NE(method.word("solver"), "recursive_plain");
  }
  EXPECT_TRUE(has("der", "stretch", "inextensible"));
  EXPECT_TRUE(has("mass_spring", "torsion", "altitude"));
}

// Three ways to rebuild its matrix with fixed steps; by tolerance; and extrapolated.
TEST(Methods, OfErrorControlAreTriedInFiveWays) {
  const Scene given = read_open_scene(TRESS_SCENES "/accuracy/side_wind.toml");
  const auto ways = methods(given, {{"super_helix"}, {"esdirk43"}, {"none"}});
  ASSERT_EQ(ways.size(), 5u);
  EXPECT_NE(ways[1].refresh, ways[2].refresh);
  EXPECT_FALSE(ways[2].by_tolerance);
  EXPECT_TRUE(ways[3].by_tolerance && !ways[3].extrapolated);
  EXPECT_TRUE(ways[4].by_tolerance && ways[4].extrapolated);
  EXPECT_FALSE(same(ways[3], ways[4]));
}

// Strand.TakesShortStepsForATangentThatLacksTerms says why.
TEST(Methods, KnowNoToleranceWhereTheTangentDecidesAboutSteps) {
  const Scene given = read_open_scene(TRESS_SCENES "/accuracy/side_wind.toml");
  int by_tolerance = 0, by_steps = 0;
  for (const Method& method :
       methods(given, {{"articulated_chain"}, {"tr_bdf2"}, {"jacobian"}})) {
    const bool short_steps = method.word("jacobian") == "elastic_local";
    EXPECT_FALSE(short_steps && method.by_tolerance);
    if (method.by_tolerance) ++by_tolerance;
    if (short_steps) ++by_steps;
    for (const Method& other : with_other_words(given, method, "jacobian")) {
      EXPECT_FALSE(other.by_tolerance && other.word("jacobian") == "elastic_local");
    }
  }
  EXPECT_EQ(by_tolerance, 4);  // exact and stiff, extrapolated or not
  EXPECT_EQ(by_steps, 3);      // three ways to rebuild the matrix
}

TEST(Methods, AreNotExtrapolatedWhereSomethingTouches) {
  const Scene given = read_open_scene(TRESS_SCENES "/accuracy/fall_on_sphere.toml");
  bool by_tolerance = false;
  for (const Method& method : methods(given, {{"super_helix"}, {"tr_bdf2"}, {}})) {
    EXPECT_FALSE(method.extrapolated);
    by_tolerance = by_tolerance || method.by_tolerance;
  }
  EXPECT_TRUE(by_tolerance);
}

TEST(Methods, AskForATenthOfTheLengthAtFirstAndLessByTheirOrder) {
  Method method{{&find_model("super_helix"), {}, "esdirk43"}};
  method.by_tolerance = true;
  const auto tolerance = [&](int substeps) {
    return accuracy(method, substeps, 60).tolerance;
  };
  EXPECT_EQ(tolerance(steps_unit(method)), 0.1);
  EXPECT_EQ(tolerance(2 * steps_unit(method)), 0.0063);  // 0.1 / 16 to two digits
  // Beyond a tenth of the length nothing is controlled.
  EXPECT_EQ(tolerance(1), 0.1);
  // What is said in two digits is what is run.
  for (const int substeps : {8, 9, 21, 64, 500}) {
    EXPECT_EQ(std::stod(fmt::format("{:.2g}", tolerance(substeps))), tolerance(substeps));
  }
  const Scratch folder;
  const Scene given = read_open_scene(folder.write("curly.toml", curly));
  const Scene scene = trial_scene(given, method, 6, 16, 60);
  EXPECT_EQ(scene.options.tolerance, 0.0063);
}

TEST(Methods, DifferInOneWord) {
  const Scratch folder;
  const Scene given = read_open_scene(folder.write("curly.toml", curly));
  const Method method{{&find_model("super_helix"),
                       {{"modes", "bend"}, {"jacobian", "elastic"}},
                       "implicit_midpoint"}};
  const Method reordered{{&find_model("super_helix"),
                          {{"jacobian", "elastic"}, {"modes", "bend"}},
                          "implicit_midpoint"}};
  EXPECT_TRUE(same(method, reordered));
  const auto others = with_other_words(given, method, "modes");
  ASSERT_EQ(others.size(), 1u);  // bend_planar refuses a curl
  EXPECT_EQ(others.front().word("modes"), "bend_twist");
  EXPECT_EQ(others.front().word("jacobian"), "elastic");
  EXPECT_FALSE(same(method, others.front()));
  EXPECT_TRUE(with_other_words(given, method, "bending").empty());
}

TEST(Methods, AreThoseAskedFor) {
  const Scratch folder;
  const Scene given = read_open_scene(folder.write("curly.toml", curly));
  const MethodChoice choice{.models = {"super_helix"},
                            .integrators = {"implicit_midpoint"},
                            .options = {"modes=bend"},
                            .refreshes = {Refresh::every_iteration}};
  const auto some = methods(given, choice);
  ASSERT_EQ(some.size(), 2u);
  EXPECT_EQ(some[0].word("modes"), "bend_twist");
  EXPECT_EQ(some[1].word("modes"), "bend");
  // bend_planar refuses a curl: two modes, two tangents.
  EXPECT_EQ(
      methods(given, {{"super_helix"}, {"rk4"}, {"modes", "jacobian=elastic"}}).size(),
      4u);
}

}  // namespace tress::test_trial_scene
