// Norms of quaternions held by a penalty, and exact ones of rotation vectors.
#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>
#include <numbers>

#include "contract/forms/energetics.h"
#include "experiments/numerics/fit.h"
#include "tests/models/maximal/vector_rods.h"

namespace tress::test_quaternion_norms {

using namespace experiments;

using namespace testing_support;

/// A stiff short rod in free flight turns as a symmetric top: its axis goes round the
/// angular momentum L at the rate |L|/I. Frames have the same inertia J about each axis.
/// Centrifugal stretch is rho omega^2 length^2/E = 4e-8, and changes I by twice that.
struct Top {
  double step;
  double error;     // of the direction of the rod, rad
  double momentum;  // relative drift
  double norm;      // of quaternions, largest distance from 1
  Stats stats;
};
Top spin(const std::string& model, const ModelSettings& more, double step) {
  constexpr double duration = 0.6;
  const auto system = make_model(model, with({{"elements", "4"},
                                              {"motion", "free"},
                                              {"gravity_m_s2", "0"},
                                              {"length_m", "0.02"},
                                              {"radius_m", "2e-3"},
                                              {"density_kg_m3", "1000"},
                                              {"youngs_modulus_pa", "1e9"},
                                              {"internal_friction_kg_m3_s", "0"},
                                              {"spin_rad_s", "10"}},
                                             more));
  State start{zeros(*system), zeros(*system)};
  system->initial_state(start.q, start.v);
  const auto axis_of = [&](In q) {
    std::vector<double> x(15);
    system->material_points()->positions(0, q, x);
    const Vec along = load3(&x[12]) - load3(x.data());
    return (1 / norm(along)) * along;
  };
  const Momentum was = system->energetics()->momentum(0, start.q, start.v).value();
  std::vector<double> places(15);
  system->material_points()->positions(0, start.q, places);
  Vec centre;
  for (std::size_t i = 0; i < 5; ++i) {
    centre = centre + (i % 4 == 0 ? 0.125 : 0.25) * load3(&places[3 * i]);
  }
  const Vec before = axis_of(start.q),
            l = load3(was.angular.data()) - cross(centre, load3(was.linear.data()));
  const double j = 1000 * std::numbers::pi * 8e-12 * 0.005 * 4;  // 2 rho I l, four edges
  const double m = 1000 * std::numbers::pi * 4e-6 * 0.005;
  const double across = m * (0.5 * 2 * 1e-4 + 2 * 0.25e-4) + j;
  const double turned = norm(l) / across * duration;
  const Vec u = (1 / norm(l)) * l;
  const Vec want = std::cos(turned) * before + std::sin(turned) * cross(u, before) +
                   ((1 - std::cos(turned)) * dot(u, before)) * u;
  Options options;
  options.step = step;
  options.newton_tolerance = 1e-12;
  Top top{step, 0, 0, 0, {}};
  const Simulation run = simulate("generalized_alpha", *system, options, start, duration,
                                  norm_watcher(*system, 4, top.norm));
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  const Momentum now =
      system->energetics()->momentum(duration, run.state.q, run.state.v).value();
  top.momentum = norm(load3(now.angular.data()) - load3(was.angular.data())) / norm(l);
  top.error = norm(axis_of(run.state.q) - want);
  top.stats = run.stats;
  return top;
}

class SpinningRods : public VectorRods {};

TEST_P(SpinningRods, FreeRodTurnsAsATopAtOrder2) {
  std::vector<double> steps, errors, momenta;
  for (const double step : {0.01, 0.005, 0.0025, 0.00125}) {
    const Top top = spin(GetParam().model, chosen({}), step);
    const Top penalty = spin(GetParam().model, {}, step);
    for (const auto& [name, one] :
         {std::pair{GetParam().renewal, &top}, {"quaternions", &penalty}}) {
      std::printf(
          "%s, %s, step %g s: axis off by %.2e, momentum by %.2e, norms by %.1e, "
          "%ld corrections\n",
          GetParam().model, name, step, one->error, one->momentum, one->norm,
          one->stats.newton_iterations);
    }
    steps.push_back(step);
    errors.push_back(top.error);
    momenta.push_back(top.momentum);
    EXPECT_LE(top.norm, 8 * eps);  // two products of four numbers
    // The curvature of the flight is the same in both coordinates.
    EXPECT_NEAR(top.error, penalty.error, 0.05 * penalty.error);
  }
  // The next order is (h omega)^2 = 1 % of the leading one at the longest step.
  EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.05);
  EXPECT_NEAR(log_log_slope(steps, momenta), 2, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Maximal, SpinningRods, vector_rods(), name_of);

/// Strands of 20 elements whose root moves by 5 cm at 3 Hz, for 0.5 s.
struct Shaken {
  const char* name;
  ModelSettings settings;
  double reference;  // step of esdirk43, s
};
const Shaken hair = {"hair",
                     {{"motion", "shake"},
                      {"radius_m", "4e-5"},
                      {"youngs_modulus_pa", "3.9e9"},
                      {"density_kg_m3", "1300"},
                      {"internal_friction_kg_m3_s", "1e-10"}},
                     2.5e-4};
/// Undamped; its root turns as well.
const Shaken rubber = {"rubber",
                       {{"motion", "shake_rotate"},
                        {"radius_m", "1e-3"},
                        {"youngs_modulus_pa", "1e7"},
                        {"density_kg_m3", "1000"},
                        {"internal_friction_kg_m3_s", "0"}},
                       2e-4};

struct ShakenRun {
  Vec tip;
  double norm = 0, time = 0;  // largest distance of norms from 1; s of the processor
  Stats stats;
};
ShakenRun shaken(const std::string& model, const Shaken& of, const ModelSettings& more,
                 const char* integrator, double step) {
  constexpr double duration = 0.5;
  const ModelSettings curl = {{"length_m", "0.2"},
                              {"elements", "20"},
                              {"natural_curvature_per_m", "20"},
                              {"natural_twist_per_m", "5"}};
  const auto system = make_model(model, with(with(curl, of.settings), more));
  Options options;
  options.step = step;
  ShakenRun all;
  const std::clock_t begin = std::clock();
  const Simulation run = simulate(integrator, *system, options, initial_state(*system),
                                  duration, norm_watcher(*system, 20, all.norm));
  all.time = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  all.stats = run.stats;
  std::vector<double> x(63);
  system->material_points()->positions(duration, run.state.q, x);
  all.tip = load3(&x[60]);
  return all;
}

/// Runs of generalized_alpha against one of esdirk43 in the same coordinates; the
/// comparison on the page docs/theory/models/quaternion_rods.md.
struct Compared {
  double error;  // of the tip, m
  ShakenRun run;
};
std::vector<Compared> compared(const std::string& model, const Shaken& of,
                               const ModelSettings& more,
                               const std::vector<double>& steps) {
  const Vec exact = shaken(model, of, more, "esdirk43", of.reference).tip;
  std::vector<Compared> all;
  for (const double step : steps) {
    const ShakenRun run = shaken(model, of, more, "generalized_alpha", step);
    all.push_back({norm(run.tip - exact), run});
    std::printf(
        "%s %s, %s, step %g s: tip off by %.2e m, norms by %.1e, %ld corrections, "
        "%.0f ms\n",
        of.name, model.c_str(), more.empty() ? "quaternions" : "rotation vectors", step,
        all.back().error, run.norm, run.stats.newton_iterations, 1e3 * run.time);
  }
  return all;
}

TEST(QuaternionNorms, AreExactInRotationVectorsWithTheSameErrorOnAHair) {
  for (const char* model : {"corde", "xpbd_cosserat"}) {
    const std::vector<double> steps = {4e-3, 1e-3};
    const std::vector<Compared> penalty = compared(model, hair, {}, steps),
                                vectors = compared(model, hair, rotations, steps);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      EXPECT_LE(vectors[k].run.norm, 8 * eps);
      EXPECT_GT(penalty[k].run.norm, 1e-3);
      // The penalty softens the rod by 2e-2 (u l)^2, u l = 0.2.
      EXPECT_NEAR(vectors[k].error, penalty[k].error, 0.1 * penalty[k].error);
    }
  }
}

// The penalty lets a frame pass through the quaternion 0, where it has no direction.
TEST(QuaternionNorms, CollapseWhereARodIsShakenHard) {
  const Compared penalty = compared("corde", rubber, {}, {5e-4}).front(),
                 vectors = compared("corde", rubber, rotations, {5e-4}).front();
  EXPECT_GT(penalty.run.norm, 0.5);
  EXPECT_LE(vectors.run.norm, 8 * eps);
  EXPECT_LT(vectors.error, 0.5 * penalty.error);
}

}  // namespace tress::test_quaternion_norms
