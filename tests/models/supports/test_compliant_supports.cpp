// Compliant supports against closed forms: a beam on a spring, a stiff bar on two
// springs, and the limit of a rigid support.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/numerics/fit.h"
#include "integrators/catalogue.h"
#include "simulation/rest/supported_start.h"
#include "tests/models/supports/driven_strand.h"
#include "tests/support/small_motion.h"

namespace tress::test_compliant_supports {

using namespace testing_support;

constexpr double length = 0.1, radius = 1e-4, modulus = 3e9, gravity = 9.81;
const double area = std::numbers::pi * radius * radius;
const double bending = modulus * area * radius * radius / 4;

Vec force_of(SupportedSystem& system, In q, std::size_t support) {
  std::vector<double> forces(3 * system.supports()), moments = forces, v(q.size());
  EXPECT_EQ(system.support_forces(0, q, v, forces, moments), Status::ok);
  return load3(&forces[3 * support]);
}

ModelSettings beam(const std::string& model, double weight_over) {
  // The weight of the strand times L^2/EI is `weight_over`.
  const double density = weight_over * bending / (gravity * area * std::pow(length, 3));
  return {{"length_m", std::to_string(length)},
          {"radius_m", "1e-4"},
          {"youngs_modulus_pa", "3e9"},
          {"elements", model == "super_clothoid" ? "10" : "40"},
          {"density_kg_m3", std::to_string(density)}};
}

/// A cantilever under its weight W on a spring at the tip: the reaction is (3/8) W/(1 + 3
/// EI/(k L^3)). W = EI/L^2/100 sags so little that the square of the slope, 1e-6, is what
/// linear theory leaves out. Models of order 2 err by 1e-3 with 40 elements.
TEST(CompliantSupports, HoldACantileverWithTheForceOfTheory) {
  for (const char* model : {"super_helix", "super_clothoid", "articulated_chain", "der",
                            "corde", "mass_spring"}) {
    for (const double over : {0.1, 3.0, 1e3}) {
      const ModelSettings settings = beam(model, 0.01);
      auto strand = make_model(model, settings);
      const std::vector<Vec> x = places_at_start(*strand);
      Support spring = support(static_cast<int>(x.size()) - 1, x.back());
      spring.axes = {{0, 0, 1}};
      spring.compliance.stiffness = over * 3 * bending / std::pow(length, 3);
      SupportedSystem system(std::move(strand), {spring});
      Start start(system);
      settle(system, 0, 4, start.q);
      const double weight = 0.01 * bending / (length * length);
      const double expected = 3.0 / 8 * weight / (1 + 1 / over);
      const double off = force_of(system, start.q, 0).z / expected - 1;
      std::printf("%s, k over 3 EI/L^3 = %g: reaction off by %.1e\n", model, over, off);
      EXPECT_LE(std::abs(off), 3e-3) << model;
    }
  }
}

/// The error against a rigid support falls as 1/k, in reactions and in places, for the
/// spring of a ball joint and for both springs of a clamp.
TEST(CompliantSupports, TendToTheRigidSupportAsTheyStiffen) {
  for (const char* model :
       {"super_helix", "super_clothoid", "articulated_chain", "der"}) {
    for (const bool clamp : {false, true}) {
      const ModelSettings settings = beam(model, 2);
      const auto make = [&](double over) {
        auto strand = make_model(model, settings);
        Support tip = clamp ? clamp_of_tip(*strand, model, settings)
                            : support(0, places_at_start(*strand).back());
        tip.point = strand->material_points()->count() - 1;
        tip.path.position = tip.path.position + Vec{-0.05 * length, 0, 0};
        tip.compliance = {over * bending / std::pow(length, 3), 0,
                          clamp ? over * bending / length : 0, 0};
        return std::make_unique<SupportedSystem>(std::move(strand), std::vector{tip});
      };
      const auto held = make(0);
      begin_on_supports(*held, model);
      const Start on_support(*held);
      const Vec rigid = force_of(*held, on_support.q, 0);
      std::vector<double> over{1e4, 1e5, 1e6}, off;
      for (const double k : over) {
        const auto system = make(k);
        static_cast<System&>(*system).recall(static_cast<System&>(*held).memory());
        std::vector<double> q = on_support.q;
        settle(*system, 0, 8, q);
        off.push_back(norm(force_of(*system, q, 0) - rigid) / norm(rigid));
      }
      const double order = experiments::log_log_slope(over, off);
      std::printf("%s, %s: off by %.1e, %.1e, %.1e, order %.3f\n", model,
                  clamp ? "clamp" : "ball", off[0], off[1], off[2], order);
      // At the softest springs the next term of the series in 1/k is a tenth of the
      // first, which changes the order by log(0.9)/log(100) = 0.02.
      EXPECT_NEAR(order, -1, 0.04) << model;
    }
  }
}

/// A bar that does not bend, free, on equal springs at both ends: weight m g sags it by m
/// g/(2 k), about which it swings with omega^2 = 2 k/m.
ModelSettings bar() {
  return {{"elements", "4"},  {"motion", "free"},   {"spin_rad_s", "0"},
          {"speed_m_s", "0"}, {"radius_m", "2e-3"}, {"youngs_modulus_pa", "1e11"}};
}

struct Sprung {
  explicit Sprung(const std::string& model) {
    auto strand = make_model(model, bar());
    const Strand of = models::strand(parameters_of(model, bar()));
    mass = of.mass();
    const std::vector<Vec> x = places_at_start(*strand);
    std::vector<Support> ends{support(0, x.front()),
                              support(static_cast<int>(x.size()) - 1, x.back())};
    for (Support& end : ends) end.compliance.stiffness = stiffness;
    system = std::make_unique<SupportedSystem>(std::move(strand), ends);
    sag = mass * gravity / (2 * stiffness);
    period = 2 * std::numbers::pi * std::sqrt(mass / (2 * stiffness));
  }
  double height_of_tip(double t, In q) {
    std::vector<double> x(15);
    system->material_points()->positions(t, q, x);
    return x[14];
  }

  double stiffness = 1, mass = 0, sag = 0, period = 0;
  std::unique_ptr<SupportedSystem> system;
};

/// z(t) = -sag (1 - cos omega t). The bar bends by W L^3/EI/77 = 1e-5 of its length, and
/// esdirk43 errs by 1e-7 with 40 steps a period. Lumped end masses of der leave the sum
/// of forces and the mean motion as they are.
TEST(CompliantSupports, SwingAStiffBarAsAMassOnSprings) {
  for (const char* model : {"super_helix", "super_clothoid", "der"}) {
    Sprung of(model);
    Options options;
    options.step = of.period / 40;
    std::vector<double> off;
    const Simulation run =
        simulate("esdirk43", *of.system, options, initial_state(*of.system),
                 2 * of.period, [&](double t, In q, In) {
                   const double expected =
                       -of.sag * (1 - std::cos(2 * std::numbers::pi * t / of.period));
                   off.push_back(std::abs(of.height_of_tip(t, q) - expected) / of.sag);
                   return true;
                 });
    ASSERT_EQ(run.status, Status::ok) << run.failure;
    const double most = *std::ranges::max_element(off);
    std::printf("%s: sag %.3g m, at most %.1e of it off\n", model, of.sag, most);
    EXPECT_LE(most, 2e-3) << model;
  }
}

/// Statics: each spring bears half of the weight, exactly, and sags by that over k.
TEST(CompliantSupports, BearTheWeightOverTheirStiffness) {
  for (const char* model : {"super_helix", "super_clothoid", "der"}) {
    Sprung of(model);
    Start start(*of.system);
    ASSERT_TRUE(simulation::come_to_rest(*of.system, start.q)) << model;
    EXPECT_NEAR(of.height_of_tip(0, start.q) / -of.sag, 1, 1e-6) << model;
    for (const std::size_t end : {0U, 1U}) {
      EXPECT_NEAR(force_of(*of.system, start.q, end).z / (of.mass * gravity / 2), 1, 1e-6)
          << model;
    }
  }
}

/// One period of every method that drives a chain of springs at 400 steps a period;
/// those of order 1 damp it by up to pi^2/400 = 2.5 %.
TEST(CompliantSupports, SwingUnderEveryMethod) {
  const ModelSettings settings{{"elements", "2"},        {"length_m", "0.02"},
                               {"radius_m", "1e-3"},     {"youngs_modulus_pa", "1e5"},
                               {"density_kg_m3", "1e4"}, {"gravity_m_s2", "0"}};
  for (const char* model : {"mass_spring", "xpbd_cosserat"}) {
    double reference = 0;  // of the first method
    for (const IntegratorEntry& entry : integrators::integrator_catalogue()) {
      auto strand = make_model(model, settings);
      if (!integrators::refusal(entry, *strand, Formulation::parametric).empty())
        continue;
      const std::vector<Vec> x = places_at_start(*strand);
      Support tip = support(2, x.back() + Vec{0, 0, 1e-4});
      tip.compliance = {1, 1e-4, 0, 0};
      SupportedSystem system(std::move(strand), {tip});
      Options options;
      options.step = 1e-5;
      const Simulation run =
          simulate(entry.id, system, options, initial_state(system), 1e-2, {});
      ASSERT_EQ(run.status, Status::ok) << entry.id << ": " << run.failure;
      std::vector<double> at(9);
      system.material_points()->positions(1e-2, run.state.q, at);
      if (reference == 0) reference = at[8];
      EXPECT_GT(at[8], 1e-6) << entry.id;
      EXPECT_NEAR(at[8] / reference, 1, 0.05) << model << " " << entry.id;
    }
  }
}

}  // namespace tress::test_compliant_supports
