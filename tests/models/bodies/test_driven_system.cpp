// Strands that drive bodies by contact: derivatives, energy and momentum.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "models/driven/driven_system.h"
#include "models/strand/strand_parameters.h"
#include "tests/support/tangent.h"

namespace tress::test_driven_system {

using namespace models;
using namespace testing_support;

const Bearing bearing{.axis = {0.2, 1, -0.4},
                      .pivot = {0.01, -0.02, 0.03},
                      .inertia = 3e-9,
                      .damping = 2e-8,
                      .moment = 1e-7,
                      .speed = 3};

/// A body of the strand's mass, with different moments of inertia.
const FreeBody loose{.mass = 1e-5,
                     .inertia = {3e-9, 5e-9, 4e-9},
                     .velocity = {0.1, -0.2, 0.05},
                     .spin = {1, -3, 2}};
enum class Moves { turns, freely };

/// A strand inside a plane's body, so deep that all points remain in contact in the
/// states of these tests. Friction is smooth at the speeds of these tests.
std::unique_ptr<System> touching(const ModelEntry& model, bool free,
                                 const std::vector<Moves>& bodies) {
  Parameters parameters(setup_parameters(model), std::string(model.id));
  Strand strand = models::strand(parameters);
  if (free) {
    FreeRoot& root = strand.free_root.emplace();
    root.position = strand.root.position;
    root.frame = strand.root.frame;
  }
  const BodyContact law{
      .stiffness = 1e-4, .damping = 0.05, .friction = 0.3, .slip = 50, .offset = 40e-6};
  Effects effects;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const double count = static_cast<double>(k);
    Bearing own = bearing;
    own.inertia *= count + 1;
    BodyDrive drive = own;
    if (bodies[k] == Moves::freely) drive = loose;
    const StrandPlace place{{0, 0.1 * count, 1}, rotation({0, 1, 0}, 0.2 * count)};
    effects.push_back(
        std::make_shared<models::DrivenBody>(Body(Plane{}, place, law), drive));
  }
  Parameters options(model.parameters, "test");
  return with_driven_bodies(model.on_strand(strand, options, effects), effects);
}

std::vector<std::string> models_of_strands() {
  std::vector<std::string> all;
  for (const ModelEntry& model : tested_models()) {
    if (model.on_strand == nullptr) continue;
    try {
      if (touching(model, false, {Moves::turns}) == nullptr) continue;
    } catch (const InputError&) {
      continue;  // has constraints
    }
    all.emplace_back(model.id);
  }
  return all;
}

class DrivenSystems : public testing::TestWithParam<std::string> {};

/// Plain models leave out terms by design; others have the derivatives of the contact.
TEST_P(DrivenSystems, TheMatrixIsTheDerivativeOfTheResidual) {
  for (const bool free : {false, true}) {
    const ModelEntry& model = find_model(GetParam());
    if (free && model.roots != Roots::clamped_or_free) continue;
    const auto system = touching(model, free, {Moves::turns, Moves::freely});
    if (!system->traits().regular_mass) continue;
    States s(*system);
    for (const Weights w :
         {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}, Weights{1, 0, 0}}) {
      s.shake(0.02);
      // The border of reduced models has a difference with a step of 6e-6, whose
      // truncation is the square of it and whose rounding its inverse times 2e-16.
      EXPECT_LE(tangent_error(*system, *system, s, w), 5 * tangent_tolerance)
          << free << " weights " << w.acc << " " << w.vel << " " << w.pos;
    }
  }
}

TEST_P(DrivenSystems, ExplicitAccelerationsSolveTheEquations) {
  const auto system =
      touching(find_model(GetParam()), false, {Moves::turns, Moves::freely});
  ExplicitForm* const form = system->explicit_form();
  if (form == nullptr) GTEST_SKIP() << "no explicit form";
  States s(*system);
  s.shake(0.02);
  ASSERT_EQ(form->acceleration(t0, s.q, s.v, s.a), Status::ok);
  std::vector<double> at_rest(s.n), zero(s.n);
  const std::vector<double> r = residual(*system, s.q, s.v, s.a),
                            force = residual(*system, s.q, s.v, zero);
  // Sums of the model's forces round by 1e-16 of the largest.
  EXPECT_LE(largest(r), 1e-9 * largest(force));
  EXPECT_LE(std::abs(r.back()), 1e-12 * std::abs(force.back()));
}

/// A slow strand without strain on a fast body: stiff springs hold little energy.
States slow(System& system) {
  States s(system);
  s.v = s.random(s.v_typ);
  for (double& v : s.v) v *= 1e-3;
  s.v.back() = 5;
  return s;
}

struct Rate {
  double value, time;  // of the change; s, of the differences
};
/// The rate of what is measured, along the motion that follows from the equations.
template <class Measure>
Rate rate_of(System& system, const States& s, Measure measure) {
  EXPECT_EQ(system.linearize(t0, s.q, s.v, s.a, {1, 0, 0}), Status::ok);
  std::vector<double> zero(s.n), b = residual(system, s.q, s.v, zero), a(s.n);
  for (double& entry : b) entry = -entry;
  EXPECT_EQ(system.solve(b, a), Status::ok);
  double fastest = 0;
  for (std::size_t i = 0; i < s.n; ++i) {
    fastest = std::max(
        {fastest, std::abs(s.v[i]) / s.q_typ[i], std::sqrt(std::abs(a[i]) / s.q_typ[i])});
  }
  const double time = testing_support::difference_step / fastest;
  const std::vector<double> change = central_difference(time, [&](double step) {
    const std::vector<double> q = plus(plus(s.q, step, s.v), step * step / 2, a);
    return std::vector<double>{measure(q, plus(s.v, step, a))};
  });
  return {change[0], time};
}

/// The differences round by 1e-16 of the energy, over their time. Their truncation is
/// 7.4e-4^4 = 3e-13 of it.
TEST_P(DrivenSystems, EnergyChangesByThePower) {
  for (const Moves moves : {Moves::turns, Moves::freely}) {
    const auto system = touching(find_model(GetParam()), false, {moves});
    Energetics* const energetics = system->energetics();
    if (energetics == nullptr) GTEST_SKIP() << "no energy";
    if (!system->traits().regular_mass) GTEST_SKIP() << "no accelerations";
    if (system->layout().constraints > 0) GTEST_SKIP() << "moves under its constraints";
    const States s = slow(*system);
    const Rate rate = rate_of(
        *system, s, [&](In q, In v) { return energetics->energy(t0, q, v).total(); });
    const double power = energetics->power(t0, s.q, s.v),
                 energy = energetics->energy(t0, s.q, s.v).total();
    EXPECT_NEAR(rate.value, power, 1e-12 * energy / rate.time);
    // The bound resolves the power.
    EXPECT_LT(1e-12 * energy / rate.time, 1e-3 * std::abs(power));
  }
}

/// The forces on the body are those on the strand: about the axis, a free strand without
/// weight and its body have a constant angular momentum but for the bearing's moment.
TEST_P(DrivenSystems, TheStrandAndTheBodyExchangeAngularMomentum) {
  const ModelEntry& model = find_model(GetParam());
  if (model.roots != Roots::clamped_or_free) GTEST_SKIP() << "no free root";
  const auto system = touching(model, true, {Moves::turns});
  Energetics* const energetics = system->energetics();
  if (energetics == nullptr || !system->traits().regular_mass) GTEST_SKIP();
  const States s = slow(*system);
  if (!energetics->momentum(t0, s.q, s.v)) GTEST_SKIP() << "no momentum";
  const Vec axis = (1 / norm(bearing.axis)) * bearing.axis;
  const auto momentum = [&](In q, In v) {
    const auto m = *energetics->momentum(t0, q, v);
    const Vec about =
        load3(m.angular.data()) - cross(bearing.pivot, load3(m.linear.data()));
    return dot(axis, about) + bearing.inertia * v.back();
  };
  const Rate rate = rate_of(*system, s, momentum);
  const double moment = bearing.moment - bearing.damping * s.v.back();
  std::vector<double> a(s.n);
  const double contact = residual(*system, s.q, s.v, a).back() + moment;
  EXPECT_NEAR(rate.value, moment, 1e-12 * std::abs(momentum(s.q, s.v)) / rate.time);
  // The bound resolves the moment of the contact.
  EXPECT_LT(1e-12 * std::abs(momentum(s.q, s.v)) / rate.time, 1e-3 * std::abs(contact));
}

/// The momenta of a free strand and a free body without weight are constant in sum.
TEST_P(DrivenSystems, AFreeBodyKeepsTheMomentumOfBoth) {
  const ModelEntry& model = find_model(GetParam());
  if (model.roots != Roots::clamped_or_free) GTEST_SKIP() << "no free root";
  const auto system = touching(model, true, {Moves::freely});
  Energetics* const energetics = system->energetics();
  if (energetics == nullptr || !system->traits().regular_mass) GTEST_SKIP();
  const States s = slow(*system);
  if (!energetics->momentum(t0, s.q, s.v)) GTEST_SKIP() << "no momentum";
  std::vector<double> zero(s.n);
  const std::vector<double> r = residual(*system, s.q, s.v, zero);
  const double contact = norm(load3(&r[s.n - 6]));
  for (const int axis : {0, 1, 2}) {
    const auto i = static_cast<std::size_t>(axis);
    const auto linear = [&](In q, In v) {
      return energetics->momentum(t0, q, v)->linear[i];
    };
    const auto angular = [&](In q, In v) {
      return energetics->momentum(t0, q, v)->angular[i];
    };
    // Differences round by 1e-16 of the momentum of a part, over their time.
    const auto all = *energetics->momentum(t0, s.q, s.v);
    const Rate of_linear = rate_of(*system, s, linear);
    EXPECT_NEAR(of_linear.value, 0,
                1e-12 * norm(load3(all.linear.data())) / of_linear.time);
    const Rate of_angular = rate_of(*system, s, angular);
    EXPECT_NEAR(of_angular.value, 0,
                1e-12 * norm(load3(all.angular.data())) / of_angular.time);
    // The bound resolves the force of the contact.
    EXPECT_LT(1e-12 * norm(load3(all.linear.data())) / of_linear.time, 1e-3 * contact);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, DrivenSystems, testing::ValuesIn(models_of_strands()),
                         [](const auto& one) { return one.param; });

TEST(DrivenBody, RefusesABearingThatCannotTurn) {
  const auto make = [](double axis, double inertia, double damping) {
    Bearing one;
    one.axis = {0, 0, axis};
    one.inertia = inertia;
    one.damping = damping;
    const BodyContact law{.stiffness = 1, .damping = 0, .friction = 0};
    return models::DrivenBody(Body(Plane{}, {}, law), one);
  };
  EXPECT_THROW(make(0, 1, 0), InputError);
  EXPECT_THROW(make(1, 0, 0), InputError);
  EXPECT_THROW(make(1, 1, -1), InputError);
  EXPECT_NO_THROW(make(1, 1, 0));
}

TEST(DrivenBody, RefusesABodyThatCannotMove) {
  const auto make = [](double mass, const Vec& inertia, double spin) {
    const BodyContact law{.stiffness = 1, .damping = 0, .friction = 0};
    return models::DrivenBody(
        Body(Sphere{1}, {}, law),
        FreeBody{.mass = mass, .inertia = inertia, .velocity = {}, .spin = {spin, 0, 0}});
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make(0, {1, 1, 1}, 0), InputError);
  EXPECT_THROW(make(-1, {1, 1, 1}, 0), InputError);
  EXPECT_THROW(make(nan, {1, 1, 1}, 0), InputError);
  EXPECT_THROW(make(1, {1, 0, 1}, 0), InputError);
  EXPECT_THROW(make(1, {1, nan, 1}, 0), InputError);
  EXPECT_THROW(make(1, {1, 1, 2.001}, 0), InputError);
  EXPECT_THROW(make(1, {1, 1, 1}, nan), InputError);
  EXPECT_NO_THROW(make(1, {1, 1, 2}, 0));
}

}  // namespace tress::test_driven_system
