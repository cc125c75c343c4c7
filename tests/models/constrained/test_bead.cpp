#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "models/catalogue.h"
#include "models/constrained/bead_on_wire.h"
#include "models/effects/linear_drag.h"
#include "tests/models/constrained/dynamics.h"

namespace tress::test_bead {

using namespace models;

using testing_support::Oracle;
using testing_support::view;
using Setting = std::pair<const char*, const char*>;

std::unique_ptr<System> bead(std::string_view curve, std::string_view form,
                             std::initializer_list<Setting> settings = {}) {
  Parameters p(bead_on_wire_parameters(), "model bead_on_wire");
  p.set("curve", curve);
  p.set("form", form);
  for (const auto& [key, value] : settings) p.set(key, value);
  return make_bead_on_wire(p);
}

constexpr std::initializer_list<Setting> moving = {
    {"mass_kg", "0.7"}, {"start_rad", "0.4"}, {"speed_m_s", "1.5"}, {"drag_kg_s", "0.3"}};

class Wires : public ::testing::TestWithParam<const char*> {};

TEST_P(Wires, BothFormsHaveTheSameAccelerationOfTheBead) {
  const auto implicit = bead(GetParam(), "implicit", moving);
  const auto parametric = bead(GetParam(), "parametric", moving);
  const Oracle x(*implicit);
  const Oracle s(*parametric);
  Eigen::VectorXd place(3), speed(3), place1(3), speed1(3), speed2(3);
  parametric->material_points()->positions(0, view(s.q), view(place));
  parametric->material_points()->velocities(0, view(s.q), view(s.v), view(speed));
  EXPECT_LE((place - x.q.head(3)).norm(), 1e-15);
  EXPECT_LE((speed - x.v.head(3)).norm(), 1e-15);
  EXPECT_NEAR(speed.norm(), 1.5, 1e-15);
  // x'' of the parametric form by central difference of x' along s + h s' + h^2/2 s''
  Eigen::VectorXd ds(1);
  ASSERT_EQ(parametric->explicit_form()->acceleration(0, view(s.q), view(s.v), view(ds)),
            Status::ok);
  const double h = 1e-5;  // truncation h^2 |x''''| / 6 ~ 1e-8, rounding eps / h ~ 2e-11
  const auto speed_at = [&](double dt, Eigen::VectorXd& u) {
    const Eigen::VectorXd q = s.q + dt * s.v + dt * dt / 2 * ds;
    const Eigen::VectorXd v = s.v + dt * ds;
    parametric->material_points()->velocities(0, view(q), view(v), view(u));
  };
  speed_at(h, speed1);
  speed_at(-h, speed2);
  const Eigen::VectorXd found = (speed1 - speed2) / (2 * h);
  EXPECT_LE((found - x.acceleration().head(3)).norm(), 1e-6);
  EXPECT_GT(found.norm(), 1);
}

TEST_P(Wires, BothFormsHaveTheSameEnergyAndPower) {
  const auto implicit = bead(GetParam(), "implicit", moving);
  const auto parametric = bead(GetParam(), "parametric", moving);
  const Oracle x(*implicit);
  const Oracle s(*parametric);
  const Energy ex = implicit->energetics()->energy(0, view(x.q), view(x.v));
  const Energy es = parametric->energetics()->energy(0, view(s.q), view(s.v));
  EXPECT_NEAR(ex.kinetic, es.kinetic, 1e-14);
  EXPECT_NEAR(ex.potential, es.potential, 1e-14);
  const double power = parametric->energetics()->power(0, view(s.q), view(s.v));
  EXPECT_NEAR(power, implicit->energetics()->power(0, view(x.q), view(x.v)), 1e-14);
  EXPECT_NEAR(power, -0.3 * 1.5 * 1.5, 1e-14);
}

TEST_P(Wires, EnergyChangesByThePowerOfDrag) {
  for (const char* form : {"implicit", "parametric"}) {
    const auto system = bead(GetParam(), form, moving);
    const Oracle at(*system);
    const double h = 1e-5;  // see above
    const double slope = (at.total_energy(h) - at.total_energy(-h)) / (2 * h);
    EXPECT_NEAR(slope, system->energetics()->power(0, view(at.q), view(at.v)), 1e-6)
        << form;
  }
}

TEST_P(Wires, ParametricResidualVanishesOnItsExplicitForm) {
  const auto system = bead(GetParam(), "parametric", moving);
  const Oracle at(*system);
  Eigen::VectorXd a(1), r(1);
  ASSERT_EQ(system->explicit_form()->acceleration(0, view(at.q), view(at.v), view(a)),
            Status::ok);
  ASSERT_EQ(system->residual(0, view(at.q), view(at.v), view(a), view(r)), Status::ok);
  EXPECT_NEAR(r[0], 0, 1e-13);  // differences of terms of size 100
}

/// S by central differences of the residual along (w.acc, w.vel, w.pos).
double difference(System& system, const Oracle& at, double a0, Weights w) {
  const double h = 1e-6;
  double r[2];
  for (int side = 0; side < 2; ++side) {
    const double step = side == 0 ? h : -h;
    const Eigen::VectorXd q = at.q.array() + step * w.pos;
    const Eigen::VectorXd v = at.v.array() + step * w.vel;
    const Eigen::VectorXd a = Eigen::VectorXd::Constant(1, a0 + step * w.acc);
    Eigen::VectorXd out(1);
    EXPECT_EQ(system.residual(0, view(q), view(v), view(a), view(out)), Status::ok);
    r[side] = out[0];
  }
  return (r[0] - r[1]) / (2 * h);
}

TEST_P(Wires, ExactTangentIsTheDerivativeAndTheStiffOneDropsInertia) {
  const auto exact = bead(GetParam(), "parametric", moving);
  const auto stiff = bead(GetParam(), "parametric",
                          {{"mass_kg", "0.7"},
                           {"start_rad", "0.4"},
                           {"speed_m_s", "1.5"},
                           {"drag_kg_s", "0.3"},
                           {"jacobian", "elastic"}});
  const Oracle at(*exact);
  const double a0 = 0.8;
  const Eigen::VectorXd a = Eigen::VectorXd::Constant(1, a0);
  for (const Weights w : {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}}) {
    const double want = difference(*exact, at, a0, w);
    double sparse[1];
    ASSERT_EQ(exact->sparse_form()->values(0, view(at.q), view(at.v), view(a), w, sparse),
              Status::ok);
    // difference quotient: rounding eps r / h = 1e-9 for r up to 10, truncation h^2
    EXPECT_NEAR(sparse[0], want, 1e-7 * (1 + std::abs(want)));
    if (std::abs(want) > 1e-6) {  // on a helix dr/dq vanishes: S = 0 has no solution
      Eigen::VectorXd b = Eigen::VectorXd::Constant(1, 1.0);
      ASSERT_EQ(exact->linearize(0, view(at.q), view(at.v), view(a), w), Status::ok);
      ASSERT_EQ(exact->solve(view(b), view(b)), Status::ok);
      EXPECT_NEAR(1 / b[0], want, 1e-7 * (1 + std::abs(want)));
    }
    ASSERT_EQ(stiff->sparse_form()->values(0, view(at.q), view(at.v), view(a), w, sparse),
              Status::ok);
    // where |c'| is constant, the inertia m |c'|^2 a has no derivatives to drop
    const bool same = std::abs(sparse[0] - want) < 1e-6 * (1 + std::abs(want));
    EXPECT_EQ(same, w.acc == 1 || exact->traits().constant_mass);
  }
}

TEST_P(Wires, ImplicitFormStartsOnTheWire) {
  const auto system = bead(GetParam(), "implicit", moving);
  const Oracle at(*system);
  const int m = system->layout().constraints;
  Eigen::VectorXd g(m), rate(m);
  ASSERT_EQ(system->constraint_form()->value(0, view(at.q), view(g)), Status::ok);
  ASSERT_EQ(system->constraint_form()->rate(0, view(at.q), view(at.v), view(rate)),
            Status::ok);
  EXPECT_LE(g.norm(), 1e-15);  // a few eps on sizes of 1 m
  EXPECT_LE(rate.norm(), 1e-15);
  EXPECT_EQ(bead(GetParam(), "parametric")->constraint_form(), nullptr);
}

INSTANTIATE_TEST_SUITE_P(Bead, Wires,
                         ::testing::Values("circle", "ellipse", "helix", "trefoil"),
                         [](const auto& tested) { return tested.param; });

TEST(Bead, TrefoilHasAMasslessCoordinateAndARegularKktMatrix) {
  const auto system = bead("trefoil", "implicit", moving);
  EXPECT_FALSE(system->traits().regular_mass);
  const Oracle at(*system);
  const Eigen::VectorXd a = Eigen::VectorXd::Zero(4);
  EXPECT_EQ(system->linearize(0, view(at.q), view(at.v), view(a), {1, 0, 0}),
            Status::fatal);
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(7, 7);
  kkt.topLeftCorner(4, 4) = at.tangent({1, 0, 0});
  kkt.bottomLeftCorner(3, 4) = at.gradient();
  kkt.topRightCorner(4, 3) = -at.gradient().transpose();
  EXPECT_EQ(testing_support::rank(kkt), 7);
}

TEST(Bead, CircleReleasedHorizontallyStartsAsAFreeFall) {
  const auto system = bead("circle", "implicit");
  const Oracle at(*system);
  EXPECT_EQ(at.q, Eigen::Vector3d(1, 0, 0));
  EXPECT_LE((at.acceleration() - Eigen::Vector3d(0, 0, -9.81)).norm(), 1e-14);
}

TEST(Bead, RefusesMassesAndCurvesThatDoNotMove) {
  BeadOnWire::Setup setup;
  setup.curve = ellipse({}, {}, {});
  EXPECT_THROW(BeadOnWire(setup, {}), InputError);
  setup.curve = trefoil(1);
  EXPECT_NO_THROW(BeadOnWire(setup, {}));
  setup.mass = 0;
  EXPECT_THROW(BeadOnWire(setup, {}), InputError);
}

}  // namespace tress::test_bead
