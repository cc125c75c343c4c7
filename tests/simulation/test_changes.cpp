#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "integrators/integrator_options.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"
#include "simulation/scene_changes/element_unit.h"
#include "simulation/scene_changes/strand_options.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::test_changes {

using namespace simulation;

bool same(const Vec& a, const Vec& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

void expect_same(const Strand& a, const Strand& b) {
  EXPECT_EQ(a.material.density, b.material.density);
  EXPECT_EQ(a.material.youngs_modulus, b.material.youngs_modulus);
  EXPECT_EQ(a.material.shear_modulus, b.material.shear_modulus);
  EXPECT_EQ(a.material.internal_friction, b.material.internal_friction);
  EXPECT_EQ(a.free_root.has_value(), b.free_root.has_value());
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    const Segment &one = a.segments[i], &other = b.segments[i];
    EXPECT_EQ(one.length, other.length);
    EXPECT_EQ(one.section.a1, other.section.a1);
    EXPECT_EQ(one.section.a2, other.section.a2);
    EXPECT_TRUE(same(one.natural, other.natural) && same(one.initial, other.initial));
  }
  for (const double t : {0.0, 0.1, 0.77}) {
    const RootPose one = a.root.at(t), other = b.root.at(t);
    EXPECT_TRUE(same(one.x, other.x) && same(one.v, other.v) && same(one.a, other.a));
    EXPECT_TRUE(same(one.omega, other.omega) && same(one.alpha, other.alpha));
    EXPECT_TRUE(same(one.frame.e0, other.frame.e0) && same(one.frame.e1, other.frame.e1));
  }
}

void expect_same(std::span<const Parameter> declared, const Parameters& a,
                 const Parameters& b) {
  for (const Parameter& p : declared) {
    if (p.name.ends_with("file")) continue;  // the same from another folder
    EXPECT_EQ(a.text(p.name), b.text(p.name)) << p.name;
  }
}

/// All that is no choice of a method.
void expect_same_otherwise(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.duration, b.duration);
  EXPECT_EQ(a.frame_rate, b.frame_rate);
  EXPECT_EQ(a.checkpoint, b.checkpoint);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.guard, b.guard);
  ASSERT_EQ(effect_names(a), effect_names(b));
  for (std::size_t i = 0; i < a.effects.size(); ++i) {
    expect_same(a.effects[i].entry->parameters, a.effects[i].parameters,
                b.effects[i].parameters);
  }
}

void expect_same(const Scene& a, const Scene& b) {
  expect_same_otherwise(a, b);
  ASSERT_EQ(a.model, b.model);
  expect_same(model_table_parameters(*a.model), a.model_options, b.model_options);
  EXPECT_EQ(a.integrator, b.integrator);
  for (const Parameter& p : integrator_options()) {
    EXPECT_EQ(text_of(a.options, p.name), text_of(b.options, p.name)) << p.name;
  }
  ASSERT_EQ(a.strands.size(), b.strands.size());
  for (std::size_t i = 0; i < a.strands.size(); ++i) {
    expect_same(a.strands[i], b.strands[i]);
  }
}

std::vector<std::string> shipped() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TRESS_SCENES)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  return files;
}

class WrittenSceneTest : public testing::TestWithParam<std::string> {};

TEST_P(WrittenSceneTest, IsReadAsTheSame) {
  const Scene scene = read_scene(GetParam());
  const std::string text = scene_text(scene);
  const Scene again = parse_scene(text, "elsewhere/written.toml");
  expect_same(scene, again);
  EXPECT_EQ(scene_text(again), text);
}

INSTANTIATE_TEST_SUITE_P(Scenes, WrittenSceneTest, testing::ValuesIn(shipped()),
                         [](const auto& tested) {
                           return std::filesystem::path(tested.param).stem().string();
                         });

constexpr const char* full = R"(
title = "all \"kinds\" of \\ values"
source = "here"
duration_s = 0.30000000000000004
seed = 9007199254740991
guard = false
checkpoint_s = 0.1
[model]
id = "mass_spring"
torsion = "altitude"
[integrator]
id = "generalized_alpha"
dt_s = 1e-5
refresh = "when_slow"
max_steps = 123456789
[material]
name = "hair.african"
[[strand]]
points = [[0, 0, 0], [0.01, 0, 0], [0.02, 0, 0.001]]
[[strand]]
elements = 17
shape = "material"
position_m = [0.1, -0.25, 1e-7]
[strand.material]
radius_m = 3.3333333333333335e-05
shear_modulus_pa = 0.91e9
[root]
motion = "keyframes"
keyframes = [[0, 0, 0, 0, 0], [1, 0.1, 0, 0.3, 0]]
[effects.gravity]
[[effects.body]]
shape = "sphere"
[[effects.body]]
shape = "plane"
)";

TEST(SceneText, KeepsEveryKindOfValue) {
  const Scene scene = parse_scene(full, "full.toml");
  expect_same(scene, parse_scene(scene_text(scene), "written.toml"));
}

/// Series and channels of a run are named by position: first the effects on each strand.
TEST(SceneEffects, TheOneBetweenStrandsComesLastWhereverItIsWritten) {
  const Scene scene = parse_scene(
      "title = \"t\"\n[strand]\n[effects.strand_interaction]\n[effects.wind]\n"
      "[[effects.tether]]\n[[effects.tether]]\n",
      "order.toml");
  const std::vector<std::string> names{"tether", "tether_2", "wind",
                                       "strand_interaction"};
  EXPECT_EQ(effect_names(scene), names);
  const Effects made = make_effects(scene);
  ASSERT_EQ(made.size() + 1, names.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_TRUE(names[i].starts_with(made[i]->name())) << i;
  }
  const std::vector<Ingredient> parts = ingredients(scene);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(parts[i].name, names[i]);
    EXPECT_EQ(parts[i].without(scene).interaction() != nullptr, i + 1 < names.size());
    EXPECT_EQ(parts[i].alone(scene).interaction() != nullptr, i + 1 == names.size());
  }
}

TEST(SceneText, NamesFilesInFull) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "named_in_full";
  std::filesystem::create_directories(folder);
  std::string ball = "4 4 4\n0 0 -1\n1\n";
  for (int i = 0; i < 64; ++i) ball += "9\n";
  std::ofstream(folder / "ball.txt") << ball;
  const Scene scene = parse_scene(
      "title = \"sdf\"\n[strand]\n[effects.body]\nshape = \"sdf\"\nsdf_file = "
      "\"ball.txt\"\n",
      (folder / "sdf.toml").string());
  const std::string text = scene_text(scene);
  EXPECT_NE(text.find((folder / "ball.txt").string()), std::string::npos) << text;
  EXPECT_NO_THROW(parse_scene(text, "elsewhere/written.toml"));
}

TEST(Changes, OfTheMethodLeaveAllElseAsItWas) {
  const Scene scene = parse_scene(full, "full.toml");
  const Scene other = with_method(
      scene, {&find_model("super_helix"), {{"modes", "bend"}}, "implicit_midpoint"});
  EXPECT_EQ(other.model->id, "super_helix");
  EXPECT_EQ(other.model_options.word("modes"), "bend");
  EXPECT_EQ(other.integrator, "implicit_midpoint");
  EXPECT_EQ(other.options.step, scene.options.step);
  EXPECT_EQ(other.options.refresh, Options{}.refresh);
  expect_same_otherwise(scene, other);
  for (std::size_t i = 0; i < scene.strands.size(); ++i) {
    expect_same(scene.strands[i], other.strands[i]);
  }
  EXPECT_THROW(with_method(scene, {&find_model("der"), {{"modes", "bend"}}, "rk4"}),
               InputError);
}

TEST(Changes, OfElementsAreThoseOfTheFile) {
  const Scene scene = parse_scene(full, "full.toml");
  std::string text = full;
  text.replace(text.find("elements = 17"), 13, "elements = 9");
  text.replace(text.find("points ="), 8, "elements = 9\npoints =");
  const Scene cut = with_elements(scene, 9);
  expect_same(cut, parse_scene(text, "full.toml"));
  expect_same(with_elements(cut, 9), cut);
}

TEST(Changes, OfElementsOfAGroomAreThoseOfTheFile) {
  const auto text = [](int elements) {
    return "title = \"g\"\n[groom]\ncount = 5\nelements = " + std::to_string(elements) +
           "\nlength_variation = 0.3\n";
  };
  expect_same(with_elements(parse_scene(text(12), "g.toml"), 7),
              parse_scene(text(7), "g.toml"));
}

TEST(Changes, RefuseWhatNoTableSays) {
  const Scene scene = parse_scene(full, "full.toml");
  const Scene one = only(scene, {1});
  ASSERT_EQ(one.strands.size(), 1u);
  expect_same(one.strands.front(), scene.strands[1]);
  EXPECT_THROW(with_elements(one, 5), std::logic_error);
  EXPECT_THROW(scene_text(one), std::logic_error);
}

/// Two strands. What acts on them is not in the strands themselves.
Scene held_pair() {
  return parse_scene(
      "title = \"h\"\n[model]\nid = \"der\"\n"
      "[[strand]]\nname = \"a\"\nlength_m = 0.1\n"
      "[[strand]]\nname = \"b\"\nlength_m = 0.2\n"
      "[[supports]]\nstrand = 0\nkind = \"ball\"\n"
      "[[supports]]\nstrand = 1\nkind = \"ball\"\n"
      "[[effects.point_moment]]\nmoment_n_m = [0, 1e-9, 0]\n[effects.gravity]\n",
      "held.toml");
}

TEST(Changes, KeepWhatActsOnTheStrands) {
  const Scene scene = held_pair();
  for (const Scene& of : {refined(scene), with_strands(scene, scene.strands)}) {
    EXPECT_EQ(of.tables->supports.size(), 2U);
    EXPECT_EQ(of.tables->driven.moments.size(), 1U);
  }
  const Scene second = only(scene, {1});
  ASSERT_EQ(second.tables->supports.size(), 1U);
  EXPECT_EQ(second.tables->supports.front().values().whole("strand"), 0);
  EXPECT_EQ(second.tables->driven.moments.size(), 1U);
  std::vector<std::string> names;
  for (const Ingredient& part : ingredients(scene)) names.push_back(part.name);
  EXPECT_EQ(std::ranges::count(names, "point_moment"), 1);
  for (const Ingredient& part : ingredients(scene)) {
    if (part.name != "point_moment") continue;
    EXPECT_FALSE(part.without(scene).tables->driven.any());
    EXPECT_TRUE(part.alone(scene).tables->driven.any());
    EXPECT_TRUE(part.alone(scene).effects.empty());
  }
  EXPECT_FALSE(bare(scene).tables->driven.any());
}

/// A strand alone has the points that it needs, and beside a curl as many as that.
const char* const pendulum = R"(
title = "pendulum"
duration_s = 0.1
[model]
id = "super_helix"
[integrator]
id = "tr_bdf2"
dt_s = 0.002
[[strand]]
name = "upper"
elements = 4
length_m = 0.1
root_tangent = [1, 0, 0]
[[strand]]
name = "lower"
elements = 4
root = "free"
length_m = 0.1
position_m = [0.05, 0, 0]
root_tangent = [0, 0, -1]
[[joints]]
a = ["upper", 0.5]
b = ["lower", "root"]
[effects.gravity]
)";

// Names of strands are gone with their tables.
TEST(Changes, OfStrandsKeepJoints) {
  World world(refined(parse_scene(pendulum, "pendulum.toml")));
  ASSERT_EQ(world.systems(), 1u);
  ASSERT_EQ(world.advance(0.1), Status::ok) << world.failure();
  const std::vector<double>& x = world.positions();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Points 0 to 8 are of the first strand, which is joined in its middle. Rounding of
    // 50 steps.
    EXPECT_NEAR(x[3 * 4 + axis], x[3 * 9 + axis], 1e-10);
  }
}

TEST(ElementUnit, HasAnEndAtEveryPoint) {
  const auto unit = [](const std::vector<std::string>& points) {
    std::string text =
        "title = \"held\"\n[model]\nid = \"der\"\n[integrator]\nid = \"tr_bdf2\"\n"
        "dt_s = 0.002\n[strand]\nelements = 20\n";
    for (const std::string& at : points) text += "[[supports]]\nat = " + at + "\n";
    return element_unit(parse_scene(text, "held.toml"));
  };
  EXPECT_EQ(unit({}), 1);
  EXPECT_EQ(unit({"\"tip\""}), 1);
  EXPECT_EQ(unit({"0.3"}), 10);
  EXPECT_EQ(unit({"0.3", "0.25"}), 20);
  EXPECT_EQ(element_unit(parse_scene(pendulum, "pendulum.toml")), 2);
}

TEST(StrandOptions, HaveTheSamePointsInStrandsOfOneNumberOfElements) {
  const std::string straight = "[[strand]]\nname = \"a\"\nlength_m = 0.1\nelements = 4\n",
                    curl =
                        "[[strand]]\nname = \"b\"\nlength_m = 0.1\nelements = 4\n"
                        "shape = \"helix\"\ncurl_radius_m = 0.004\n",
                    fine = "[[strand]]\nname = \"c\"\nlength_m = 0.1\nelements = 9\n";
  const Scene scene = parse_scene(
      "title = \"p\"\n[model]\nid = \"super_helix\"\n" + straight + curl + fine,
      "p.toml");
  const StrandOptions options(scene);
  const auto points = [&](std::size_t k) {
    return options.of(scene.strands[k]).whole("quadrature");
  };
  EXPECT_EQ(points(1), chosen_points(scene, largest_winding(scene, scene.strands[1])));
  EXPECT_EQ(points(0), points(1));
  EXPECT_LT(points(2), points(1));
  EXPECT_EQ(points(2), chosen_points(scene, largest_winding(scene, scene.strands[2])));
}

}  // namespace tress::test_changes
