#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "contract/forms/explicit_form.h"
#include "contract/forms/sparse_form.h"
#include "contract/system.h"
#include "tests/models/published/support.h"

namespace tress::test_tangents {

using namespace experiments;

constexpr Weights method_weights[] = {
    {1, 0, 0},           // mass alone
    {1, 1e-3, 1e-6},     // backward Euler, h = 1 ms
    {1, .5e-2, 2.5e-5},  // Newmark, h = 10 ms
    {1e6, 1e3, 1},       // IDA, c_j = 1000
};

class PublishedTangent : public testing::TestWithParam<const char*> {};

TEST_P(PublishedTangent, SolveInvertsTheDerivativeOfTheResidual) {
  const auto system = make_model(GetParam());
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const DenseState s = random_state(*system, seed);
    for (const Weights& w : method_weights) {
      EXPECT_LE(tangent_error(*system, s, w, seed), 1e-7)
          << "seed " << seed << " " << w.acc;
    }
  }
}

TEST_P(PublishedTangent, MassIsSymmetricAndPositive) {
  const auto system = make_model(GetParam());
  for (unsigned seed = 1; seed <= 5; ++seed) {
    // At the start only: far from it the crank's elastic modes are no small deflections.
    DenseState s = start_of(*system);
    s.v = random_state(*system, seed).v;
    const Matrix mass = tangent_of(*system, s, {1, 0, 0});
    // The tangent comes through an inverse: its rounding grows with the condition number.
    const Matrix inverse = solution(mass, Matrix::Identity(mass.rows(), mass.cols()));
    const double condition = mass.norm() * inverse.norm();
    EXPECT_LE((mass - mass.transpose()).norm(), 1e-15 * condition * mass.norm());
    EXPECT_GT(symmetric_eigenvalues(mass).minCoeff(), 0);
  }
}

TEST_P(PublishedTangent, SparseFormAgreesWithSolve) {
  const auto system = make_model(GetParam());
  SparseForm* form = system->sparse_form();
  if (form == nullptr) GTEST_SKIP() << "no sparse form";
  const DenseState s = random_state(*system, 3);
  const int n = system->layout().coordinates;
  Vector values(form->pattern().nonzeros()), x(n);
  for (const Weights& w : method_weights) {
    ASSERT_EQ(form->values(s.t, in(s.q), in(s.v), in(s.a), w, out(values)), Status::ok);
    const Matrix matrix = dense(form->pattern(), in(values));
    const Vector b = random_vector(n, 7);
    ASSERT_EQ(system->linearize(s.t, in(s.q), in(s.v), in(s.a), w), Status::ok);
    ASSERT_EQ(system->solve(in(b), out(x)), Status::ok);
    // Backward stability of LU: n^2 eps with partial pivoting's modest growth.
    EXPECT_LE((matrix * x - b).norm(), 1e-14 * (matrix.norm() * x.norm() + b.norm()));
  }
}

// The gap between the tangents is above the first test's bound: it notices a missing
// term.
TEST_P(PublishedTangent, DroppedTermsAreNoticed) {
  const Parameters known(find_model(GetParam()).parameters, "model");
  if (!known.knows("jacobian")) GTEST_SKIP() << "one tangent";
  const auto system = make_model(GetParam(), {{"jacobian", "elastic"}});
  const DenseState s = random_state(*system, 1);
  EXPECT_GT(tangent_error(*system, s, {1, .5e-2, 2.5e-5}, 1), 1e-7);
}

TEST_P(PublishedTangent, ExplicitAccelerationMakesTheResidualVanish) {
  const auto system = make_model(GetParam());
  ExplicitForm* form = system->explicit_form();
  if (form == nullptr) GTEST_SKIP() << "constrained";
  for (unsigned seed = 1; seed <= 5; ++seed) {
    DenseState s = random_state(*system, seed);
    s.a.setZero();
    const Vector force = residual_of(*system, s);
    ASSERT_EQ(form->acceleration(s.t, in(s.q), in(s.v), out(s.a)), Status::ok);
    // Cancelled to rounding of the largest term that M a adds up.
    const Matrix mass = tangent_of(*system, s, {1, 0, 0});
    const double terms = mass.norm() * s.a.norm() + force.norm();
    EXPECT_LE(residual_of(*system, s).norm(), 1e-13 * terms);
    EXPECT_GT(s.a.norm(), 0);
  }
}

TEST_P(PublishedTangent, ResidualIsPure) {
  const auto system = make_model(GetParam());
  const DenseState s = random_state(*system, 1), other = random_state(*system, 2);
  const Vector once = residual_of(*system, s);
  residual_of(*system, other);
  ASSERT_EQ(system->linearize(other.t, in(other.q), in(other.v), in(other.a), {1, 1, 1}),
            Status::ok);
  const Vector again = residual_of(*system, s);
  EXPECT_TRUE(once == again);
}

INSTANTIATE_TEST_SUITE_P(All, PublishedTangent,
                         testing::Values("andrews_squeezer", "slider_crank", "car_axis",
                                         "beam", "double_pendulum", "filament"),
                         [](const auto& param) { return std::string(param.param); });

TEST(Beam, ShortChainsKeepTheirTangent) {
  for (const char* segments : {"1", "2", "3"}) {
    const auto system = make_model("beam", {{"segments", segments}});
    const DenseState s = random_state(*system, 5);
    for (const Weights& w : method_weights) {
      EXPECT_LE(tangent_error(*system, s, w, 5), 1e-7) << segments;
    }
  }
}

TEST(Beam, ResidualIsThePrintedEquation) {
  // Hairer & Wanner II, eqs. (IV.1.13)-(1.16), dense, times n^-3.
  const auto system = make_model("beam", {{"segments", "6"}});
  const int n = 6;
  const DenseState s = random_state(*system, 4);
  const double push = 1.5 * std::pow(std::sin(s.t), 2);
  Vector r(n);
  for (int l = 1; l <= n; ++l) {
    const auto theta = [&](int k) { return k == 0 ? -s.q[0] : s.q[std::min(k, n) - 1]; };
    double sum = 0;
    for (int k = 1; k <= n; ++k) {
      const double g = n + 0.5 - std::max(l, k);
      sum += g * std::cos(theta(l) - theta(k)) * s.a[k - 1];
      sum += g * std::sin(theta(l) - theta(k)) * s.v[k - 1] * s.v[k - 1];
    }
    sum -= std::pow(n, 4) * (theta(l - 1) - 2 * theta(l) + theta(l + 1));
    sum -= n * n * push * (std::cos(theta(l)) + std::sin(theta(l)));
    r[l - 1] = sum / std::pow(n, 3);
  }
  EXPECT_LE((residual_of(*system, s) - r).norm(), 1e-13 * (r.norm() + n));
}

}  // namespace tress::test_tangents
