#include <gtest/gtest.h>

#include <functional>

#include "contract/forms/constraint_form.h"
#include "contract/forms/sparse_form.h"
#include "contract/system.h"
#include "tests/models/published/support.h"
#include "tests/support/dense.h"

namespace tress::test_constraints {

using namespace experiments;

class PublishedConstraints : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<System> system_ = make_model(GetParam());
  ConstraintForm& form_ = *system_->constraint_form();
  int n_ = system_->layout().coordinates;
  int m_ = system_->layout().constraints;

  using Call = std::function<Status(Out)>;
  static Vector filled(Eigen::Index size, const Call& call) {
    Vector y(size);
    EXPECT_EQ(call(out(y)), Status::ok);
    return y;
  }
  Vector value(double t, const Vector& q) {
    return filled(m_, [&](Out g) { return form_.value(t, in(q), g); });
  }
  Vector rate(double t, const Vector& q, const Vector& v) {
    return filled(m_, [&](Out g) { return form_.rate(t, in(q), in(v), g); });
  }
  Matrix gradient(double t, const Vector& q) {  // G^T
    return dense(form_.pattern(), in(filled(form_.pattern().nonzeros(), [&](Out g) {
                   return form_.gradient(t, in(q), g);
                 })));
  }
  Matrix rate_gradient(double t, const Vector& q, const Vector& v) {
    return dense(form_.pattern(), in(filled(form_.pattern().nonzeros(), [&](Out g) {
                   return form_.rate_gradient(t, in(q), in(v), g);
                 })));
  }
};

// Differences of step h = 1e-4 over functions of size |f|, extrapolated: rounding
// 1e-16 |f| / h = 1e-12 |f|, truncation h^4. Asked: 1e-9 of the largest entry.
constexpr double step = 1e-4;
constexpr double tolerance = 1e-9;

TEST_P(PublishedConstraints, StartIsConsistent) {
  const DenseState s = start_of(*system_);
  // Angles of the Test Set are printed to 30 digits; double keeps 1e-16 of 0.1 m. Rates:
  // rounding of 150 rad/s times 0.3 m.
  EXPECT_LE(value(0, s.q).lpNorm<Eigen::Infinity>(), 1e-15);
  EXPECT_LE(rate(0, s.q, s.v).lpNorm<Eigen::Infinity>(), 1e-13);
}

TEST_P(PublishedConstraints, GradientIsTheDerivativeOfTheValue) {
  const DenseState s = random_state(*system_, 1);
  const Matrix gt = gradient(s.t, s.q);
  for (int i = 0; i < n_; ++i) {
    const Vector column = derivative(
        [&](double h) { return value(s.t, s.q + h * Vector::Unit(n_, i)); }, step);
    EXPECT_LE((gt.row(i).transpose() - column).norm(), tolerance * (gt.norm() + 1));
  }
}

TEST_P(PublishedConstraints, RateIsTheTimeDerivativeOfTheValue) {
  const DenseState s = random_state(*system_, 2);
  const double h = step / s.v.norm();
  const Vector expected =
      derivative([&](double dt) { return value(s.t + dt, s.q + dt * s.v); }, h);
  const Vector actual = rate(s.t, s.q, s.v);
  EXPECT_LE((actual - expected).norm(), tolerance * s.v.norm());
}

TEST_P(PublishedConstraints, BiasIsTheTimeDerivativeOfTheRateWithoutAcceleration) {
  const DenseState s = random_state(*system_, 3);
  const double h = step / s.v.norm();
  const Vector expected =
      derivative([&](double dt) { return rate(s.t + dt, s.q + dt * s.v, s.v); }, h);
  const Vector actual =
      filled(m_, [&](Out b) { return form_.bias(s.t, in(s.q), in(s.v), b); });
  EXPECT_LE((actual - expected).norm(), tolerance * s.v.squaredNorm());
  EXPECT_GT(actual.norm(), 0);
}

TEST_P(PublishedConstraints, RateGradientIsTheDerivativeOfTheRate) {
  const DenseState s = random_state(*system_, 4);
  const Matrix actual = rate_gradient(s.t, s.q, s.v);
  for (int i = 0; i < n_; ++i) {
    const Vector column = derivative(
        [&](double h) { return rate(s.t, s.q + h * Vector::Unit(n_, i), s.v); }, step);
    EXPECT_LE((actual.row(i).transpose() - column).norm(), tolerance * s.v.norm());
  }
}

TEST_P(PublishedConstraints, CurvatureIsTheDerivativeOfTheConstraintForce) {
  const DenseState s = random_state(*system_, 5);
  const Vector lambda = random_vector(m_, 6);
  const Pattern& pattern = system_->sparse_form()->pattern();
  Vector values = Vector::Ones(pattern.nonzeros());
  const double factor = -1.7;
  ASSERT_EQ(form_.add_curvature(s.t, in(s.q), in(lambda), factor, out(values)),
            Status::ok);
  const Matrix actual = dense(pattern, in(values)) - Matrix::Ones(n_, n_);
  for (int i = 0; i < n_; ++i) {
    const Vector column = derivative(
        [&](double h) -> Vector {
          return factor * gradient(s.t, s.q + h * Vector::Unit(n_, i)) * lambda;
        },
        step);
    EXPECT_LE((actual.col(i) - column).norm(), tolerance * lambda.norm());
  }
  EXPECT_GT(actual.norm(), 0);
}

TEST_P(PublishedConstraints, ConstraintsAreIndependentAtTheStart) {
  const Matrix gt = gradient(0, start_of(*system_).q);
  EXPECT_EQ(testing_support::rank(gt), m_);
}

INSTANTIATE_TEST_SUITE_P(All, PublishedConstraints,
                         testing::Values("andrews_squeezer", "slider_crank", "car_axis"),
                         [](const auto& param) { return std::string(param.param); });

TEST(SliderCrank, RigidStartIsConsistent) {
  const auto system = make_model("slider_crank", {{"start", "rigid"}});
  const DenseState s = start_of(*system);
  Vector g(3);
  ASSERT_EQ(system->constraint_form()->rate(0, in(s.q), in(s.v), out(g)), Status::ok);
  EXPECT_LE(g.norm(), 1e-13);
  EXPECT_NEAR(s.v[1], -75, 1e-12);  // the Test Set's value
}

}  // namespace tress::test_constraints
