#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/gradient/scene_gradient.h"

/// Gradients by numbers of forces that turn at states which no run has at its start.
namespace tress::test_law_gradient {

using namespace simulation;

/// The tip at the last frame, by differences of order 4 at the distance e.
std::vector<double> difference(const Scene& scene, const SceneParameter& by, double e) {
  const auto tip = [&](double s) {
    Scene changed = scene;
    by.change(changed, s);
    const StrandGradient run = scene_gradient(changed).strands.front();
    EXPECT_EQ(run.unfinished, "");
    return std::vector<double>(run.points.back().end() - 3, run.points.back().end());
  };
  const auto p1 = tip(e), m1 = tip(-e), p2 = tip(2 * e), m2 = tip(-2 * e);
  std::vector<double> d(3);
  for (std::size_t i = 0; i < 3; ++i) {
    d[i] = (8 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12 * e * by.measure);
  }
  return d;
}

double apart(const std::vector<double>& x, const std::vector<double>& y) {
  double most = 0, size = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    most = std::max(most, std::abs(x[i] - y[i]));
    size = std::max(size, std::abs(y[i]));
  }
  return most / size;
}

// The strand begins in the plane, where the force on a point is affine in the damping. It
// leaves the plane, and the force is then quadratic in it. Newton's tolerance, 1e-13 of
// the length, leaves 1e-9 of it in differences at 1e-4. They are some 1e-3 of the length,
// so that 1e-6 of them remain. A point that leaves within the distance of the differences
// adds as much. Without the quadratic part, derivatives are wrong by a tenth.
TEST(LawGradient, ByTheDampingOfABodyIsThatOfDifferences) {
  for (const char* const damping : {"1", "3"}) {
    for (const char* const model : {"super_helix", "articulated_chain", "der"}) {
      for (const char* const way : {"forward", "adjoint"}) {
        SCOPED_TRACE(std::string(model) + " " + way + " " + damping);
        const Scene scene = parse_scene(
            std::string("title = \"t\"\nduration_s = 0.1\nframes_per_s = 100\n[model]\n"
                        "id = \"") +
                model +
                "\"\n[integrator]\nid = \"backward_euler\"\ndt_s = 0.002\n"
                "newton_tolerance = 1e-13\n[strand]\nlength_m = 0.1\nelements = 6\n"
                "shape = \"along\"\ndarboux_along = [[0, 0, 10, 0]]\n[root]\n"
                "[effects.gravity]\n[effects.body]\ncentre_m = [0, 0, -0.035]\n"
                "stiffness_n_m2 = 1\ndamping_s_m = " +
                damping +
                "\n[gradient]\nby = [\"body.damping_s_m\"]\nof = \"last_tip\"\nstart = "
                "\"as_run\"\nway = \"" +
                way + "\"\n",
            "s.toml");
        const SceneGradient found = scene_gradient(scene);
        const StrandGradient& strand = found.strands.front();
        ASSERT_EQ(strand.unfinished, "");
        const std::vector<double>& last = strand.by[0].back();
        EXPECT_LT(apart({last.end() - 3, last.end()},
                        difference(scene, found.parameters[0], 1e-4)),
                  1e-4);
      }
    }
  }
}

// Numbers of an effect are affine if it declares so, for every value of its other keys.
TEST(LawGradient, AffineNumbersAreThoseThatAnEffectDeclares) {
  using enum integrators::ParameterLaw;
  const auto law = [](const std::string& effect, const char* by) {
    const Scene scene = parse_scene(
        "title = \"t\"\nduration_s = 0.1\n[integrator]\nid = \"backward_euler\"\ndt_s = "
        "0.002\n[strand]\nelements = 4\n[root]\n" +
            effect + "[gradient]\nby = [\"" + by + "\"]\n",
        "s.toml");
    return gradient_parameters(scene).front().law;
  };
  const std::string body = "[effects.body]\ncentre_m = [0, 0, -1]\ndamping_s_m = 1\n",
                    wind = "[effects.wind]\nvelocity_m_s = [1, 0, 0]\n",
                    exact = "friction_law = \"exact\"\n";
  EXPECT_EQ(law("[effects.gravity]\n", "gravity.gravity_m_s2.z"), smooth);
  EXPECT_EQ(law("[effects.gravity]\n", "youngs_modulus_pa"), smooth);
  EXPECT_EQ(law("[effects.linear_drag]\n", "linear_drag.drag_kg_m_s"), smooth);
  EXPECT_EQ(law(wind, "wind.velocity_m_s.x"), affine);
  EXPECT_EQ(law(wind + "law = \"quadratic\"\n", "wind.velocity_m_s.x"), unknown);
  EXPECT_EQ(law(wind + "profile = \"gusts\"\n", "wind.velocity_m_s.x"), unknown);
  EXPECT_EQ(law(wind + "profile = \"sine\"\n", "wind.velocity_m_s.x"), affine);
  EXPECT_EQ(law(body, "body.stiffness_n_m2"), affine);
  EXPECT_EQ(law(body + exact, "body.stiffness_n_m2"), unknown);
  EXPECT_EQ(law(body, "body.damping_s_m"), unknown);
  EXPECT_EQ(law(body, "body.slip_speed_m_s"), unknown);
}

}  // namespace tress::test_law_gradient
