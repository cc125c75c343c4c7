#include <gtest/gtest.h>

#include <cmath>

#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "contract/forms/sparse_form.h"
#include "tests/models/published/support.h"

namespace tress::test_energy {

using namespace experiments;

// Along any motion, dE/dt = v . r + power: the residual does the work that is missing.
// Differences as in test_constraints.cpp; terms are of size |v| |r|.
class PublishedEnergy : public testing::TestWithParam<const char*> {};

TEST_P(PublishedEnergy, GrowsByTheWorkOfResidualAndPower) {
  const auto system = make_model(GetParam());
  Energetics* energetics = system->energetics();
  ASSERT_NE(energetics, nullptr);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const DenseState s = random_state(*system, seed);
    const double h = 1e-3 / std::max(s.v.norm(), std::sqrt(s.a.norm()));
    const double growth = derivative(
        [&](double dt) -> Vector {
          const Vector q = s.q + dt * s.v + 0.5 * dt * dt * s.a;
          const Vector v = s.v + dt * s.a;
          return Vector::Constant(1, energetics->energy(s.t, in(q), in(v)).total());
        },
        h)[0];
    const Vector r = residual_of(*system, s);
    const double work = s.v.dot(r) + energetics->power(s.t, in(s.q), in(s.v));
    EXPECT_NEAR(growth, work, 1e-8 * s.v.norm() * r.norm()) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, PublishedEnergy,
                         testing::Values("andrews_squeezer", "beam", "double_pendulum"),
                         [](const auto& param) { return std::string(param.param); });

// The crank's equations come from T = v.M v / 2 and V = q.K q / 2; the same law, with M
// and K read from the tangent.
TEST(SliderCrank, InertiaForcesComeFromTheKineticEnergy) {
  const auto system = make_model("slider_crank", {{"jacobian", "elastic"}});
  SparseForm& form = *system->sparse_form();
  const auto matrix = [&](const DenseState& s, Weights w) {
    Vector values(form.pattern().nonzeros());
    EXPECT_EQ(form.values(s.t, in(s.q), in(s.v), in(s.a), w, out(values)), Status::ok);
    return dense(form.pattern(), in(values));
  };
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const DenseState s = random_state(*system, seed);
    const double h = 1e-3 / std::max(s.v.norm(), std::sqrt(s.a.norm()));
    const double growth = derivative(
        [&](double dt) -> Vector {
          const DenseState moved{s.t, s.q + dt * s.v + 0.5 * dt * dt * s.a,
                                 s.v + dt * s.a, s.a};
          const double kinetic = moved.v.dot(matrix(moved, {1, 0, 0}) * moved.v);
          const double potential = moved.q.dot(matrix(moved, {0, 0, 1}) * moved.q);
          return Vector::Constant(1, 0.5 * (kinetic + potential));
        },
        h)[0];
    const Vector r = residual_of(*system, s);
    EXPECT_NEAR(growth, s.v.dot(r), 1e-8 * s.v.norm() * r.norm()) << "seed " << seed;
  }
}

TEST(Points, VelocitiesAreTheRatesOfPositionsAndCarryTheKineticEnergy) {
  for (const char* id : {"beam", "double_pendulum"}) {
    const auto system = make_model(id);
    MaterialPoints& points = *system->material_points();
    const DenseState s = random_state(*system, 1);
    const Eigen::Index size = 3 * points.count();
    Vector u(size);
    points.velocities(s.t, in(s.q), in(s.v), out(u));
    const Vector rate = derivative(
        [&](double dt) {
          Vector x(size);
          const Vector q = s.q + dt * s.v;
          points.positions(s.t, in(q), out(x));
          return x;
        },
        1e-3 / s.v.norm());
    EXPECT_LE((u - rate).norm(), 1e-9 * s.v.norm()) << id;

    // Beam: joints of 1/n kg, half at the tip, none at the clamp. Pendulum: 1 kg each.
    Vector mass = Vector::Ones(points.count());
    if (id == std::string_view("beam")) {
      mass *= 1.0 / (points.count() - 1);
      mass[points.count() - 1] *= 0.5;
    }
    double kinetic = 0;
    for (int k = 0; k < points.count(); ++k) {
      kinetic += 0.5 * mass[k] * u.segment(3 * k, 3).squaredNorm();
    }
    const double expected = system->energetics()->energy(s.t, in(s.q), in(s.v)).kinetic;
    EXPECT_NEAR(kinetic, expected, 1e-13 * expected) << id;
  }
}

TEST(DoublePendulum, SmallOscillationsHaveTheTextbookFrequencies) {
  // Equal masses and lengths: omega^2 = (2 -+ sqrt 2) g / l, Landau & Lifshitz
  // section 23.
  const auto system = make_model("double_pendulum", {{"angle_1", "0"}, {"angle_2", "0"}});
  const DenseState s = start_of(*system);
  const Matrix mass = tangent_of(*system, s, {1, 0, 0});
  const Matrix both = tangent_of(*system, s, {1, 0, 1});
  const Vector squares = symmetric_eigenpairs(both - mass, mass).values;
  EXPECT_NEAR(squares[0], (2 - std::sqrt(2)) * 9.81, 1e-12);
  EXPECT_NEAR(squares[1], (2 + std::sqrt(2)) * 9.81, 1e-12);
}

}  // namespace tress::test_energy
