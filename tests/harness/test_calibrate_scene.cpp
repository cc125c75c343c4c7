#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "contract/input_error.h"
#include "experiments/calibrate/calibrate.h"
#include "experiments/calibrate/specimen.h"

namespace tress::test_calibrate_scene {

using namespace experiments;
using namespace experiments::calibrate;

using testing::HasSubstr;

/// Let go straight from a horizontal clamp; `more` ends the strand's table.
std::string hair(const std::string& more = "") {
  return R"(
title = "hair let go"
duration_s = 0.5

[model]
id = "super_helix"

[integrator]
id = "implicit_midpoint"
dt_s = 0.001

[material]
name = "hair.asian"
ellipticity = 1
internal_friction_kg_m3_s = 1e-10

[strand]
elements = 10
length_m = 0.08
)" + more +
         R"(
[effects.gravity]

[effects.linear_drag]
drag_kg_m_s = 2e-5
)";
}

std::string file_of(const std::string& name, const std::string& text) {
  std::string path = testing::TempDir() + name;
  std::ofstream(path) << text;
  return path;
}

std::vector<Case> cases(
    const std::string& scene,
    const std::vector<std::pair<std::string, std::string>>& more = {}) {
  CommandLine line;
  line.set = more;
  line.set.emplace_back("scenes", scene);
  return calibrate_cases(line);
}

Row row_of(const Case& work) {
  Row row = work.identity;
  work.run(row, Deadline(600));
  return row;
}

TEST(CalibrateScene, ATruthIsInsideTheIntervalOfItsOwnRecord) {
  const auto all =
      cases(file_of("hair.toml", hair()), {{"fit", "gamma"}, {"noise_m", "5e-3"}});
  ASSERT_EQ(all.size(), 1u);
  const Row row = row_of(all.front());
  EXPECT_TRUE(row.ok()) << row.text("reason");
  EXPECT_EQ(row.text("data"), "hair");
  EXPECT_EQ(row.text("model"), "super_helix");
  EXPECT_EQ(row.number("internal_friction_true_kg_m3_s"), 1e-10);
  EXPECT_LT(row.number("internal_friction_low_kg_m3_s"), 1e-10);
  EXPECT_GT(row.number("internal_friction_high_kg_m3_s"), 1e-10);
  EXPECT_EQ(row.number("drag_kg_m_s"), 2e-5);  // known
}

// Standard errors of a fit are in proportion to those of its points.
TEST(CalibrateScene, TenTimesTheNoiseIsTenTimesTheInterval) {
  const std::string file = file_of("noisy.toml", hair());
  const auto width = [&](const char* noise) {
    const Row row = row_of(cases(file, {{"fit", "nu"}, {"noise_m", noise}}).front());
    return std::log(row.number("drag_high_kg_m_s") / row.number("drag_low_kg_m_s"));
  };
  // The same errors, times ten, but for how the fit bends: a tenth of it.
  EXPECT_NEAR(width("5e-3") / width("5e-4"), 10, 1.5);
}

TEST(CalibrateScene, WithoutAChoiceEveryFitOfWhatItHasIsTried) {
  EXPECT_EQ(cases(file_of("all.toml", hair())).size(), 7u);
  std::string still = hair();
  still.erase(still.find("[effects.linear_drag]"));
  const auto gamma = cases(file_of("still.toml", still));
  ASSERT_EQ(gamma.size(), 3u);
  EXPECT_EQ(gamma[0].identity.text("fit"), "gamma");
  EXPECT_EQ(gamma[1].identity.text("fit"), "stiffness");
  EXPECT_EQ(gamma[2].identity.text("fit"), "stiffness_gamma");
}

TEST(CalibrateScene, RecordsOfTheUserAreOfTheScenesStrand) {
  // A strand at rest does not swing: any amplitude is a misfit, and the fit says so.
  std::string csv = "t_s,amplitude_m\n";
  for (int k = 1; k <= 20; ++k) {
    csv +=
        std::to_string(0.02 * k) + ',' + std::to_string(k % 2 == 0 ? 0.01 : -0.01) + '\n';
  }
  const std::string data = file_of("mine.csv", csv);
  const std::string scene = file_of("of_data.toml", hair());
  const auto all = cases(scene, {{"data", data}, {"fit", "gamma"}});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all.front().identity.text("data"), data);
  const Row row = row_of(all.front());
  EXPECT_FALSE(row.ok());
  EXPECT_EQ(row.text("internal_friction_true_kg_m3_s"), "");

  const std::string labelled = file_of("labelled.csv", [&] {
    std::string text = "t_s,amplitude_m,length_m\n";
    for (int k = 1; k <= 6; ++k) text += std::to_string(k) + ",1,0.1\n";
    return text;
  }());
  try {
    cases(scene, {{"data", labelled}});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("labelled.csv:2:5"));
    EXPECT_THAT(error.what(), HasSubstr("length_m"));
  }
}

TEST(CalibrateScene, RefusesWhatItCannotFitWithTheReason) {
  const auto refusal =
      [](const std::string& file,
         const std::vector<std::pair<std::string, std::string>>& more = {})
      -> std::string {
    try {
      cases(file, more);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal(TRESS_SCENES "/palm_tree.toml"), HasSubstr("its own geometry"));
  EXPECT_THAT(refusal(TRESS_SCENES "/hair_under_wind.toml"), HasSubstr("records are of"));
  const std::string file = file_of("refused.toml", hair());
  EXPECT_THAT(refusal(file, {{"length_m", "0.1"}}),
              HasSubstr("defines 'length_m' itself"));
  EXPECT_THAT(refusal(file, {{"signal", "envelope"}}), HasSubstr("displacement"));
  EXPECT_THAT(refusal(file, {{"signal", "envelope"}, {"fit", "stiffness"}}),
              HasSubstr("no frequency"));
  const std::string late =
      file_of("late.csv", "t_s,amplitude_m\n0.1,1\n0.2,1\n0.3,1\n0.4,1\n0.6,1\n");
  EXPECT_THAT(refusal(file, {{"data", late}}),
              HasSubstr("late.csv:6:1): set duration_s"));
  const std::string free = file_of("free.toml", hair("[root]\nmotion = \"free\"\n"));
  EXPECT_THAT(refusal(free), HasSubstr("flies freely"));
}

// A curl in wind beside a wall is a strand like any other.
TEST(CalibrateScene, KeepsWhatElseActsOnTheStrand) {
  const Scene scene = parse_scene(hair("shape = \"helix\"\ncurl_radius_m = 0.004\n") +
                                      "[effects.wind]\nvelocity_m_s = [-1, 0, 0]\n"
                                      "[[effects.body]]\ncentre_m = [0, 0, -0.05]\n",
                                  "curl.toml");
  const Specimen strand = specimen(scene);
  EXPECT_EQ(strand.properties.gamma, 1e-10);
  EXPECT_EQ(strand.properties.nu, 2e-5);
  const BuiltStrand built = strand.build({2e-10, 3e-5, 4e9}, 2);
  ASSERT_EQ(built.guarded.size(), 1u);
  EXPECT_EQ(built.guarded.front().points(), 21);
  EXPECT_EQ(built.guarded.front().effects.size(), 4u);
}

}  // namespace tress::test_calibrate_scene
