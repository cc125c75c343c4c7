#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "integrators/catalogue.h"
#include "simulation/run/simulation.h"
#include "tests/support/bare_system.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_stiff_stresses {

using namespace integrators;
using namespace simulation;

using namespace testing_support;

class StiffStresses : public testing::TestWithParam<const char*> {};

/// A thin strand is let go and falls for half a second in steps of 1/60 s. With stresses
/// of the iterates, whose edges are longer by the square of how far they turned,
/// corrections take back those before them.
TEST_P(StiffStresses, DoNotTakeBackCorrections) {
  const auto system = make_model(GetParam(), {{"elements", "20"},
                                              {"length_m", "0.3"},
                                              {"radius_m", "5e-5"},
                                              {"youngs_modulus_pa", "4e9"},
                                              {"root_tangent", "x"}});
  double iterations[2] = {};
  std::vector<double> ends[2];
  Options options;
  options.step = 1.0 / 60;
  for (const bool stressed : {false, true}) {
    BareSystem bare(*system);
    System& seen = stressed ? *system : bare;
    States s(seen);
    system->reset();
    const auto method = make_integrator("backward_euler", seen, options);
    ASSERT_EQ(method->start(0, s.q, s.v), Status::ok);
    ASSERT_EQ(method->advance(0.5), Status::ok) << method->failure();
    iterations[stressed] = static_cast<double>(method->stats().newton_iterations);
    ends[stressed].assign(method->q().begin(), method->q().end());
    for (std::size_t i = 0; i < s.n; ++i) ends[stressed][i] /= s.q_typ[i];
  }
  std::printf("%s: %g iterations, %g without the stresses of the corrections\n",
              GetParam(), iterations[1], iterations[0]);
  EXPECT_LE(iterations[1], 0.5 * iterations[0]);
  // Every step ends by the same tolerance, and damps what those before it left.
  EXPECT_LE(largest(plus(ends[1], -1, ends[0])), 100 * options.newton_tolerance);
}

INSTANTIATE_TEST_SUITE_P(Maximal, StiffStresses,
                         testing::Values("der", "mass_spring", "corde"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace tress::test_stiff_stresses
