#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "contract/forms/energetics.h"
#include "integrators/control/impulsive.h"
#include "models/catalogue.h"
#include "tests/support/drive.h"

namespace tress::test_guarded {

using namespace models;
using testing_support::Drive;

std::unique_ptr<System> strand(const char* model, double internal_friction) {
  const ModelEntry& entry = find_model(model);
  Parameters p(setup_parameters(entry), std::string("model ") + model);
  p.set("elements", "10");
  p.set("length_m", "0.2");
  p.set("internal_friction_kg_m3_s", std::to_string(internal_friction));
  return entry.make(p);
}

Options steps_of(double h) {
  Options options;
  options.step = h;
  return options;
}

/// a = v^2. A step h of backward Euler from v has a solution up to h v = 1/4 only.
class Runaway final : public System {
 public:
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override { q[0] = 0, v[0] = 1; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double, In, In v, In a, Out r) noexcept override {
    r[0] = a[0] - v[0] * v[0];
    return Status::ok;
  }
  Status linearize(double, In, In v, In, Weights w) noexcept override {
    slope_ = w.acc - 2 * v[0] * w.vel;
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / slope_;
    return slope_ == 0 ? Status::retry : Status::ok;
  }

 private:
  double slope_ = 1;
};

struct Pair {
  const char* guarded;
  const char* method;
};

class OfMethod : public testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(Guarded, OfMethod,
                         testing::Values(Pair{"guarded", "tr_bdf2"},
                                         Pair{"guarded_esdirk43", "esdirk43"}),
                         [](const auto& test) { return std::string(test.param.method); });

TEST_P(OfMethod, SoundStepsAreThoseOfTheMethod) {
  const auto one = strand("super_helix", 0), other = strand("super_helix", 0);
  Drive guarded(GetParam().guarded, *one, steps_of(2e-3));
  Drive method(GetParam().method, *other, steps_of(2e-3));
  ASSERT_EQ(guarded.to(0.3), Status::ok) << guarded.integrator->failure();
  ASSERT_EQ(method.to(0.3), Status::ok);
  EXPECT_EQ(guarded.integrator->stats().replaced, 0);
  EXPECT_EQ(guarded.distance(method.integrator->q()), 0);
  EXPECT_GT(method.distance(method.q0), 0.1);
}

// Steps of 33 ms of an undamped rod of points: the method alone fails, or gains energy.
TEST_P(OfMethod, StepsThatFailAreReplacedAndMakeNoEnergy) {
  const auto system = strand("der", 0);
  Drive drive(GetParam().guarded, *system, steps_of(1. / 30));
  Energetics& energetics = *system->energetics();
  const double begin = energetics.energy(0, drive.q0, drive.v0).total();
  double before = begin, most = 0, kinetic = 0;
  const Status s = drive.to(4, [&](double t, In q, In v) {
    const Energy now = energetics.energy(t, q, v);
    most = std::max(most, now.total() - before);
    kinetic = std::max(kinetic, now.kinetic);
    before = now.total();
    return true;
  });
  ASSERT_EQ(s, Status::ok) << drive.integrator->failure();
  EXPECT_GT(drive.integrator->stats().replaced, 0);
  EXPECT_LT(drive.integrator->stats().replaced, drive.integrator->stats().steps);
  EXPECT_LT(most, 0.05 * kinetic);
  EXPECT_LE(before, begin);
}

// tr_bdf2 has no solution for this step, nor have 1, 2 or 4 steps of backward Euler.
TEST(Guarded, ReplacesAStepByTheFewestThatHaveSolutions) {
  constexpr double h = 0.6;
  Runaway system;
  Drive drive("guarded", system, steps_of(h));
  ASSERT_EQ(drive.to(h), Status::ok) << drive.integrator->failure();
  EXPECT_EQ(drive.integrator->stats().replaced, 1);
  EXPECT_EQ(drive.integrator->stats().steps, 1);
  double q = 0, v = 1;
  for (int i = 0; i < 8; ++i) {
    constexpr double part = h / 8;
    v = (1 - std::sqrt(1 - 4 * part * v)) / (2 * part);
    q += part * v;
  }
  // Newton's iteration ends at 1e-10 of the typical rate. Each step amplifies errors
  // by 1 / (1 - 2 h v), all of them by 14.
  EXPECT_NEAR(drive.integrator->v()[0], v, 1e-8);
  EXPECT_NEAR(drive.integrator->q()[0], q, 1e-8);
}

TEST_P(OfMethod, AnImpulseEndsAllMemoryOfTheStepBefore) {
  const auto one = strand("super_helix", 1e-4), other = strand("super_helix", 1e-4);
  Drive pushed(GetParam().guarded, *one, steps_of(5e-3));
  ASSERT_EQ(pushed.to(0.05), Status::ok);
  std::vector<double> q(pushed.integrator->q().begin(), pushed.integrator->q().end());
  std::vector<double> v(pushed.integrator->v().begin(), pushed.integrator->v().end());
  for (double& rate : v) rate *= -0.5;
  auto* impulsive = dynamic_cast<integrators::Impulsive*>(pushed.integrator.get());
  ASSERT_NE(impulsive, nullptr);
  ASSERT_EQ(impulsive->go_on(q, v), Status::ok);
  ASSERT_EQ(pushed.to(0.1), Status::ok);
  Drive started(GetParam().guarded, *other, steps_of(5e-3));
  ASSERT_EQ(started.integrator->start(0.05, q, v), Status::ok);
  ASSERT_EQ(started.integrator->advance(0.1), Status::ok);
  // Both iterate to 1e-10 from the same guesses.
  EXPECT_LT(pushed.distance(started.integrator->q()), 1e-12);
}

}  // namespace tress::test_guarded
