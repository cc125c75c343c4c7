// Clamps, welds and natural shapes over time of models whose edges do not bend: the half
// edge at an end rests in the natural shape, whatever the shape at the start.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "contract/forms/support_forces.h"
#include "simulation/rest/supported_start.h"
#include "simulation/run/world.h"
#include "simulation/scene/support_table.h"
#include "tests/support/small_motion.h"

namespace tress::test_half_edges {

using namespace simulation;

constexpr double radius = 1e-3, modulus = 3e7;
const double bending = modulus * std::numbers::pi / 4 * std::pow(radius, 4);

Scene scene_of(const std::string& model, const std::string& strands,
               const std::string& rest = {},
               const std::string& integrator =
                   "id = \"generalized_alpha\"\ndt_s = 1e-3\nnewton_tolerance = 1e-10",
               const std::string& radius_m = "1e-3") {
  return parse_scene(
      "title = \"halves\"\nduration_s = 1\nframes_per_s = 100\n[model]\nid = \"" + model +
          "\"\n[integrator]\n" + integrator +
          "\n[material]\nname = \"custom\"\nradius_m = " + radius_m +
          "\nyoungs_modulus_pa = 3e7\n"
          "poisson_ratio = 0.45\ndensity_kg_m3 = 1300\n"
          "internal_friction_kg_m3_s = 1e-6\n" +
          strands + rest,
      "halves.toml");
}

/// The moment of the clamp at the tip of a straight rod that begins as a curve between
/// clamps, in the equilibrium, N m. It is too thin to stretch.
Vec moment_at_tip(const std::string& model, int elements) {
  std::string points;
  // A curve whose curvature grows from the root to the tip.
  for (int i = 0; i <= 20; ++i) {
    const double x = 0.005 * i;
    points += (i > 0 ? ", [" : "[") + std::to_string(x) + ", 0, " +
              std::to_string(12 * x * x * x) + "]";
  }
  const Scene scene = scene_of(
      model,
      "[strand]\npoints = [" + points +
          "]\nnatural = \"straight\"\nelements = " + std::to_string(elements) + "\n",
      "[[supports]]\nkind = \"clamp\"\n", "id = \"tr_bdf2\"", "3e-5");
  const auto system = SceneSupports(scene).on(testing_support::system_of(scene),
                                              scene.strands.front(), 0);
  auto& held = dynamic_cast<models::SupportedSystem&>(*system);
  // It begins on its supports.
  EXPECT_EQ(begin_on_supports(held, "test").steps, 0) << model;
  testing_support::Start at(held);
  EXPECT_TRUE(come_to_rest(held, at.q)) << model << " " << elements;
  std::vector<double> force(3), moment(3);
  EXPECT_EQ(support_forces(held)->support_forces(0, at.q, at.v, force, moment),
            Status::ok);
  return load3(moment.data());
}

/// Edges err by order 2 in their length, as differences of runs show. A rest angle of the
/// start would leave half an edge of the moment out: an error of order 1.
TEST(HalfEdges, OfAClampRestInTheNaturalShape) {
  const Vec exact = moment_at_tip("super_clothoid", 40);
  std::printf("super_clothoid: %.6e N m\n", norm(exact));
  for (const char* model : {"articulated_chain", "der", "corde", "xpbd_cosserat",
                            "mass_spring", "lifted_curls"}) {
    std::vector<Vec> moments;
    for (const int elements : {10, 20, 40}) {
      moments.push_back(moment_at_tip(model, elements));
      const double off = norm(moments.back() - exact) / norm(exact);
      std::printf("%s: moment off by %.2e with %d elements\n", model, off, elements);
      EXPECT_LE(off, 1.0 / (elements * elements)) << model << " " << elements;
    }
    const double order =
        std::log2(norm(moments[1] - moments[0]) / norm(moments[2] - moments[1]));
    std::printf("%s: order %.2f\n", model, order);
    EXPECT_NEAR(order, 2, 0.3) << model;
  }
}

/// A curl that begins straight, as one strand and as two welded ones. Before, a weld
/// rested at the angle of the start and held the middle straight. Edges measure the angle
/// of a weld in another way than that of a joint, by a 16th of the square of 0.2 rad.
TEST(HalfEdges, OfAWeldRestInTheNaturalShape) {
  for (const char* model : {"der", "corde", "xpbd_cosserat"}) {
    const auto tip = [&](bool whole) {
      const std::string shape =
          "shape = \"helix\"\ncurl_radius_m = 0.1\ncurl_pitch_m = 0\n"
          "initial = \"straight\"\n";
      const std::string half = "[[strand]]\nlength_m = 0.1\nelements = 5\n" + shape;
      World world(scene_of(
          model, whole ? "[strand]\nlength_m = 0.2\nelements = 10\n" + shape
                       : half + half + "root = \"free\"\nposition_m = [0.1, 0, 0]\n" +
                             "[[joints]]\na = [0, \"tip\"]\nb = [1, \"root\"]\n"
                             "kind = \"weld\"\n"));
      EXPECT_EQ(world.advance(0.05), Status::ok) << world.failure();
      const std::vector<double>& x = world.positions();
      return load3(&x[x.size() - 3]);
    };
    const Vec of_whole = tip(true);
    const double off = norm(of_whole - tip(false)) / 0.2,
                 moved = norm(of_whole - Vec{0.2, 0, 0}) / 0.2;
    std::printf("%s: tips %.1e of the length apart, which moved by %.1e\n", model, off,
                moved);
    EXPECT_LE(off, 2e-3) << model;
    EXPECT_GE(moved, 0.1) << model;
  }
}

/// A straight strand between clamps whose natural curvature grows does not move. Its
/// moment is E I times that curvature, exactly, at the clamp and in welds.
TEST(HalfEdges, FollowANaturalShapeOverTime) {
  for (const char* model :
       {"super_helix", "articulated_chain", "der", "corde", "xpbd_cosserat"}) {
    const bool free = std::string(model) != "articulated_chain";
    const std::string drive =
        "[[effects.natural_shape]]\ncurvature_per_m = [[0, 0], [0.05, 8]]\n";
    const auto read = [&](const std::string& strands) {
      World world(scene_of(model, strands, drive));
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      return world.support_loads().moments;
    };
    const std::string clamp = "kind = \"clamp\"\nslide = [1, 0, 0]\n";
    const std::vector<double> alone =
        read("[strand]\nlength_m = 0.1\nelements = 5\n[[supports]]\n" + clamp);
    ASSERT_EQ(alone.size(), 3U);
    // Angles of 0.16 rad, of which measures differ by a 12th of the square at most.
    EXPECT_NEAR(norm(load3(alone.data())) / (8 * bending), 1, 2.2e-3) << model;
    if (!free) continue;
    const std::vector<double> both = read(
        "[[strand]]\nlength_m = 0.1\nelements = 5\n[[strand]]\nlength_m = 0.1\n"
        "elements = 5\nroot = \"free\"\nposition_m = [0.1, 0, 0]\n[[supports]]\n"
        "strand = 1\n" +
        clamp + "[[joints]]\na = [0, \"tip\"]\nb = [1, \"root\"]\nkind = \"weld\"\n");
    ASSERT_EQ(both.size(), 6U);
    for (const std::size_t k : {0U, 3U}) {
      std::printf("%s: moment over E I k %.6f\n", model,
                  norm(load3(&both[k])) / (8 * bending));
      EXPECT_NEAR(norm(load3(&both[k])) / (8 * bending), 1, 2.2e-3) << model;
    }
  }
}

/// A natural shape that changes within one step, or in a few: its work is counted, and
/// the run goes on. The strand stores E I k^2 L/2 = 8.5e-3 J, five times its m g L, which
/// the guard allows without work. The method errs by less than 1e-3 of the energy.
TEST(NaturalWork, IsCountedInAStepOfAnyLength) {
  for (const char* row : {"0.1001", "0.1005", "0.104"}) {
    for (const bool joined : {false, true}) {
      const std::string strands =
          joined ? "[[strand]]\nlength_m = 0.1\nelements = 5\n[[strand]]\nlength_m = "
                   "0.1\nelements = 5\nroot = \"free\"\nposition_m = [0.1, 0, 0]\n"
                   "[[joints]]\na = [0, \"tip\"]\nb = [1, \"root\"]\nkind = \"weld\"\n"
                 : "[strand]\nlength_m = 0.2\nelements = 10\n";
      const std::string drive =
          "[[effects.natural_shape]]\ncurvature_per_m = [[0.1, 0], [" + std::string(row) +
          ", 60]]\n";
      World world(
          scene_of("super_helix", strands, drive, "id = \"tr_bdf2\"\ndt_s = 2e-4"));
      ASSERT_EQ(world.advance(0.2), Status::ok) << row << ": " << world.failure();
      const auto account = world.dissipation();
      ASSERT_TRUE(account);
      std::printf("row to %s s%s: %.3e J dissipated, uncertain %.1e, available %.3e\n",
                  row, joined ? ", joined" : "", account->dissipated, account->uncertain,
                  account->available);
      EXPECT_LE(std::abs(account->dissipated), 1e-3 * account->available);
    }
  }
}

}  // namespace tress::test_half_edges
