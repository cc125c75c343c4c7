#include <gtest/gtest.h>

#include "integrators/formulation/dynamics.h"
#include "models/effects/air_drag.h"
#include "models/effects/body.h"
#include "models/effects/tether.h"
#include "models/strand/strand_parameters.h"
#include "tests/support/tangent.h"

// Every model of a strand under effects that depend on place, velocity and time: the
// blocks of the effects must arrive in the tangent, their power and potential in the
// energy.
namespace tress {
namespace {

using namespace testing_support;

/// Sizes in proportion to a hair of 0.1 m, whose weight is 6e-6 N. All points stay in
/// contact and below the slip speed, so that every load is smooth.
Effects smooth_effects() {
  Effects effects;
  effects.push_back(std::make_unique<AirDrag<LinearAirLaw, Gusts>>(
      "wind", LinearAirLaw{2e-5}, Gusts({1, 0.3, 0}, 0.8, 0.2, 0.4, 3)));
  effects.push_back(std::make_unique<Body>(
      Ellipsoid({9, 11, 10}), StrandPlace{{0, 0, -9}, {}},
      BodyContact{.stiffness = 1e-4, .damping = 1e-3, .friction = 0.3, .slip = 1e4}));
  effects.push_back(
      std::make_unique<Tether>(Tether::Settings{.at = 0.7,
                                                .stiffness = 1e-4,
                                                .damping = 1e-6,
                                                .pull = 1e-6,
                                                .soft = 0.05,
                                                .target = {0.05, 0.02, 0.03},
                                                .amplitude = {0, 0.01, 0},
                                                .frequency = 2,
                                                .on = -1,
                                                .off = 1}));
  return effects;
}

std::vector<const ModelEntry*> strand_models() {
  std::vector<const ModelEntry*> all;
  for (const ModelEntry& entry : models()) {
    if (entry.on_strand != nullptr) all.push_back(&entry);
  }
  return all;
}

class EffectsOnModels : public testing::TestWithParam<const ModelEntry*> {
 protected:
  std::unique_ptr<System> make() const {
    Parameters parameters(GetParam()->parameters, "test");
    parameters.set("elements", "5");
    // Soft, so that elastic forces do not drown those of the effects.
    parameters.set("youngs_modulus_pa", "1e4");
    return GetParam()->on_strand(strand(parameters), parameters, smooth_effects());
  }
};

INSTANTIATE_TEST_SUITE_P(Models, EffectsOnModels, testing::ValuesIn(strand_models()),
                         [](const auto& one) { return std::string(one.param->id); });

TEST_P(EffectsOnModels, TheTangentHoldsTheirDerivatives) {
  const auto system = make();
  if (!system->traits().regular_mass) GTEST_SKIP() << "S is singular on its own";
  States s(*system);
  for (const Weights w :
       {Weights{1, 0.1, 0.01}, Weights{1, 0.05, 0}, Weights{400, 20, 1}}) {
    s.shake(0.05);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance)
        << "weights " << w.acc << " " << w.vel << " " << w.pos;
  }
}

/// The accelerations that follow from q and v where no constraint has a say; else those
/// of `s`, any.
void accelerate(System& system, States& s) {
  if (s.m > 0) return;
  Dynamics dynamics(system, {});
  ASSERT_EQ(dynamics.accelerate(t0, s.q, s.v, s.a, {}), Status::ok);
}

// Along a motion q' = v, v' = a of a strand with its root at rest, the energy changes by
// the power and by v.r, where r is what the forces lack for a (0 when a follows from
// them). Errors as in the contract test of energy (tests/contracts): e^4 and eps/e of
// E/time, two digits of margin.
TEST_P(EffectsOnModels, TheEnergyHoldsTheirPotentialAndPower) {
  const auto system = make();
  Energetics* energetics = system->energetics();
  if (energetics == nullptr) GTEST_SKIP() << "no energetics";
  States s(*system);
  if (s.m == 0 && !system->traits().regular_mass)
    GTEST_SKIP() << "no acceleration follows from q and v alone";
  s.shake(0.05);
  accelerate(*system, s);
  const double time =
      std::min(largest(s.q_typ) / largest(s.v), largest(s.v) / largest(s.a));
  const auto energy = [&](double e) {
    const auto q = plus(plus(s.q, e, s.v), e * e / 2, s.a);
    return std::vector{energetics->energy(t0 + e, q, plus(s.v, e, s.a)).total()};
  };
  const double rate = central_difference(difference_step * time, energy)[0];
  double expected = energetics->power(t0, s.q, s.v), work = 0;
  if (s.m > 0) {
    const auto r = residual(*system, s.q, s.v, s.a);
    for (std::size_t i = 0; i < s.n; ++i) {
      expected += s.v[i] * r[i];
      work += std::abs(s.v[i] * r[i]);
    }
  }
  const Energy now = energetics->energy(t0, s.q, s.v);
  const double scale = std::abs(now.kinetic) + std::abs(now.potential);
  EXPECT_NEAR(rate, expected, 1e-10 * (scale / time + work));
}

}  // namespace
}  // namespace tress
