#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "models/published/references.h"
#include "tests/models/published/support.h"

namespace tress {
namespace {

// First-order form y = (q, v) of a model, v' from its explicit form or from the dense
// index-1 system [M, -G^T; G, 0] (a, lambda) = (f, -bias).
class FirstOrder {
 public:
  explicit FirstOrder(System& system)
      : system_(system),
        n_(system.layout().coordinates),
        m_(system.layout().constraints),
        rest_(Vector::Zero(n_)),
        force_(n_),
        kkt_(Matrix::Zero(n_ + m_, n_ + m_)),
        right_(n_ + m_) {
    if (m_ > 0) {
      mass_.resize(system.sparse_form()->pattern().nonzeros());
      gradient_.resize(system.constraint_form()->pattern().nonzeros());
      bias_.resize(m_);
    }
  }

  int size() const { return 2 * n_; }
  const Vector& multipliers() const { return lambda_; }

  Status rhs(double t, const double* y, double* y_dot) {
    const In q(y, n_), v(y + n_, n_);
    std::copy(v.begin(), v.end(), y_dot);
    const Out a(y_dot + n_, n_);
    if (m_ == 0) return system_.explicit_form()->acceleration(t, q, v, a);
    ConstraintForm& constraints = *system_.constraint_form();
    SparseForm& sparse = *system_.sparse_form();
    const Status calls[] = {
        system_.residual(t, q, v, in(rest_), out(force_)),
        sparse.values(t, q, v, in(rest_), {1, 0, 0}, out(mass_)),
        constraints.gradient(t, q, out(gradient_)), constraints.bias(t, q, v, out(bias_))};
    for (const Status status : calls) {
      if (status != Status::ok) return status;
    }
    const Matrix gt = dense(constraints.pattern(), in(gradient_));
    kkt_.topLeftCorner(n_, n_) = dense(sparse.pattern(), in(mass_));
    kkt_.topRightCorner(n_, m_) = -gt;
    kkt_.bottomLeftCorner(m_, n_) = gt.transpose();
    right_ << -force_, -bias_;
    lu_.compute(kkt_);
    const Vector x = lu_.solve(right_);
    std::copy_n(x.data(), n_, a.data());
    lambda_ = x.tail(m_);
    return Status::ok;
  }

 private:
  System& system_;
  int n_, m_;
  Vector rest_, force_, mass_, gradient_, bias_, lambda_;
  Matrix kkt_;
  Vector right_;
  Eigen::PartialPivLU<Matrix> lu_;
};

int gsl_rhs(double t, const double* y, double* y_dot, void* problem) {
  const Status status = static_cast<FirstOrder*>(problem)->rhs(t, y, y_dot);
  return status == Status::ok ? GSL_SUCCESS : GSL_EBADFUNC;
}

// Adaptive Prince-Dormand 8(9) with one tolerance per entry, a fraction of its typical size.
Vector integrate(System& system, FirstOrder& problem, double t_end, double tolerance) {
  const int n = system.layout().coordinates;
  Vector scale(2 * n), y(2 * n);
  system.scale(Out(scale.data(), n), Out(scale.data() + n, n));
  system.initial_state(Out(y.data(), n), Out(y.data() + n, n));
  gsl_odeiv2_system ode{gsl_rhs, nullptr, static_cast<std::size_t>(2 * n), &problem};
  gsl_odeiv2_driver* driver = gsl_odeiv2_driver_alloc_scaled_new(
      &ode, gsl_odeiv2_step_rk8pd, 1e-6, tolerance, 0, 1, 0, scale.data());
  double t = 0;
  EXPECT_EQ(gsl_odeiv2_driver_apply(driver, &t, t_end, y.data()), GSL_SUCCESS);
  gsl_odeiv2_driver_free(driver);
  return y;
}

// Correct digits of the worst entry: -log10 of the error over the entry, where entries
// below a thousandth of the largest count relative to that.
double digits(const Vector& actual, In published) {
  const Vector expected = vector_of(published);
  const double floor = 1e-3 * expected.lpNorm<Eigen::Infinity>();
  double worst = 0;
  for (Eigen::Index i = 0; i < actual.size(); ++i) {
    const double size = std::max(std::abs(expected[i]), floor);
    worst = std::max(worst, std::abs(actual[i] - expected[i]) / size);
  }
  return -std::log10(worst);
}

class PublishedEndValues : public testing::TestWithParam<const char*> {};

TEST_P(PublishedEndValues, AreReproduced) {
  const PublishedEnd* end = published_end(GetParam());
  ASSERT_NE(end, nullptr);
  const auto system = make_model(GetParam());
  const int n = system->layout().coordinates;
  FirstOrder problem(*system);
  // Four digits finer than asked for, for the growth of local errors along the run.
  const Vector y = integrate(*system, problem, end->t, 1e-13);
  const double digits_q = digits(y.head(n), end->q), digits_v = digits(y.tail(n), end->v);
  RecordProperty("digits_q", std::to_string(digits_q));
  RecordProperty("digits_v", std::to_string(digits_v));
  std::cout << digits_q << " " << digits_v;
  EXPECT_GE(digits_q, end->digits_q);
  EXPECT_GE(digits_v, end->digits_v);
  if (end->lambda.empty()) return;
  Vector rate(problem.size());
  ASSERT_EQ(problem.rhs(end->t, y.data(), rate.data()), Status::ok);
  std::cout << " " << digits(problem.multipliers(), end->lambda);
  EXPECT_GE(digits(problem.multipliers(), end->lambda), end->digits_q - 2);
}

INSTANTIATE_TEST_SUITE_P(All, PublishedEndValues,
                         testing::Values("andrews_squeezer", "slider_crank", "beam"),
                         [](const auto& param) { return std::string(param.param); });

TEST(PublishedEnd, IsNullForAModelWithoutOne) {
  EXPECT_EQ(published_end("double_pendulum"), nullptr);
}

}  // namespace
}  // namespace tress
