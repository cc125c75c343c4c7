// Rods of quaternions in rotation vectors (models/quaternion_rods/rotation_vectors.h).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "contract/forms/moving_history.h"
#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "integrators/catalogue.h"
#include "models/effects/exact_body.h"
#include "models/effects/gravity.h"
#include "models/effects/self_contact.h"
#include "models/quaternion_rods/conformal_rotation.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/maximal/vector_rods.h"
#include "tests/support/apart.h"

namespace tress::test_rotation_vectors {

using namespace experiments;

using namespace testing_support;

std::vector<double> four(const Quaternion& q) {
  std::vector<double> all(4);
  store_quaternion(q, all.data());
  return all;
}

TEST(ConformalRotation, IsARotationByFourTimesTheArcTangent) {
  for (const Vec& c : {Vec{0.3, -0.2, 0.1}, Vec{2, -1, 4}, Vec{}}) {
    const ConformalRotation turn(c);
    const Quaternion p = turn.value();
    EXPECT_NEAR(dot(p, p), 1, 4e-16);
    EXPECT_NEAR(2 * std::acos(p.w), 4 * std::atan(norm(c) / 4), 1e-15 * 8);
    EXPECT_LE(norm(cross(p.v, c)), 1e-15 * 8);
    EXPECT_LE(norm(ConformalRotation::vector(p) - c), 1e-15 * 8);
  }
}

// Differences of fourth order over 7.4e-4 leave some 3e-13 (catalogue_cases.h).
TEST(ConformalRotation, DerivativesAreThoseOfDifferences) {
  const Vec c{0.9, -1.2, 0.4}, x{1, 0.5, -0.7}, y{-0.3, 0.8, 1};
  const auto along = [&](const Vec& direction, auto of) {
    return central_difference(difference_step, [&](double e) {
      return four(of(ConformalRotation(c + e * direction)));
    });
  };
  const ConformalRotation turn(c);
  EXPECT_LE(apart(four(turn.slope(x)), along(x, [](const auto& t) { return t.value(); })),
            3e-12);
  EXPECT_LE(
      apart(four(turn.second(x, y)), along(y, [&](const auto& t) { return t.slope(x); })),
      3e-12);
  EXPECT_LE(apart(four(turn.third(x, y)),
                  along(y, [&](const auto& t) { return t.second(x, x); })),
            3e-12);
  EXPECT_NEAR(dot(turn.slope(x), turn.slope(x)), turn.scale() * turn.scale() * dot(x, x),
              1e-15);
  EXPECT_NEAR(dot(turn.slope(x), turn.value()), 0, 1e-15);
  EXPECT_LE(norm(turn.rate(turn.slope(x)) - x), 1e-14);
}

class RotationVectorRods : public VectorRods {};

TEST_P(RotationVectorRods, TangentIsExactWithFrictionOnATurningRoot) {
  const auto system = make({{"elements", "6"},
                            {"motion", "shake_rotate"},
                            {"internal_friction_kg_m3_s", "1e-7"},
                            {"natural_curvature_per_m", "40"},
                            {"natural_twist_per_m", "20"},
                            {"ellipticity", "1.3"}});
  States s(*system);
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
    s.shake(0.05);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance);
  }
}

/// A motion of the past in new coordinates: carried rates are the derivatives of carried
/// positions, and carried accelerations those of the rates. Central differences over s
/// err by s^2/6 of third derivatives: rates are of 1/s to 1e2/s.
TEST_P(RotationVectorRods, CarryAMotionIntoNewCoordinates) {
  const auto system = make({{"elements", "4"}, {"motion", "free"}});
  State state = initial_state(*system);
  std::vector<double> a(state.q.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double phase = 1.7 * static_cast<double>(k);
    if (k >= 15) state.q[k] = 0.9 * std::sin(phase);
    state.v[k] = 3 * std::cos(phase);
    a[k] = 20 * std::sin(2 * phase);
  }
  const State before = state;
  ASSERT_TRUE(system->accept(0, state.q, state.v));
  struct Motion {
    std::vector<double> q, v, a;
  };
  const auto carried = [&](double time) {
    Motion m{before.q, before.v, a};
    for (std::size_t k = 0; k < a.size(); ++k) {
      m.q[k] += time * before.v[k] + time * time / 2 * a[k];
      m.v[k] += time * a[k];
    }
    EXPECT_TRUE(tress::carry(*system, time, m.q, m.v, m.a));
    return m;
  };
  constexpr double step = 1e-4;
  const Motion now = carried(0), later = carried(step), earlier = carried(-step);
  EXPECT_LE(apart(now.q, state.q), 1e-14);
  EXPECT_LE(apart(now.v, state.v), 1e-14 * 10);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR((later.q[k] - earlier.q[k]) / (2 * step), now.v[k], 2e-5);
    EXPECT_NEAR((later.v[k] - earlier.v[k]) / (2 * step), now.a[k], 2e-4);
  }
  EXPECT_GT(apart(now.a, a), 1);
}

// A soft curl thrown into space. Steps resolve its stiffest oscillations: of edges
// against their shear, sqrt(0.9 GA/(2 rho I)) = 7e3 rad/s, and of frames against their
// edges.
TEST_P(RotationVectorRods, GeneralizedAlphaHasOrder2) {
  const ModelSettings thrown = {{"elements", "10"},
                                {"motion", "free"},
                                {"gravity_m_s2", "0"},
                                {"youngs_modulus_pa", "1e5"},
                                {"radius_m", "1e-3"},
                                {"natural_curvature_per_m", "20"},
                                {"natural_twist_per_m", "10"},
                                {"initial", "straight"}};
  std::vector<double> stops;
  for (int k = 1; k <= 10; ++k) stops.push_back(0.002 * k);
  const auto path = [&](const char* integrator, double step) {
    const auto system = make(thrown);
    Options options;
    options.step = step;
    options.newton_tolerance = 1e-12;
    std::vector<double> all, x(33);
    const Simulation run = simulate(integrator, *system, options, initial_state(*system),
                                    stops, [&](const State& state) {
                                      system->material_points()->positions(0, state.q, x);
                                      all.insert(all.end(), x.begin(), x.end());
                                    });
    EXPECT_EQ(run.status, Status::ok) << run.failure;
    return all;
  };
  const std::vector<double> exact = path("esdirk43", 1e-5);
  std::vector<double> steps, errors;
  for (const double step : {5e-5, 2.5e-5, 1.25e-5}) {
    const std::vector<double> x = path("generalized_alpha", step);
    ASSERT_EQ(x.size(), exact.size());
    double square = 0;
    for (std::size_t k = 0; k < x.size(); ++k) square += std::pow(x[k] - exact[k], 2);
    steps.push_back(step);
    errors.push_back(std::sqrt(square / static_cast<double>(stops.size())));
    std::printf("%s, renewal %s, step %g s: points off by %.2e m\n", GetParam().model,
                GetParam().renewal, step, errors.back());
  }
  // At the longest step, h omega is 0.4 and the next order a sixth of the leading one.
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Maximal, RotationVectorRods, vector_rods(), name_of);

/// The penalty softens joints by 2 (u l)^2/(coupling + norm) (corde.cpp), by 2 (u l)^2/
/// norm in xpbd_cosserat: without it a rod is the limit of stiff penalties, at order 1.
TEST(RotationVectorRod, IsTheLimitOfStiffPenalties) {
  for (const std::string model : {"corde", "xpbd_cosserat"}) {
    const auto tip = [&](const ModelSettings& more) {
      return points(hang(model, with(with(thin_rod, {{"elements", "10"}}), more),
                         10 / line_density, at_rest, 1.1));
    };
    const std::vector<double> limit = tip(rotations);
    std::vector<double> norms, distances;
    for (const char* norm : {"1e4", "1e5", "1e6"}) {
      norms.push_back(std::stod(norm));
      distances.push_back(apart(tip({{"norm", norm}}), limit));
      std::printf("%s, norm %s: points differ by %.2e m\n", model.c_str(), norm,
                  distances.back());
    }
    // The next order is coupling/norm = 100/1e4 of the leading one.
    EXPECT_NEAR(log_log_slope(norms, distances), -1, 0.02);
    EXPECT_LE(apart(tip(with(rotations, {{"norm", "1e4"}})), limit), 1e-9);
  }
}

TEST(RotationVectorRod, RefusesWhatNeedsQuaternions) {
  const auto system = make_model("corde", rotations);
  EXPECT_NE(refusal(find_integrator("xpbd"), *system, Formulation::parametric), "");
  EXPECT_EQ(
      refusal(find_integrator("generalized_alpha"), *system, Formulation::parametric),
      "");
  const auto message = [](std::shared_ptr<const Effect> effect) -> std::string {
    const Parameters parameters = parameters_of("corde", rotations);
    try {
      static_cast<void>(find_model("corde").on_strand(strand(parameters), parameters,
                                                      {std::move(effect)}));
    } catch (const InputError& no) {
      return no.what();
    }
    return "";
  };
  const ContactLaw law({.stiffness = 1, .viscosity = 0, .inner = 1e-3, .outer = 2e-3},
                       "test");
  EXPECT_THAT(message(std::make_shared<SelfContact>(law, 0.01)),
              testing::HasSubstr("contact of a strand with itself"));
  EXPECT_THAT(message(std::make_shared<ExactBody>(
                  Plane{}, StrandPlace{},
                  ExactContact{{.stiffness = 1, .damping = 0, .offset = 0}, true, 0, 0})),
              testing::HasSubstr("exact contact"));
  EXPECT_EQ(message(std::make_shared<Gravity>(Vec{0, 0, -9.81})), "");
}

}  // namespace tress::test_rotation_vectors
