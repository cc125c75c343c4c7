#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "models/reduced/trees.h"
#include "models/strand/strand_parameters.h"
#include "simulation/scene/scene.h"

namespace tress::test_trees {

using namespace simulation;

const std::filesystem::path scenes = TRESS_SCENES;

class TreeSceneTest : public testing::TestWithParam<std::string> {};

TEST_P(TreeSceneTest, NamesItsTreeWithItsMaterialAndRoot) {
  const Scene read = read_scene((scenes / (GetParam() + ".toml")).string());
  EXPECT_EQ(read.model->id, "super_helix_tree");
  const Parameters& parameters = read.model_options;
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

}  // namespace tress::test_trees
