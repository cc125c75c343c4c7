#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "contract/forms/sparse_form.h"
#include "integrators/catalogue.h"
#include "models/published/references.h"
#include "tests/models/published/support.h"
#include "tests/support/drive.h"

namespace tress::test_wheelset {

using namespace experiments;

constexpr int moving = 6;  // coordinates with accelerations

// The Test Set prints the derivatives that belong to its start, to all digits.
TEST(Wheelset, PrintedAccelerationsFollowFromTheStart) {
  const auto system = make_model("wheelset");
  DenseState s = start_of(*system);
  s.a.head(moving) << -1.975258894011285, -1.0898297102811276e-03, 7.8855083626142589e-02,
      -5.533362821731549, -0.3487021489546511, -2.132968724380927;
  const Vector r = residual_of(*system, s);
  // Contacts touch and rest. Forces are of 160 N and cancel to rounding.
  EXPECT_LE(r.lpNorm<Eigen::Infinity>(), 1e-11);
}

/// At the printed end of the run, where all velocities differ from zero.
DenseState printed_end() {
  const PublishedEnd& end = *published_end("wheelset");
  const auto system = make_model("wheelset");
  DenseState s = start_of(*system);
  s.t = end.t;
  s.q.head(5) = vector_of(end.q);
  s.v = vector_of(end.v);
  return s;
}

TEST(Wheelset, SparseFormIsTheDerivativeOfTheResidual) {
  const auto system = make_model("wheelset");
  const DenseState s = printed_end();
  const auto n = s.q.size();
  Vector q_typ(n), v_typ(n), values(n * n);
  system->scale(out(q_typ), out(v_typ));
  SparseForm& form = *system->sparse_form();
  for (const Weights& w : {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}}) {
    ASSERT_EQ(form.values(s.t, in(s.q), in(s.v), in(s.a), w, out(values)), Status::ok);
    const Matrix matrix = dense(form.pattern(), in(values));
    for (Eigen::Index k = 0; k < n; ++k) {
      const double size = w.pos > 0 ? q_typ[k] : v_typ[k];
      const Vector x = size * Vector::Unit(n, k);
      const Vector difference = derivative(
          [&](double h) {
            return residual_of(*system, {s.t, s.q + h * w.pos * x, s.v + h * w.vel * x,
                                         s.a + h * w.acc * x});
          },
          1e-3);
      // Creep is the difference of two speeds of 30 m/s, and friction, of 12 N, changes
      // over 7e-3 m/s of it: rounding 2e-16 30/7e-3 12 N over 1e-3, or 1e-8.
      EXPECT_LE((matrix * x - difference).norm(), 1e-8 * (1 + difference.norm()))
          << "entry " << k << " of "
          << (w.pos > 0   ? "q"
              : w.vel > 0 ? "v"
                          : "a");
    }
  }
}

// No explicit form exists, so that an implicit method of order 4 takes the place of
// test_end_values' Runge-Kutta method. With 160000 steps it and radau5 are 1e-7 apart and
// have no more digits: the printed run is the limit.
TEST(Wheelset, PublishedEndIsReproduced) {
  const PublishedEnd& end = *published_end("wheelset");
  const auto system = make_model("wheelset");
  const auto n = static_cast<Eigen::Index>(system->layout().coordinates);
  Vector q_typ(n), v_typ(n);
  system->scale(out(q_typ), out(v_typ));
  double before = 0;
  for (const int steps : {20000, 40000}) {
    Options options;
    options.step = end.t / steps;
    options.newton_tolerance = 1e-11;
    testing_support::Drive drive("esdirk43", *system, options);
    ASSERT_EQ(drive.to(end.t), Status::ok) << drive.integrator->failure();
    const Vector q = vector_of(drive.integrator->q()).head(5),
                 v = vector_of(drive.integrator->v());
    const double digits_q = digits(q, end.q, q_typ.head(5)),
                 digits_v = digits(v, end.v, v_typ);
    std::printf("%d steps: %.2f digits of q, %.2f of v\n", steps, digits_q, digits_v);
    // Half the step of a method of order 4: 16 times, or 1.2 digits.
    if (before > 0) {
      EXPECT_GE(digits_q, end.digits_q);
      EXPECT_GE(digits_v, end.digits_v);
      EXPECT_LE(digits_q, end.digits_q + 2);
      EXPECT_LE(digits_v, end.digits_v + 2);
      EXPECT_NEAR(digits_v - before, 1.2, 0.3);
    }
    before = digits_v;
  }
}

TEST(Wheelset, ContactsHoldAtThePrintedEnd) {
  const auto system = make_model("wheelset");
  const Vector r = residual_of(*system, printed_end());
  // Rows of parallel normals and of G p', to the printed run's tolerance.
  EXPECT_LE(r.tail(6).lpNorm<Eigen::Infinity>(), 1e-8);
}

}  // namespace tress::test_wheelset
