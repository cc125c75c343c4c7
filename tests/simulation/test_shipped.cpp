#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "integrators/catalogue.h"
#include "simulation/rest/supported_start.h"
#include "simulation/run/simulation.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/support_table.h"

namespace tress::test_shipped {

using namespace simulation;

std::vector<std::string> shipped() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TRESS_SCENES)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  return files;
}

class ShippedSceneTest : public testing::TestWithParam<std::string> {};

TEST_P(ShippedSceneTest, IsReadBuiltAndTakesAStep) {
  const Scene scene = read_scene(GetParam());
  EXPECT_FALSE(scene.source.empty());
  auto system = scene.model->on_strand == nullptr
                    ? scene.model->make(scene.model_options)
                    : scene.model->on_strand(scene.strands.front(), scene.model_options,
                                             make_effects(scene));
  if (const SceneSupports supports(scene); supports.change(0)) {
    system = supports.on(std::move(system), scene.strands.front(), 0);
  }
  if (const SceneSupports supports(scene); supports.hold(0)) {
    EXPECT_TRUE(begin_on_supports(*system, supports.place(0)).held);
  }
  const State start = initial_state(*system);
  const auto method = make_integrator(scene.integrator, *system, scene.options);
  ASSERT_EQ(method->start(0, start.q, start.v), Status::ok) << method->failure();
  ASSERT_EQ(method->advance(scene.options.step), Status::ok) << method->failure();
  for (const double x : method->q()) EXPECT_TRUE(std::isfinite(x));
  for (const double x : method->v()) EXPECT_TRUE(std::isfinite(x));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedSceneTest, testing::ValuesIn(shipped()),
                         [](const auto& tested) {
                           return std::filesystem::path(tested.param).stem().string();
                         });

}  // namespace tress::test_shipped
