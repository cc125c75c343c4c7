#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/input_error.h"
#include "models/catalogue.h"
#include "models/strand/strand_parameters.h"
#include "tests/models/strand/parameters_for.h"

namespace tress::test_strand_parameters {

using namespace models;

using std::numbers::pi;
using testing_support::root_choices;
using testing_support::Settings;
using testing_support::strand_parameters;
using testing_support::tangent_choices;

constexpr double eps = std::numeric_limits<double>::epsilon();

void expect_near(const Vec& a, const Vec& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

RootPose pose_of(const Settings& settings, double t) {
  return root_motion(strand_parameters(settings)).at(t);
}

TEST(StrandParameters, DefaultsAreAHairOfTenCentimetres) {
  const Strand s = strand(strand_parameters({}));
  ASSERT_EQ(s.segments.size(), 20u);
  EXPECT_DOUBLE_EQ(s.length(), 0.1);
  EXPECT_DOUBLE_EQ(s.segments.front().length, s.segments.back().length);
  EXPECT_DOUBLE_EQ(s.segments[7].section.a1, 40e-6);
  EXPECT_DOUBLE_EQ(s.segments[7].section.a2, 40e-6);
  EXPECT_EQ(s.material.youngs_modulus, 3e9);
  EXPECT_DOUBLE_EQ(s.material.shear_modulus, 3e9 / 2.96);
  EXPECT_EQ(s.material.density, 1300);
  EXPECT_EQ(s.material.internal_friction, 0);
  for (const Segment& segment : s.segments) {
    expect_near(segment.natural, {}, 0);
    expect_near(segment.initial, {}, 0);
  }
  EXPECT_TRUE(s.root.fixed());
  EXPECT_FALSE(s.free_root.has_value());
}

TEST(StrandParameters, EveryChoiceBuilds) {
  for (const auto root : root_choices) {
    for (const auto tangent : tangent_choices) {
      for (const auto initial : {"natural", "straight", "bent"}) {
        const Strand s = strand(strand_parameters(
            {{"motion", root}, {"root_tangent", tangent}, {"initial", initial}}));
        EXPECT_NO_THROW(check(s));
        EXPECT_EQ(s.free_root.has_value(), root == "free");
        EXPECT_EQ(s.root.fixed(), root == "free" || root == "fixed");
      }
    }
  }
}

TEST(StrandParameters, AreNoModelsOwn) {
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    const Parameters own(model.parameters, "own"), all(setup_parameters(model), "all");
    for (const Parameter& p : models::strand_parameters()) {
      EXPECT_FALSE(own.knows(p.name)) << model.id << ' ' << p.name;
      EXPECT_TRUE(all.knows(p.name)) << model.id << ' ' << p.name;
    }
    for (const Parameter& p : model.parameters) EXPECT_TRUE(all.knows(p.name)) << p.name;
  }
}

TEST(StrandParameters, MaterialComesWithoutGeometry) {
  const Parameters p(material_parameters(), "model tree");
  for (const auto geometry :
       {"elements", "length_m", "grading", "radius_m", "ellipticity",
        "natural_curvature_per_m", "natural_curvature2_per_m", "natural_twist_per_m",
        "initial", "initial_curvature_per_m"}) {
    EXPECT_FALSE(p.knows(geometry)) << geometry;
    EXPECT_TRUE(strand_parameters({}).knows(geometry)) << geometry;
  }
  EXPECT_NO_THROW(check(material(p), "material"));
  EXPECT_NO_THROW(check(root_motion(p), "root"));
  EXPECT_FALSE(free_root(p).has_value());
  EXPECT_EQ(strand_effects(p).size(), 1u);
}

TEST(StrandParameters, MaterialAndCutAreTaken) {
  const Strand s = strand(strand_parameters({{"elements", "5"},
                                             {"length_m", "0.4"},
                                             {"grading", "2"},
                                             {"youngs_modulus_pa", "2e9"},
                                             {"poisson_ratio", "0.25"},
                                             {"density_kg_m3", "900"},
                                             {"internal_friction_kg_m3_s", "1e-10"}}));
  ASSERT_EQ(s.segments.size(), 5u);
  EXPECT_DOUBLE_EQ(s.length(), 0.4);
  EXPECT_NEAR(s.segments[4].length / s.segments[0].length, 2, 40 * eps);
  EXPECT_EQ(s.material.youngs_modulus, 2e9);
  EXPECT_DOUBLE_EQ(s.material.shear_modulus, 0.8e9);
  EXPECT_EQ(s.material.density, 900);
  EXPECT_EQ(s.material.internal_friction, 1e-10);
}

TEST(StrandParameters, EllipticityKeepsTheArea) {
  const CrossSection section =
      strand(strand_parameters({{"radius_m", "1e-3"}, {"ellipticity", "4"}}))
          .segments[0]
          .section;
  EXPECT_DOUBLE_EQ(section.a1, 2e-3);
  EXPECT_DOUBLE_EQ(section.a2, 0.5e-3);
}

TEST(StrandParameters, ShapesAreNaturalStraightOrBent) {
  const auto first = [](std::string_view initial) {
    return strand(strand_parameters({{"natural_twist_per_m", "2"},
                                     {"natural_curvature_per_m", "30"},
                                     {"natural_curvature2_per_m", "-4"},
                                     {"initial_curvature_per_m", "10"},
                                     {"initial", initial}}))
        .segments[0];
  };
  const double rounding = 8 * eps * 40;  // weights that add up to 1
  expect_near(first("natural").natural, {2, 30, -4}, rounding);
  expect_near(first("natural").initial, {2, 30, -4}, rounding);
  expect_near(first("straight").natural, {2, 30, -4}, rounding);
  expect_near(first("straight").initial, {}, 0);
  expect_near(first("bent").natural, {2, 30, -4}, rounding);
  expect_near(first("bent").initial, {2, 40, -4}, rounding);
}

TEST(StrandParameters, CurvatureAboutE1BendsInTheVerticalPlane) {
  const Vec tangents[] = {{1, 0, 0}, {0, 0, -1}, {0, 0, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Frame frame = pose_of({{"root_tangent", tangent_choices[i]}}, 0).frame;
    expect_near(frame.e0, tangents[i], 0);
    expect_near(frame.e1, {0, 1, 0}, 0);
    EXPECT_TRUE(is_rotation(frame));
  }
}

TEST(StrandParameters, ShakeIsASineSideways) {
  const double quarter = 1.0 / 12;  // of the period at 3 Hz
  for (const auto root : {"shake", "shake_rotate"}) {
    const Settings still = {{"motion", root}, {"angle_rad", "0"}};
    // one rounding of the centre: 0.1 eps
    expect_near(pose_of(still, quarter).x, {0, 0.05, 0}, eps);
    expect_near(pose_of(still, 0).v, {0, 0.05 * 6 * pi, 0}, 4 * eps);
  }
  expect_near(pose_of({{"motion", "shake"}, {"root_tangent", "down"}}, quarter).x,
              {0.05, 0, 0}, eps);
  expect_near(pose_of({{"motion", "shake"}, {"root_tangent", "up"}}, quarter).x,
              {0.05, 0, 0}, eps);
}

TEST(StrandParameters, HeadTurnsTheRootOnACircleAboutTheVertical) {
  const RootPose pose = pose_of({{"motion", "rotate"}}, 1.0 / 12);  // angle 0.5
  expect_near(pose.x, {0.1 * (std::cos(0.5) - 1), 0.1 * std::sin(0.5), 0}, eps);
  expect_near(pose.frame.e0, {std::cos(0.5), std::sin(0.5), 0}, 4 * eps);
  const RootPose both = pose_of({{"motion", "shake_rotate"}}, 1.0 / 12);
  expect_near(both.x - pose.x, {0, 0.05, 0}, eps);
  expect_near(both.frame.e0, pose.frame.e0, 0);
}

TEST(StrandParameters, SwingStartsFromRestAlongY) {
  const Settings swing = {{"motion", "swing"}, {"frequency_hz", "1"}};
  expect_near(pose_of(swing, 0).x, {}, 0);
  expect_near(pose_of(swing, 0).v, {}, 0);
  expect_near(pose_of(swing, 0.5).x, {0, 0.1, 0}, eps);
}

TEST(StrandParameters, StopComesToRestInItsTime) {
  expect_near(pose_of({{"motion", "stop"}}, 0).v, {0, 5, 0}, 0);
  expect_near(pose_of({{"motion", "stop"}}, 0.01).v, {}, 0);
  expect_near(pose_of({{"motion", "stop"}}, 1).x, {0, 5 * 0.01 / 2, 0}, eps);
  expect_near(pose_of({{"motion", "stop"}, {"root_tangent", "down"}}, 0).v, {5, 0, 0}, 0);
}

TEST(StrandParameters, DropPullFallsRisesAndRests) {
  const Settings drop = {{"motion", "drop_pull"}, {"frequency_hz", "2"}};
  expect_near(pose_of(drop, 0).x, {}, 0);
  expect_near(pose_of(drop, 0.125).x, {0, 0, -0.025}, eps);
  expect_near(pose_of(drop, 0.25).x, {0, 0, -0.05}, eps);
  expect_near(pose_of(drop, 0.25).v, {}, 0);
  for (const double t : {0.5, 2.0}) {
    expect_near(pose_of(drop, t).x, {}, eps);
    expect_near(pose_of(drop, t).v, {}, 0);
  }
}

TEST(StrandParameters, FreeRootSpinsAboutTheDiagonal) {
  const FreeRoot root =
      *free_root(strand_parameters({{"motion", "free"}, {"root_tangent", "down"}}));
  expect_near(root.position, {}, 0);
  expect_near(root.velocity, {}, 0);
  EXPECT_DOUBLE_EQ(dot(root.spin, root.spin), 100);
  EXPECT_EQ(root.spin.x, root.spin.y);
  EXPECT_EQ(root.spin.x, root.spin.z);
  EXPECT_GT(root.spin.x, 0);
  expect_near(root.frame.e0, {0, 0, -1}, 0);
}

/// Load on one point of 2 kg and 0.5 m that moves at (1, 2, 3) m/s.
Vec load_of(const Settings& settings) {
  const std::vector<double> x(3), v{1, 2, 3}, mass{2}, length{0.5};
  std::vector<double> load(3);
  for (const auto& effect : strand_effects(strand_parameters(settings))) {
    effect->add_load(0, {1, x, v, {}, mass, length}, load);
  }
  return load3(load.data());
}

TEST(StrandParameters, EffectsAreGravityDragAndMassDamping) {
  expect_near(load_of({}), {0, 0, -2 * 9.81}, 0);
  expect_near(load_of({{"gravity_m_s2", "0"}, {"drag_kg_m_s", "4"}}), {-2, -4, -6}, 0);
  expect_near(load_of({{"gravity_m_s2", "0"}, {"mass_damping_per_s", "3"}}),
              {-6, -12, -18}, 0);
  expect_near(load_of({{"drag_kg_m_s", "4"}, {"mass_damping_per_s", "3"}}),
              {-8, -16, -24 - 2 * 9.81}, 100 * eps);
  EXPECT_TRUE(strand_effects(strand_parameters({{"gravity_m_s2", "0"}})).empty());
}

TEST(StrandParameters, RefuseNumbersOutsideTheirMeaning) {
  const Settings bad = {{"elements", "0"},        {"elements", "10001"},
                        {"elements", "2.5"},      {"length_m", "0"},
                        {"length_m", "-1"},       {"length_m", "nan"},
                        {"grading", "0"},         {"radius_m", "0"},
                        {"ellipticity", "-1"},    {"youngs_modulus_pa", "0"},
                        {"poisson_ratio", "0.6"}, {"density_kg_m3", "0"},
                        {"frequency_hz", "0"},    {"time_s", "0"},
                        {"drag_kg_m_s", "-1"},    {"mass_damping_per_s", "-1"},
                        {"motion", "wobble"},     {"root_tangent", "y"},
                        {"initial", "curly"},     {"internal_friction_kg_m3_s", "-1"}};
  for (const auto& setting : bad) {
    EXPECT_THROW(strand_parameters({setting}), InputError) << setting.first;
  }
  EXPECT_THROW(strand(strand_parameters({{"poisson_ratio", "-1"}})), InputError);
}

TEST(StrandParameters, ShearModulusTakesThePlaceOfPoissonsRatio) {
  const Strand s = strand(strand_parameters({{"shear_modulus_pa", "0.87e9"}}));
  EXPECT_EQ(s.material.shear_modulus, 0.87e9);
  EXPECT_EQ(s.material.youngs_modulus, 3e9);
  EXPECT_THROW(
      strand(strand_parameters({{"shear_modulus_pa", "1e9"}, {"poisson_ratio", "0.3"}})),
      InputError);
}

/// A clamped rod of n elements whose tip is turned by an angle about its axis has the
/// torsional energy G J angle^2/(2 L): here the straight shape of one whose natural shape
/// is twisted. Joints between n elements see the twist on (n - 1/2)/n of the length or on
/// all of it; a rate of twist of angle/n per joint is off by its square over 12 where
/// models take sines of half angles: 2e-6 here.
TEST(StrandParameters, ShearModulusAloneResistsTwistInEveryModelThatTwists) {
  constexpr double radius = 50e-6, ellipticity = 1.5, length = 0.2, twist = 0.5;
  constexpr double shear = 0.4e9;
  constexpr int elements = 20;
  const double a1 = radius * std::sqrt(ellipticity), a2 = radius / std::sqrt(ellipticity);
  const double torsion = pi * std::pow(a1 * a2, 3) / (a1 * a1 + a2 * a2);  // Saint-Venant
  const double energy = shear * torsion * twist * twist * length / 2;
  const auto stored = [&](std::string_view model, std::string_view youngs_modulus) {
    const ModelEntry& entry = find_model(model);
    Parameters p(setup_parameters(entry), "model");
    for (const auto& [key, value] : Settings{{"elements", "20"},
                                             {"length_m", "0.2"},
                                             {"radius_m", "50e-6"},
                                             {"ellipticity", "1.5"},
                                             {"youngs_modulus_pa", youngs_modulus},
                                             {"shear_modulus_pa", "0.4e9"},
                                             {"natural_twist_per_m", "0.5"},
                                             {"initial", "straight"},
                                             {"gravity_m_s2", "0"},
                                             {"modes", "bend_twist"}}) {
      if (p.knows(key)) p.set(key, value);
    }
    const auto system = entry.make(p);
    const auto count = static_cast<std::size_t>(system->layout().coordinates);
    std::vector<double> q(count), v(count);
    system->initial_state(q, v);
    return system->energetics()->energy(0, q, v).potential;
  };
  for (const std::string_view model :
       {"super_helix", "super_clothoid", "articulated_chain", "force_transport", "der",
        "corde", "xpbd_cosserat", "dynamic_spline", "kirchhoff_nodal"}) {
    const double soft = stored(model, "1e9");
    EXPECT_NEAR(soft / energy, 1, 0.5 / elements + 2e-6) << model;
    // E has no part in it.
    EXPECT_NEAR(stored(model, "4e9") / soft, 1, 1e-9) << model;
  }
}

}  // namespace tress::test_strand_parameters
