// Constraints of supports on every model of a strand: their derivatives against
// differences, the matrix against the model's own solutions, and refusals.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/input_error.h"
#include "tests/models/supports/held_strand.h"
#include "tests/support/refusal.h"

namespace tress::test_support_rows {

using namespace testing_support;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Models of a strand, clamped to a shaken root or free, with a point in the middle on a
/// support that moves, and a clamp of the last one that moves and turns if the model has
/// a section there.
struct Held {
  std::unique_ptr<SupportedSystem> system;
  ConstraintForm& form() const { return *system->constraint_form(); }
  std::size_t n() const { return static_cast<std::size_t>(system->layout().coordinates); }
  std::size_t m() const { return static_cast<std::size_t>(system->layout().constraints); }
};

Held hold(const ModelEntry& model, const std::string& motion, double friction = 0) {
  const ModelSettings settings{
      {"elements", "6"}, {"motion", motion}, {"natural_curvature_per_m", "10"}};
  auto strand = make_model(std::string(model.id), settings);
  const std::vector<Vec> x = places_at_start(*strand);
  Support tip = support(6, x[6], {0, -0.02, 0.01}, 0.07);
  if (sections(*strand)->section_kind(6).turning != Sections::Turning::nothing) {
    tip = clamp_of_tip(*strand, std::string(model.id), settings, HeldPart::frame,
                       {0, -0.02, 0.01}, 0.07);
    tip.path.rotations.push_back({{0, 1, 0}, rests({0, 0.05}, {0.1, 0.4})});
    tip.path.rotations.push_back({{1, 2, 0}, rests({0, 0.06}, {-0.1, 0.3})});
    tip.half_edge.friction = friction * tip.half_edge.stiffness;
  }
  return {std::make_unique<SupportedSystem>(
      std::move(strand), std::vector{support(3, x[3], {0.01, 0, 0.02}, 0.05), tip})};
}

std::vector<std::pair<const ModelEntry*, std::string>> cases() {
  std::vector<std::pair<const ModelEntry*, std::string>> all;
  for (const ModelEntry& model : model_catalogue()) {
    // It has no accelerations of its points, and is refused.
    if (model.on_strand == nullptr || model.id == "kirchhoff_nodal") continue;
    all.emplace_back(&model, "shake_rotate");
    if (model.roots == Roots::clamped_or_free) all.emplace_back(&model, "free");
  }
  return all;
}

class SupportRowsOf
    : public testing::TestWithParam<std::pair<const ModelEntry*, std::string>> {
 protected:
  Held held_ = hold(*GetParam().first, GetParam().second);
  States state_ = [this] {
    States made(*held_.system);
    made.shake(0.02);
    return made;
  }();

  VectorXd called(std::size_t size, const std::function<Status(Out)>& call) const {
    VectorXd y(static_cast<Eigen::Index>(size));
    EXPECT_EQ(call({y.data(), size}), Status::ok);
    return y;
  }
  MatrixXd matrix(
      const std::function<Status(Out)>& call) const {  // on the pattern of G^T
    const Pattern& pattern = held_.form().pattern();
    const VectorXd values = called(static_cast<std::size_t>(pattern.nonzeros()), call);
    MatrixXd full = MatrixXd::Zero(pattern.rows, pattern.cols);
    for (int k = 0; k < pattern.cols; ++k) {
      for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
           ++p) {
        full(pattern.row[std::size_t(p)], k) = values[p];
      }
    }
    return full;
  }
  VectorXd value(double t, In q) const {
    return called(held_.m(), [&](Out g) { return held_.form().value(t, q, g); });
  }
  VectorXd rate(double t, In q, In v) const {
    return called(held_.m(), [&](Out g) { return held_.form().rate(t, q, v, g); });
  }
  MatrixXd gradient(double t, In q) const {
    return matrix([&](Out g) { return held_.form().gradient(t, q, g); });
  }
  /// f(s) -> f'(0), central, of order 4: step e, error e^4 and roundoff/e.
  template <class F>
  static auto derivative(double e, const F& f) {
    return ((8 * (f(e) - f(-e)) - (f(2 * e) - f(-2 * e))) / (12 * e)).eval();
  }
};

/// Steps move every coordinate by 1e-3 of its typical size: the differences err by 1e-12
/// of the fifth derivatives, of size up to 100, and 1e-16/1e-3 by rounding. Own
/// derivatives of second order are differences with 1e-10.
constexpr double share = 1e-3, exact = 1e-9, by_differences = 1e-8;

TEST_P(SupportRowsOf, DerivativesAreThoseOfTheirValues) {
  const std::vector<double>&q = state_.q, &v = state_.v;
  const double t = 0.013;
  const MatrixXd g = gradient(t, q);
  MatrixXd expected = g;
  for (std::size_t i = 0; i < held_.n(); ++i) {
    std::vector<double> moved = q;
    expected.row(Eigen::Index(i)) = derivative(share * state_.q_typ[i], [&](double e) {
      moved[i] = q[i] + e;
      return value(t, moved);
    });
  }
  const VectorXd typ = Eigen::Map<const VectorXd>(state_.q_typ.data(), g.rows());
  const auto in_sizes = [&](const MatrixXd& x) { return (typ.asDiagonal() * x).eval(); };
  EXPECT_LE(in_sizes(g - expected).norm(), exact * in_sizes(g).norm());
  EXPECT_GT(in_sizes(g).norm(), 0);

  double fastest = 0;
  for (std::size_t i = 0; i < held_.n(); ++i) {
    fastest = std::max(fastest, std::abs(v[i]) / state_.q_typ[i]);
  }
  const double e = share / std::max(fastest, 50.0);  // the root turns by 50 rad/s at most
  std::vector<double> along(q.size());
  const auto at = [&](double s) -> const std::vector<double>& {
    for (std::size_t i = 0; i < q.size(); ++i) along[i] = q[i] + s * v[i];
    return along;
  };
  const VectorXd speed = rate(t, q, v);
  const VectorXd expected_speed =
      derivative(e, [&](double s) { return value(t + s, at(s)); });
  EXPECT_LE((speed - expected_speed).norm(), exact * speed.norm());
  const VectorXd bias =
      called(held_.m(), [&](Out b) { return held_.form().bias(t, q, v, b); });
  const VectorXd expected_bias =
      derivative(e, [&](double s) { return rate(t + s, at(s), v); });
  EXPECT_LE((bias - expected_bias).norm(), exact * (bias.norm() + speed.norm() / 0.01));

  const MatrixXd turning =
      matrix([&](Out x) { return held_.form().rate_gradient(t, q, v, x); });
  MatrixXd expected_turning = turning;
  for (std::size_t i = 0; i < held_.n(); ++i) {
    std::vector<double> moved = q;
    expected_turning.row(Eigen::Index(i)) =
        derivative(share * state_.q_typ[i], [&](double s) {
          moved[i] = q[i] + s;
          return rate(t, moved, v);
        });
  }
  EXPECT_LE(in_sizes(turning - expected_turning).norm(),
            by_differences * (in_sizes(turning).norm() + speed.norm()));
}

TEST_P(SupportRowsOf, CurvatureIsTheDerivativeOfTheirForce) {
  const std::vector<double>& q = state_.q;
  const double t = 0.013;
  SparseForm& form = *held_.system->sparse_form();
  const Pattern& pattern = form.pattern();
  std::vector<double> lambda(held_.m()), s(std::size_t(pattern.nonzeros()), 0.0);
  for (std::size_t k = 0; k < lambda.size(); ++k) lambda[k] = std::cos(1.0 + double(k));
  ASSERT_EQ(held_.form().add_curvature(t, q, lambda, -2, s), Status::ok);
  MatrixXd found = MatrixXd::Zero(pattern.rows, pattern.cols);
  for (int k = 0; k < pattern.cols; ++k) {
    for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
         ++p) {
      found(pattern.row[std::size_t(p)], k) = s[std::size_t(p)];
    }
  }
  MatrixXd expected = found;
  const Eigen::Map<const VectorXd> force(lambda.data(), Eigen::Index(lambda.size()));
  for (std::size_t i = 0; i < held_.n(); ++i) {
    std::vector<double> moved = q;
    expected.col(Eigen::Index(i)) = derivative(share * state_.q_typ[i], [&](double e) {
      moved[i] = q[i] + e;
      return (-2 * gradient(t, moved) * force).eval();
    });
  }
  const VectorXd typ = Eigen::Map<const VectorXd>(state_.q_typ.data(), found.rows());
  const auto in_sizes = [&](const MatrixXd& x) {
    return (typ.asDiagonal() * x * typ.asDiagonal()).norm();
  };
  const double size = (typ.asDiagonal() * gradient(t, q) * force).norm();
  EXPECT_LE(in_sizes(found - expected), by_differences * (in_sizes(found) + size));
}

/// Half joints add the derivative of their energy to the residual, and that of their
/// force to the matrix. Bars as for the constraints.
TEST_P(SupportRowsOf, HalfJointsHaveTheDerivativesOfTheirEnergy) {
  if (held_.system->joints() == 0) GTEST_SKIP() << "sections are constraints";
  const Held rubbed = hold(*GetParam().first, GetParam().second, 1e-3);
  System &held = *held_.system, &rubs = *rubbed.system, &alone = held_.system->strand();
  const std::vector<double>&q = state_.q, &v = state_.v, &a = state_.a, still(q.size());
  const double t = 0.013;
  const auto force = [&](System& of, In at, In rate) {
    const VectorXd with =
        called(q.size(), [&](Out r) { return of.residual(t, at, rate, a, r); });
    const VectorXd without =
        called(q.size(), [&](Out r) { return alone.residual(t, at, rate, a, r); });
    return (with - without).eval();
  };
  const auto energy = [&](In at) {
    return held.energetics()->energy(t, at, still).potential -
           alone.energetics()->energy(t, at, still).potential;
  };
  const auto matrix_of = [&](SparseForm& form, Weights w) {
    const Pattern& pattern = form.pattern();
    const VectorXd values = called(std::size_t(pattern.nonzeros()),
                                   [&](Out s) { return form.values(t, q, v, a, w, s); });
    MatrixXd full = MatrixXd::Zero(pattern.rows, pattern.cols);
    for (int k = 0; k < pattern.cols; ++k) {
      for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
           ++p) {
        full(pattern.row[std::size_t(p)], k) = values[p];
      }
    }
    return full;
  };
  const VectorXd typ =
      Eigen::Map<const VectorXd>(state_.q_typ.data(), Eigen::Index(q.size()));
  VectorXd expected(typ.size());
  MatrixXd by_q = MatrixXd::Zero(typ.size(), typ.size()), by_v = by_q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    std::vector<double> moved = q, faster = v;
    const double e = share * state_.q_typ[i];
    const auto at = [&](double s) -> const std::vector<double>& {
      moved[i] = q[i] + s;
      return moved;
    };
    expected[Eigen::Index(i)] = (8 * (energy(at(e)) - energy(at(-e))) -
                                 (energy(at(2 * e)) - energy(at(-2 * e)))) /
                                (12 * e);
    by_q.col(Eigen::Index(i)) =
        derivative(e, [&](double s) { return force(rubs, at(s), v); });
    by_v.col(Eigen::Index(i)) = derivative(state_.v_typ[i], [&](double s) {
      faster[i] = v[i] + s;
      return force(rubs, q, faster);
    });
  }
  const VectorXd found = force(held, q, still);
  EXPECT_LE((typ.asDiagonal() * (found - expected)).norm(),
            exact * (typ.asDiagonal() * found).norm() + exact * std::abs(energy(q)) +
                eps / share * alone.energetics()->energy(t, q, still).potential);
  EXPECT_GT(energy(q), 0);
  SparseForm& with = *rubs.sparse_form();
  std::optional<models::DenseTangent> dense;
  if (alone.sparse_form() == nullptr) dense.emplace(alone);
  SparseForm& without = dense ? *dense : *alone.sparse_form();
  const auto in_sizes = [&](const MatrixXd& x) {
    return (typ.asDiagonal() * x * typ.asDiagonal()).norm();
  };
  // A difference of matrices of inverses: their rounding, see below.
  const double size = in_sizes(by_q);
  EXPECT_LE(in_sizes(matrix_of(with, {1, 0, 1}) - matrix_of(without, {1, 0, 1}) - by_q),
            1e-7 * (size + in_sizes(matrix_of(without, {1, 0, 1}))));
  EXPECT_LE(in_sizes(matrix_of(with, {1, 1, 0}) - matrix_of(without, {1, 1, 0}) - by_v),
            1e-7 * (in_sizes(by_v) + in_sizes(matrix_of(without, {1, 1, 0}))));
}

/// S(w) x for x from the model's own solve: the rounding of an inverse, eps times the
/// condition of some 1e6 in typical sizes.
TEST_P(SupportRowsOf, MatrixIsTheOneThatTheModelSolvesWith) {
  System& system = *held_.system;
  SparseForm& form = *system.sparse_form();
  const Pattern& pattern = form.pattern();
  std::vector<double> s(std::size_t(pattern.nonzeros()));
  for (const Weights w : {Weights{1, 0, 0}, Weights{1, 1e-3, 1e-6}}) {
    if (w.pos == 0 && !system.traits().regular_mass) continue;
    ASSERT_EQ(form.values(0, state_.q, state_.v, state_.a, w, s), Status::ok);
    ASSERT_EQ(system.linearize(0, state_.q, state_.v, state_.a, w), Status::ok);
    const std::vector<double> x = state_.random(state_.a_typ);
    std::vector<double> b(x.size(), 0.0), y(x.size());
    for (int k = 0; k < pattern.cols; ++k) {
      for (int p = pattern.start[std::size_t(k)]; p < pattern.start[std::size_t(k) + 1];
           ++p) {
        b[std::size_t(pattern.row[std::size_t(p)])] +=
            s[std::size_t(p)] * x[std::size_t(k)];
      }
    }
    ASSERT_EQ(system.solve(b, y), Status::ok);
    EXPECT_LE(relative_difference(y, x, state_.a_typ), 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, SupportRowsOf, testing::ValuesIn(cases()),
                         [](const auto& test) {
                           return std::string(test.param.first->id) + "_" +
                                  test.param.second;
                         });

TEST(SupportRows, RefuseTheClampedRootAndASecondSupportOfAPoint) {
  const auto refused = [](std::vector<Support> supports) {
    return refusal(
        [&] { SupportedSystem(make_model("super_helix"), std::move(supports)); });
  };
  EXPECT_EQ(refused({support(0, {})}),
            "a support of the clamped root (support 0): leave it out, or give [root] "
            "motion = \"free\"");
  EXPECT_EQ(refused({support(5, {}), support(5, {})}),
            "a second support of one point (support 1): give one of them");
  EXPECT_EQ(refused({support(21, {})}),
            "no point 21 (support 0): give a point of 0 to 20");
}

}  // namespace tress::test_support_rows
