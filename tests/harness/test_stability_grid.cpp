#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "experiments/stability_limit/stability_limit.h"

namespace tress::test_stability_grid {

using namespace experiments;
using namespace experiments::stability_limit;

using testing::ElementsAre;
using testing::Pair;

using Pairs = std::multiset<std::pair<std::string_view, std::string_view>>;

/// Models and integrators of the rows of one scene, damping and number of elements.
Pairs pairs(const std::vector<std::string>& models,
            const std::vector<std::string>& integrators) {
  CommandLine line;
  line.models = models;
  line.integrators = integrators;
  line.elements = {5};
  line.set = {{"scene", "release"}, {"damping", "none"}};
  Pairs all;
  for (const StabilityCase& c :
       stability_cases(line, Settings(line, stability_settings()))) {
    all.emplace(c.model->id, c.integrator);
  }
  return all;
}

TEST(StabilityGrid, HasEveryPairOfModelsAndIntegratorsThatAreNamed) {
  EXPECT_THAT(pairs({"der", "corde"}, {"newmark", "tr_bdf2"}),
              ElementsAre(Pair("corde", "newmark"), Pair("corde", "tr_bdf2"),
                          Pair("der", "newmark"), Pair("der", "tr_bdf2")));
}

TEST(StabilityGrid, HasAPairOfTheUsualRowsOnce) {
  EXPECT_THAT(pairs({"der"}, {"backward_euler"}),
              ElementsAre(Pair("der", "backward_euler")));
}

TEST(StabilityGrid, LeavesOutMethodsWithoutAStep) {
  EXPECT_TRUE(pairs({"der"}, {"cvode_bdf"}).empty());
}

TEST(StabilityGrid, PairsOtherMethodsWithTheSuperHelixIfNoModelIsNamed) {
  EXPECT_THAT(pairs({}, {"newmark"}), ElementsAre(Pair("super_helix", "newmark")));
}

}  // namespace tress::test_stability_grid
