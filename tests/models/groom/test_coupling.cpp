// Two strands that fall onto each other, each by itself against the other as it was, or
// both at once.
#include <gtest/gtest.h>

#include <cmath>

#include "models/effects/strand_interaction.h"
#include "models/groom/coupled_strands.h"
#include "tests/models/groom/strands.h"
#include "tests/support/drive.h"

namespace tress::test_coupling {

using namespace integrators;
using namespace models;

using namespace testing_support;

// Wang's figures per length, the strands face to face; the lower one is heavier.
constexpr ContactLaw::Values values{
    .stiffness = 2e-4, .viscosity = 2e-3, .inner = 3e-3, .outer = 6e-3};
constexpr double duration = 0.02;  // s
const FreeStrand upper{.at = {0, 0, 5e-3}, .velocity = {0, 0, -0.2}};
const FreeStrand lower{.at = {}, .velocity = {0, 0, 0.1}, .radius = 60e-6};

Options steps_of(double h) {
  Options options;
  options.step = h;
  return options;
}

struct Outcome {
  std::vector<double> q;
  double momentum = 0;  // kg m/s, along z
  double initial = 0;
};

double momentum(System& system, In q, In v) {
  return system.energetics()->momentum(0, q, v).value().linear[2];
}

Outcome monolithic(double h) {
  std::vector<std::unique_ptr<System>> strands;
  strands.push_back(make_strand_of("mass_spring", upper));
  strands.push_back(make_strand_of("mass_spring", lower));
  CoupledStrands system(std::move(strands), ContactLaw(values, "test"));
  Drive drive("backward_euler", system, steps_of(h));
  const double initial = momentum(system, drive.q0, drive.v0);
  EXPECT_EQ(drive.to(duration), Status::ok) << drive.integrator->failure();
  const In q = drive.integrator->q();
  return {{q.begin(), q.end()}, momentum(system, q, drive.integrator->v()), initial};
}

Outcome lagged(double h) {
  StrandInteraction interaction(ContactLaw(values, "test"), {6, 6});
  std::vector<std::unique_ptr<System>> systems;
  std::vector<Drive> drives;
  for (const FreeStrand& strand : {upper, lower}) {
    Effects effects;
    effects.push_back(interaction.effect(systems.size()));
    systems.push_back(make_strand_of("mass_spring", strand, std::move(effects)));
  }
  std::vector<double> x(36), v(36);
  const auto update = [&](std::size_t k, In q, In rate) {
    systems[k]->material_points()->positions(0, q, Out(x).subspan(18 * k, 18));
    systems[k]->material_points()->velocities(0, q, rate, Out(v).subspan(18 * k, 18));
  };
  for (const auto& system : systems) {
    std::vector<double> q(18), rate(18);
    system->initial_state(q, rate);
    update(static_cast<std::size_t>(&system - systems.data()), q, rate);
  }
  interaction.update(x, v);
  Outcome outcome;
  for (const auto& system : systems) {
    drives.emplace_back("backward_euler", *system, steps_of(h));
    outcome.initial += momentum(*system, drives.back().q0, drives.back().v0);
  }
  const int steps = static_cast<int>(std::lround(duration / h));
  for (int i = 1; i <= steps; ++i) {
    for (Drive& drive : drives) {
      EXPECT_EQ(drive.to(duration * i / steps), Status::ok);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      update(k, drives[k].integrator->q(), drives[k].integrator->v());
    }
    interaction.update(x, v);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const In q = drives[k].integrator->q();
    outcome.q.insert(outcome.q.end(), q.begin(), q.end());
    outcome.momentum += momentum(*systems[k], q, drives[k].integrator->v());
  }
  return outcome;
}

TEST(Coupling, LaggedApproachesMonolithicAtFirstOrderAndOnlyThatKeepsMomentum) {
  // Masses per length 6.5e-6 and 1.5e-5 kg/m approach each other at the rate
  // D (1/m_1 + 1/m_2) = 440/s; the next order is a few 440 h = 0.04 smaller.
  const double h = 1e-4;
  std::vector<double> distance, drift;
  for (const double step : {h, h / 2, h / 4}) {
    const Outcome both = monolithic(step), apart = lagged(step);
    double most = 0;
    for (std::size_t i = 0; i < both.q.size(); ++i) {
      most = std::max(most, std::abs(both.q[i] - apart.q[i]));
    }
    distance.push_back(most);
    drift.push_back(std::abs(apart.momentum - apart.initial));
    // A sum of rounded impulses of 800 steps at most.
    EXPECT_LE(std::abs(both.momentum - both.initial),
              800 * 10 * 2.3e-16 * std::abs(both.initial) + 1e-21);
  }
  // 5.7e-6, 2.9e-6, 1.4e-6 m; 4.7, 2.4, 1.2 % of the momentum. Monolithic: 1e-14 of it.
  EXPECT_GT(distance[2], 1e-7);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(distance[i] / distance[i + 1], 2, 0.2);
    EXPECT_NEAR(drift[i] / drift[i + 1], 2, 0.2);
  }
}

}  // namespace tress::test_coupling
