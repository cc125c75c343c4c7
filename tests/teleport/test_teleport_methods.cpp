// Every method carries every model: its stages may lie beyond the jump.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "tests/support/refusal.h"
#include "tests/teleport/teleport_scenes.h"

namespace tress::test_teleport_methods {

using namespace test_teleport;
using test_teleport::Points;
using test_teleport::strand;
using testing_support::refusal;

constexpr double jump = 0.002, end_at = 0.004;  // s

/// Explicit methods are stable with the steps below: sqrt(E/rho) is 30 m/s, so that nodes
/// 17 mm apart oscillate with at most 2 30/0.017 rad/s.
const std::string soft =
    "[material]\nname = \"custom\"\nyoungs_modulus_pa = 1e6\npoisson_ratio = 0.4\n"
    "density_kg_m3 = 1100\nradius_m = 2e-4\n";

Scene scene(const std::string& model, const std::string& integrator,
            const std::string& root) {
  return parse_scene(text_of(model, integrator, root, strand, soft), "teleport.toml");
}

/// A root that moves until it jumps by this displacement, and goes on moving in another
/// way: a stage beyond the jump that sees the motion after it is wrong.
std::string moving_by(double x, double y, double z, double angle) {
  const auto row = [&](double t, double up, double turned) {
    return fmt::format("[{}, {}, {}, {}, {}]", t, x, y, z + up, angle + turned);
  };
  return "motion = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], [0.002, 0, 0, "
         "0.0002, 0.02], " +
         row(jump, 0.0002, 0.02) + ", " + row(0.005, 0.0006, 0.05) + "]\n";
}

/// The options with which a method is tested; empty: it cannot drive the model.
std::vector<std::string> ways(const IntegratorEntry& method, const std::string& model) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& options) {
    for (const auto& [form, order] : method.formulations) {
      const std::string text = fmt::format("id = \"{}\"\nformulation = \"{}\"\n{}",
                                           method.id, name(form), options);
      const std::string root = "motion = \"fixed\"\n";
      if (!refusal([&] { scene(model, text, root); }).empty()) continue;
      all.push_back(text);
      return;
    }
  };
  if (method.adaptive) {
    add("rtol = 1e-7");
  } else {
    add(method.stages > 0 ? "dt_s = 1e-4" : "dt_s = 1e-5");
  }
  if (method.error_controlled) add("position_tol_rel = 1e-4");
  return all;
}

/// The same motion without a jump, with which unstable methods fail as well.
const std::string motion_without =
    "motion = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], [0.002, 0, 0, 0.0002, 0.02], "
    "[0.005, 0, 0, 0.0006, 0.05]]\n";

class Methods : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Models, Methods, testing::ValuesIn(strand_models()),
                         [](const auto& tested) { return tested.param; });

/// At the jump bounds are those of Teleport. Between jumps Newton's method ends within
/// 1e-10 of an element in each of 40 steps, and the motion amplifies that by less than 2.
/// Steps that a tolerance chooses may differ by rounding: both runs are then within the
/// tolerance, rtol in each of 100 steps.
TEST_P(Methods, CarryTheStrandWithItsRoot) {
  int driven = 0;
  for (const IntegratorEntry& method : integrator_catalogue()) {
    for (const std::string& way : ways(method, GetParam())) {
      SCOPED_TRACE(way);
      const Scene jumped = scene(GetParam(), way, moving_by(0.3, -0.2, 0.1, 0.7)),
                  stayed = scene(GetParam(), way, moving_by(0, 0, 0, 0));
      World still(stayed);
      if (still.advance(end_at) != Status::ok) {
        World without(scene(GetParam(), way, motion_without));
        EXPECT_NE(without.advance(end_at), Status::ok) << still.failure();
        continue;
      }
      ++driven;
      World world(jumped);
      ASSERT_EQ(world.advance(models::just_before(models::teleport_time(jump))),
                Status::ok)
          << world.failure();
      const Points before = carried(jump_of(jumped, jump), points_of(world));
      const double elastic = world.energies().elastic;
      ASSERT_EQ(world.advance(jump), Status::ok) << world.failure();
      EXPECT_LE(apart(points_of(world).x, before.x), 100 * epsilon);
      EXPECT_LE(apart(points_of(world).u, before.u), 20 * 100 * epsilon);
      EXPECT_NEAR(world.energies().elastic, elastic, 1e-11 * elastic + 6e-4 * epsilon);
      ASSERT_EQ(world.advance(end_at), Status::ok) << world.failure();
      const auto root = [](const Scene& of) {
        return of.strands.front().root.at(end_at);
      };
      const Points expected =
          carried(models::displacement(root(stayed), root(jumped)), points_of(still));
      const double within = jumped.options.tolerance > 0 ? 2 * 1e-4
                            : method.adaptive            ? 2 * 100 * 1e-7
                                                         : 1e-8;
      EXPECT_LE(apart(points_of(world).x, expected.x), within * length);
    }
  }
  EXPECT_GE(driven, 10);
}

}  // namespace tress::test_teleport_methods
