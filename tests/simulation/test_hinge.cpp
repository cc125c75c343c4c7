// Hinges: as a ball joint across the axis, as a clamp along it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "math/vec3.h"
#include "simulation/run/world.h"
#include "tests/support/refusal.h"

namespace tress::test_hinge {

using namespace simulation;
using testing_support::refusal;

/// A strand that sags between a swinging root and a held tip, which may slide towards the
/// root; all loads act along `load`.
std::string text_of(const std::string& model, const std::string& support,
                    const std::string& load) {
  return "title = \"hinge\"\nduration_s = 0.1\n[model]\nid = \"" + model +
         "\"\n[integrator]\nid = \"backward_euler\"\ndt_s = 2e-3\n[material]\nname = "
         "\"custom\"\nradius_m = 1e-3\nyoungs_modulus_pa = 3e7\npoisson_ratio = 0.45\n"
         "density_kg_m3 = 1300\n[strand]\nlength_m = 0.3\nelements = 8\n[root]\nmotion = "
         "\"swing\"\namplitude_m = 0.01\nfrequency_hz = 5\ndirection = " +
         load + "\n[[supports]]\nslide = [1, 0, 0]\n" + support +
         "[effects.gravity]\ngravity_m_s2 = " + load + "\n";
}

struct End {
  std::vector<double> x, moments;
};
End end_of(const std::string& text) {
  World world(parse_scene(text, "hinge.toml"));
  EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
  const auto loads = world.support_loads();
  return {world.positions(), {loads.moments.begin(), loads.moments.end()}};
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

const char* const hinge = "kind = \"hinge\"\naxis = [0, 2, 0]\n";

// Searches end within 1e-11 of typical sizes and steps within 1e-10, over 50 steps of a
// strand that is not near an instability.
TEST(Hinge, TurnsAsABallAcrossItsAxisAndHoldsAsAClampAlongIt) {
  for (const char* model : {"super_helix", "super_clothoid", "articulated_chain", "der",
                            "corde", "mass_spring"}) {
    SCOPED_TRACE(model);
    const auto end = [&](const char* support, const char* load) {
      return end_of(text_of(model, support, load));
    };
    const End across = end(hinge, "[0, 0, -9]"), along = end(hinge, "[0, -9, 0]");
    EXPECT_LE(apart(across.x, end("", "[0, 0, -9]").x), 1e-7);
    EXPECT_GE(apart(across.x, end("kind = \"clamp\"\n", "[0, 0, -9]").x), 1e-3);
    EXPECT_LE(apart(along.x, end("kind = \"clamp\"\n", "[0, -9, 0]").x), 1e-7);
    EXPECT_GE(apart(along.x, end("", "[0, -9, 0]").x), 1e-3);
    // EI/L is 8e-5 N m: the moment about the axis is none of it.
    ASSERT_EQ(across.moments.size(), 3U);
    EXPECT_LE(std::abs(across.moments[1]), 1e-10);
    EXPECT_GE(std::abs(along.moments[2]), 1e-5);
  }
}

TEST(Hinge, RefusesWhatIsNoAxis) {
  const auto refused = [](const std::string& support, const char* model = "super_helix") {
    return refusal(
        [&] { World(parse_scene(text_of(model, support, "[0, 0, -9]"), "hinge.toml")); });
  };
  EXPECT_EQ(refused(hinge), "");
  EXPECT_NE(refused("kind = \"hinge\"\n").find("a hinge without an axis (hinge.toml:"),
            std::string::npos);
  EXPECT_NE(refused("kind = \"hinge\"\naxis = [1, 1, 0]\n")
                .find("give an axis perpendicular to the direction of the strand"),
            std::string::npos);
  EXPECT_NE(refused("axis = [0, 1, 0]\n").find("which turns about no axis"),
            std::string::npos);
  EXPECT_NE(refused("kind = \"hinge\"\naxis = [0, 1, 0]\ndirections = [[0, 1, 0, 0]]\n")
                .find("which follows no directions"),
            std::string::npos);
  EXPECT_NE(refused(hinge, "super_helix\"\nmodes = \"bend_planar")
                .find("a hinge of a planar model"),
            std::string::npos);
}

}  // namespace tress::test_hinge
