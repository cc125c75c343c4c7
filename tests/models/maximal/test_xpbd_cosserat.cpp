#include <gtest/gtest.h>

#include "experiments/problems/strand_models.h"
#include "models/quaternion_rods/cosserat_edge.h"
#include "tests/models/maximal/quaternion_rods.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"
#include "tests/support/compliance.h"

namespace tress::test_xpbd_cosserat {

using namespace experiments;

using namespace testing_support;

TEST(XpbdCosserat, ForcesAreTheGradientOfTheEnergy) {
  expect_forces_of_energy(CosseratEdge{1, {2, 0.7, 0.8, 0.9}, {}});
}

// R is a rotation whatever the norm: a longer quaternion neither stretches nor shears.
TEST(XpbdCosserat, NormsDoNotStrainEdges) {
  const CosseratEdge edge{2, {}, {}};
  const Quaternion q = quaternion_of(rotation({0.48, 0.6, 0.64}, 0.8));
  double x[7], s[4], of_longer[4];
  store3(2.2 * rotation({0, 0.6, 0.8}, 0.5).e0, x);
  store_quaternion(q, x + 3);
  edge.strain(x, s);
  store_quaternion(1.5 * q, x + 3);
  edge.strain(x, of_longer);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(of_longer[k], s[k], 1e-15 * 10);
  const Vec stretched{s[0] + 1, s[1], s[2]};
  EXPECT_NEAR(norm(stretched), 1.1, 1e-15 * 10);
  EXPECT_NEAR(of_longer[3], 1.25, 1e-15 * 10);
}

// The weight behind an edge, Gamma (1 - s), shears it by Gamma (1 - s)/(k GA): the tip
// hangs Gamma/(2 k GA) lower, of Gamma/8. With half weights at the ends the sum over
// edges is the integral.
TEST(XpbdCosserat, ShearLowersTheTip) {
  const Master light{0.1, 0.99991072, 0.01249843798};
  const double ga = 4e6 / (2 * 1.4);  // Poisson's ratio of thin_rod is 0.4
  const auto height = [&](const char* factor, int n) {
    const Hung hung =
        hang("xpbd_cosserat",
             with(thin_rod, {{"shear_factor", factor}, {"elements", std::to_string(n)}}),
             light.gamma / line_density, at_rest);
    return -points(hung).back();
  };
  for (const int n : {5, 10}) {
    const double lowered = height("1e-4", n) - height("1", n);
    // The weight's own nonlinearity as in test_corde.cpp; rounding at_rest of 1e-3.
    EXPECT_NEAR(lowered / (light.gamma / (2 * ga) * (1e4 - 1)), 1, 1e-3);
  }
}

// A hanging rod is longer by Gamma/(2 EA) of its length, the sum over edges being the
// integral as above.
TEST(XpbdCosserat, SoftenedItStretchesByItsWeight) {
  constexpr double gamma = 0.1, ea = 4e6;
  const auto lowest = [&](const char* factor) {
    const Hung hung = hang(
        "xpbd_cosserat",
        with(thin_rod,
             {{"stretch_factor", factor}, {"root_tangent", "down"}, {"elements", "5"}}),
        gamma / line_density, at_rest);
    return -points(hung).back();
  };
  const double longer = lowest("1e-5") - lowest("1");
  EXPECT_NEAR(longer / (gamma / (2 * ea) * (1e5 - 1)), 1, 1e-3);
}

// The form that xpbd takes holds friction and a turning root, too.
TEST(XpbdCosserat, ComplianceFormIsTheResidualWithFrictionOnATurningRoot) {
  const ModelSettings moving = {{"elements", "6"},
                                {"motion", "shake_rotate"},
                                {"mass_damping_per_s", "2"},
                                {"internal_friction_kg_m3_s", "1e-7"},
                                {"natural_curvature_per_m", "40"},
                                {"natural_twist_per_m", "20"},
                                {"ellipticity", "1.3"}};
  for (const char* model : {"xpbd_cosserat", "corde", "mass_spring"}) {
    const auto system = make_model(
        model, known_to(find_model(model), with(moving, {{"stretch_friction_n_s", "1e-3"},
                                                         {"torsion", "altitude"}})));
    States s(*system);
    s.shake(0.05);
    EXPECT_LE(compliance_error(*system, *system->compliance_form(), s), 1e-12) << model;
  }
}

}  // namespace tress::test_xpbd_cosserat
