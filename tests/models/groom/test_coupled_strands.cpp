#include <gtest/gtest.h>

#include <cmath>

#include "contract/input_error.h"
#include "models/effects/exact_body.h"
#include "models/effects/strand_interaction.h"
#include "models/groom/coupled_strands.h"
#include "tests/models/groom/strands.h"
#include "tests/support/tangent.h"

namespace tress::test_coupled_strands {

using namespace models;

using namespace testing_support;

/// As stiff as the strands' own springs, so that the tangent shows it.
ContactLaw strong(double viscosity) {
  return {{.stiffness = 100, .viscosity = viscosity, .inner = 3e-3, .outer = 6e-3},
          "test"};
}

/// Two cross one that is clamped, 2 mm above and below it and at odd angles.
std::vector<std::unique_ptr<System>> crossing(std::string_view model) {
  std::vector<std::unique_ptr<System>> strands;
  const Frame turned = rotation({0, 0, 1}, 1.3),
              other = rotation({1, 0, 0}, 0.1) * rotation({0, 0, 1}, -0.9);
  strands.push_back(make_strand_of(model, {.at = {}, .root = "fixed"}));
  strands.push_back(make_strand_of(
      model, {.at = {0.021, -0.023, 2e-3}, .velocity = {0.1, 0, -0.3}, .frame = turned}));
  strands.push_back(make_strand_of(
      model, {.at = {0.017, 0.031, -2e-3}, .velocity = {0, 0.2, 0.1}, .frame = other}));
  return strands;
}

/// Shaken a little, its pairs found there.
struct Case {
  explicit Case(std::string_view model, double viscosity)
      : system(crossing(model), strong(viscosity)), states(system) {
    states.shake(0.02);
    (void)system.history()->accept(t0, states.q, states.v);
  }
  CoupledStrands system;
  States states;
};

long contacts_of(CoupledStrands& system, const States& s) {
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count())), u(x.size());
  points.positions(t0, s.q, x);
  points.velocities(t0, s.q, s.v, u);
  long count = 0;
  system.contacts().each_contact(x, u, [&](const auto&, const auto&) { ++count; });
  return count;
}

class Coupled : public testing::TestWithParam<const char*> {};

TEST_P(Coupled, TangentIsTheDerivativeOfTheResidual) {
  Case c(GetParam(), 1);
  EXPECT_GT(contacts_of(c.system, c.states), 10);
  // The law has a kink where a sample comes nearer than P, and its slope where the
  // nearest point passes an end. A stencil of 1.5e-6 edges, 15 nm, meets none of them.
  for (auto* typ : {&c.states.q_typ, &c.states.v_typ, &c.states.a_typ}) {
    for (double& size : *typ) size *= 1e-3;
  }
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}, Weights{1, 0, 0},
                          Weights{1, 0.05, 0}, Weights{400, 20, 1}}) {
    EXPECT_LE(tangent_error(c.system, c.system, c.states, w), tangent_tolerance)
        << w.acc << " " << w.vel << " " << w.pos;
  }
}

TEST_P(Coupled, ForcesOfContactsSumToZero) {
  // All roots free: what the strands alone leave of r is the contacts', P^T f.
  std::vector<std::unique_ptr<System>> strands = crossing(GetParam()), alone;
  strands[0] = make_strand_of(GetParam(), {});
  alone = crossing(GetParam());
  alone[0] = make_strand_of(GetParam(), {});
  CoupledStrands system(std::move(strands), strong(1));
  States s(system);
  s.shake(0.02);
  (void)system.history()->accept(t0, s.q, s.v);
  EXPECT_GT(contacts_of(system, s), 10);
  std::vector<double> r(s.n);
  ASSERT_EQ(system.residual(t0, s.q, s.v, s.a, r), Status::ok);
  Vec sum;
  double size = 0, rounding = 0;
  std::size_t first = 0;
  for (const auto& strand : alone) {
    const auto n = static_cast<std::size_t>(strand->layout().coordinates);
    std::vector<double> own(n);
    ASSERT_EQ(strand->residual(t0, In(s.q).subspan(first, n), In(s.v).subspan(first, n),
                               In(s.a).subspan(first, n), own),
              Status::ok);
    for (std::size_t i = 0; i < 18; i += 3) {  // six nodes, then other coordinates
      const Vec f = load3(&r[first + i]) - load3(&own[i]);
      sum = sum + f;
      size += norm(f);
      rounding += 2.3e-16 * std::sqrt(dot(load3(&own[i]), load3(&own[i])));
    }
    first += n;
  }
  EXPECT_GT(size, 1e-3);
  // A node has a dozen contacts or two, each rounded, and the strands' own forces.
  EXPECT_LE(norm(sum), 24 * 2.3e-16 * size + 10 * rounding);
}

TEST_P(Coupled, PowerIsWhatEnergyDoesNotAccountFor) {
  Case c(GetParam(), 1);
  States& s = c.states;
  Energetics& energetics = *c.system.energetics();
  // With M constant E' = v.r + power for any a, the clamp at rest.
  const double e = difference_step * 1e-3;
  const auto rate = central_difference(e, [&](double h) {
    return std::vector<double>{
        energetics.energy(t0, plus(s.q, h, s.v), plus(s.v, h, s.a)).total()};
  });
  const std::vector<double> r = residual(c.system, s.q, s.v, s.a);
  double work = 0, size = 0;
  for (std::size_t i = 0; i < s.n; ++i) {
    work += r[i] * s.v[i];
    size += std::abs(r[i] * s.v[i]);
  }
  const double power = energetics.power(t0, s.q, s.v);
  EXPECT_LT(power, 0);
  const double rounding = energetics.energy(t0, s.q, s.v).total() * 2.3e-16 / e;
  EXPECT_NEAR(rate[0], work + power, 1e-7 * size + 10 * rounding);
}

INSTANTIATE_TEST_SUITE_P(Models, Coupled, testing::Values("mass_spring", "corde", "der"),
                         [](const auto& test) { return std::string(test.param); });

TEST(CoupledStrands, FollowPairsAndForgetAndRecallThem) {
  CoupledStrands system(crossing("mass_spring"), strong(1));
  CoupledStrands other(crossing("mass_spring"), strong(1));
  States s(system), start(system);
  s.shake(0.02);
  for (std::size_t i = 15; i < 33; i += 3) s.q[i + 2] += 0.05;  // the second goes away
  EXPECT_TRUE(system.history()->accept(t0, s.q, s.v));
  EXPECT_FALSE(system.history()->accept(t0, s.q, s.v));
  // Its pairs are gone and so are the factors.
  std::vector<double> x(s.n);
  EXPECT_NE(system.solve(s.a, x), Status::ok);
  const Weights w{1, 0.1, 0.01};
  other.history()->recall(system.history()->memory());
  std::vector<double> y(s.n);
  ASSERT_EQ(system.linearize(t0, s.q, s.v, s.a, w), Status::ok);
  ASSERT_EQ(other.linearize(t0, s.q, s.v, s.a, w), Status::ok);
  ASSERT_EQ(system.solve(s.a, x), Status::ok);
  ASSERT_EQ(other.solve(s.a, y), Status::ok);
  EXPECT_EQ(x, y);
  system.history()->reset();
  CoupledStrands fresh(crossing("mass_spring"), strong(1));
  EXPECT_EQ(system.history()->memory(), fresh.history()->memory());
  EXPECT_EQ(residual(system, start.q, start.v, start.a),
            residual(fresh, start.q, start.v, start.a));
}

TEST(CoupledStrands, TakeTheStressesOfEveryStrand) {
  // Far apart, each strand moves as if it were alone.
  const auto apart = [] {
    std::vector<std::unique_ptr<System>> strands;
    for (const double y : {0.0, 10.0})
      strands.push_back(make_strand_of("der", {.at = {0, y, 0}}));
    return strands;
  };
  CoupledStrands both(apart(), strong(1));
  States s(both), origin(both);
  s.shake(0.02);
  for (const bool held : {false, true}) {
    if (held) both.stress_form()->take_stresses(t0, origin.q, StressForm::Stresses::held);
    std::vector<double> x(s.n), alone(s.n);
    ASSERT_EQ(both.linearize(t0, s.q, s.v, s.a, {1, 0.1, 0.01}), Status::ok);
    ASSERT_EQ(both.solve(s.a, x), Status::ok);
    auto strands = apart();
    const std::size_t n = s.n / 2;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto part = [&](const std::vector<double>& all) {
        return In(all).subspan(k * n, n);
      };
      System& strand = *strands[k];
      if (held) {
        strand.stress_form()->take_stresses(t0, part(origin.q),
                                            StressForm::Stresses::held);
      }
      ASSERT_EQ(strand.linearize(t0, part(s.q), part(s.v), part(s.a), {1, 0.1, 0.01}),
                Status::ok);
      ASSERT_EQ(strand.solve(part(s.a), Out(alone).subspan(k * n, n)), Status::ok);
    }
    // Two eliminations of one matrix, of condition 1e7.
    EXPECT_LE(largest(plus(x, -1, alone)), 1e-8 * largest(alone)) << held;
  }
}

/// A step that is tried again starts from the contact forces that it began with.
TEST(CoupledStrands, GiveAndTakeTheContactForcesOfTheirStrands) {
  const NormalContact normal{.stiffness = 10, .offset = 40e-6};
  const auto made = [&] {
    std::vector<std::unique_ptr<System>> strands;
    for (const double y : {0.0, 0.02}) {
      strands.push_back(
          make_strand_of("der", {.at = {0, y, 20e-6}, .velocity = {0.1, 0, -0.1}},
                         {std::make_shared<ExactBody>(
                             Plane{}, StrandPlace{}, ExactContact{normal, false, 0.3})}));
    }
    return std::make_unique<CoupledStrands>(std::move(strands), strong(1));
  };
  const std::unique_ptr<System> first = made(), second = made();
  System &system = *first, &other = *second;
  States s(system);
  ContactForm& contacts = *system.contact_form();
  std::vector<double> start(contacts.tracked());
  EXPECT_EQ(start.size(), 2 * 3 * 6U);  // of six points on two strands
  contacts.places(t0 - 1e-3, s.q, s.v, start);
  contacts.begin(t0, 1e-3, s.q, s.v, start);
  (void)contacts.improve(t0, s.q, s.v);
  const std::vector<double> held = contacts.multipliers(), memory = system.memory();
  EXPECT_GT(largest(held), 0);
  (void)contacts.improve(t0, s.q, s.v);
  contacts.set_multipliers(held);
  EXPECT_EQ(contacts.multipliers(), held);
  other.recall(memory);
  EXPECT_EQ(other.contact_form()->multipliers(), held);
  EXPECT_EQ(other.memory(), memory);
  system.reset();
  EXPECT_EQ(largest(contacts.multipliers()), 0);
}

TEST(CoupledStrands, TellTheirPointsAsMeansOfAllCoordinates) {
  CoupledStrands system(crossing("mass_spring"), strong(1));
  States s(system), moved(system);
  moved.shake(0.1);
  MaterialPoints& points = *system.material_points();
  ASSERT_EQ(points.count(), 18);
  std::vector<double> x(54), y(54);
  points.positions(t0, s.q, x);
  points.positions(t0, moved.q, y);
  for (int i = 0; i < 18; ++i) {
    const MaterialPoints::Mean mean = points.mean(i).value();
    EXPECT_EQ(mean.count, i == 0 ? 0 : 1);  // the first is clamped
    const auto at = 3 * static_cast<std::size_t>(i);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t from = static_cast<std::size_t>(mean.coordinate[0]) + c;
      const double shift = mean.count == 0 ? 0 : moved.q[from] - s.q[from];
      EXPECT_NEAR(y[at + c] - x[at + c], shift, 1e-17);
    }
  }
}

TEST(CoupledStrands, RefuseModelsThatHaveNoSparseTangentOfPoints) {
  for (const char* model : {"super_helix", "inextensible_strand"}) {
    std::vector<std::unique_ptr<System>> strands;
    strands.push_back(make_strand_of("mass_spring", {}));
    strands.push_back(make_strand_of(model, {.at = {0, 0, 0.01}}));
    try {
      const CoupledStrands system(std::move(strands), strong(1));
      FAIL() << model;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("strand 1"), std::string::npos) << text;
      EXPECT_NE(text.find("coupling = lagged"), std::string::npos) << text;
    }
  }
}

}  // namespace tress::test_coupled_strands
