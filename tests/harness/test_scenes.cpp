#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>

#include "experiments/harness/scene_file.h"
#include "models/reduced/trees.h"
#include "models/strand/strand_parameters.h"

namespace tress {
namespace {

const std::filesystem::path scenes = TRESS_SCENES;

TEST(Scenes, AreRead) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(scenes)) {
    CommandLine line;
    EXPECT_NO_THROW(read_scene_options(file.path().string(), line)) << file.path();
    EXPECT_FALSE(line.models.empty()) << file.path();
    ++count;
  }
  EXPECT_GE(count, 5);
}

class TreeSceneTest : public testing::TestWithParam<std::string> {};

TEST_P(TreeSceneTest, NamesItsTreeWithItsMaterialAndRoot) {
  CommandLine line;
  read_scene_options((scenes / (GetParam() + ".toml")).string(), line);
  const std::array own = {Parameter{.name = "tree", .help = "", .choices = tree_choices}};
  const std::vector<Parameter> declared = with_material_parameters(own);
  Parameters parameters(declared, GetParam());
  for (const auto& [key, value] : line.set) parameters.set(key, value);
  EXPECT_EQ(parameters.word("tree"), GetParam());
  const Material scene = material(parameters);
  const Material tree = tree_material(GetParam());
  EXPECT_EQ(scene.density, tree.density);
  EXPECT_EQ(scene.youngs_modulus, tree.youngs_modulus);
  EXPECT_EQ(scene.shear_modulus, tree.shear_modulus);
  EXPECT_EQ(scene.internal_friction, tree.internal_friction);
  const Frame root = root_motion(parameters).frame;
  const Frame expected = upright();
  const auto off = [](const Vec& a, const Vec& b) { return dot(a - b, a - b); };
  EXPECT_EQ(off(root.e0, expected.e0), 0);
  EXPECT_EQ(off(root.e1, expected.e1), 0);
  EXPECT_EQ(off(root.e2, expected.e2), 0);
}

INSTANTIATE_TEST_SUITE_P(Trees, TreeSceneTest,
                         testing::Values("palm_tree", "algae", "complex_tree", "man",
                                         "willow"),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace tress
