#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "contract/input_error.h"
#include "models/constrained/angles.h"
#include "models/constrained/constraint_set.h"
#include "models/constrained/on_curve.h"
#include "tests/support/variable.h"

namespace tress::test_constraint_set {

using namespace models;

using testing_support::Dual2;
using testing_support::variable2;

constexpr Node particle0{Node::Kind::particle, 0};
constexpr Node particle1{Node::Kind::particle, 1};
constexpr Node particle2{Node::Kind::particle, 2};
constexpr Node anchor0{Node::Kind::anchor, 0};
constexpr Node parameter0{Node::Kind::parameter, 0};

// Three particles and one parameter: 10 coordinates; with time, 11 variables.
constexpr int coordinates = 10;
using Number = Dual2<coordinates + 1>;

const double now = 0.37;  // s

/// One module on a moving anchor, and the same constraint evaluated on derivative numbers
/// along the path q + v (t - now), whose derivatives are everything that a ConstraintForm
/// gives.
class Assembled {
 public:
  template <class Evaluate>
  Assembled(std::unique_ptr<const Constraint> module, Evaluate evaluate)
      : motion_(orbit({0.1, 0.2, 1}, {0.5, 0, 0.1}, {0, 0.4, 0}, 0.6)) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> number(-1, 1);
    for (double& x : q_) x = number(random);
    for (double& x : v_) x = number(random);
    const Number t = variable2<coordinates + 1>(now, coordinates);
    std::array<Number, coordinates> path;
    for (std::size_t i = 0; i < coordinates; ++i) {
      path[i] = variable2<coordinates + 1>(q_[i], i) + Number(v_[i]) * (t - Number(now));
    }
    const Vec3<Number> anchor = motion_->position(t);
    std::vector<Number> z;
    for (const Node node : module->nodes()) {
      for (int axis = 0; axis < node.size(); ++axis) {
        const Number placed[] = {anchor.x, anchor.y, anchor.z};
        const int first = node.kind == Node::Kind::parameter ? 9 : 3 * node.index;
        z.push_back(node.kind == Node::Kind::anchor
                        ? placed[axis]
                        : path[static_cast<std::size_t>(first) + axis]);
      }
    }
    rows_ = static_cast<std::size_t>(module->rows());
    exact_.resize(rows_);
    evaluate(z.data(), exact_.data());
    Constraints modules;
    modules.push_back(std::move(module));
    set_ = std::make_unique<ConstraintSet>(std::move(modules),
                                           std::vector<Anchor>{{{}, motion_}}, 3, 1, 1.0);
    build_coupling();
  }

  void expect_derivatives() {
    std::vector<double> g(rows_), rate(rows_), bias(rows_);
    const auto entries = static_cast<std::size_t>(set_->pattern().nonzeros());
    std::vector<double> gradient(entries), rate_gradient(entries);
    ASSERT_EQ(set_->value(now, q_, g), Status::ok);
    ASSERT_EQ(set_->rate(now, q_, v_, rate), Status::ok);
    ASSERT_EQ(set_->bias(now, q_, v_, bias), Status::ok);
    ASSERT_EQ(set_->gradient(now, q_, gradient), Status::ok);
    ASSERT_EQ(set_->rate_gradient(now, q_, v_, rate_gradient), Status::ok);
    const Eigen::MatrixXd gt = dense(set_->pattern(), gradient);
    const Eigen::MatrixXd dt = dense(set_->pattern(), rate_gradient);
    for (std::size_t k = 0; k < rows_; ++k) {
      const Number& exact = exact_[k];
      near(g[k], exact.value.value, "value");
      near(rate[k], exact.part[coordinates].value, "rate");
      near(bias[k], exact.part[coordinates].part[coordinates], "bias");
      for (std::size_t i = 0; i < coordinates; ++i) {
        near(gt(int(i), int(k)), exact.part[i].value, "gradient");
        near(dt(int(i), int(k)), exact.part[coordinates].part[i], "rate gradient");
      }
    }
    expect_curvature();
  }

 private:
  /// Hand-written and dual arithmetic differ by a few hundred roundings: 1e3 eps = 2e-13.
  static void near(double got, double want, const char* what) {
    EXPECT_NEAR(got, want, 1e-12 * (10 + std::abs(want))) << what;
  }

  static Eigen::MatrixXd dense(const Pattern& p, const std::vector<double>& values) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(p.rows, p.cols);
    for (int j = 0; j < p.cols; ++j) {
      for (int k = p.start[std::size_t(j)]; k < p.start[std::size_t(j) + 1]; ++k) {
        m(p.row[std::size_t(k)], j) = values[std::size_t(k)];
      }
    }
    return m;
  }

  void build_coupling() {
    std::vector<std::vector<int>> columns(coordinates);
    set_->couple(columns);
    coupling_.rows = coupling_.cols = coordinates;
    coupling_.start = {0};
    for (auto& rows : columns) {
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      coupling_.row.insert(coupling_.row.end(), rows.begin(), rows.end());
      coupling_.start.push_back(static_cast<int>(coupling_.row.size()));
    }
    set_->bind(coupling_);
  }

  void expect_curvature() {
    const std::vector<double> lambda{0.7, -1.3, 0.4};
    const double factor = -2.5;
    std::vector<double> s(coupling_.row.size(), 0.0);
    ASSERT_EQ(set_->add_curvature(now, q_, std::span(lambda).first(rows_), factor, s),
              Status::ok);
    const Eigen::MatrixXd got = dense(coupling_, s);
    for (std::size_t i = 0; i < coordinates; ++i) {
      for (std::size_t j = 0; j < coordinates; ++j) {
        double want = 0;
        for (std::size_t k = 0; k < rows_; ++k) {
          want += factor * lambda[k] * exact_[k].part[i].part[j];
        }
        near(got(int(i), int(j)), want, "curvature");
      }
    }
  }

  std::shared_ptr<const FourierCurve> motion_;
  std::array<double, coordinates> q_, v_;
  std::size_t rows_ = 0;
  std::vector<Number> exact_;
  std::unique_ptr<ConstraintSet> set_;
  Pattern coupling_;
};

template <class Kernel>
void expect_assembled(std::array<Node, Kernel::node_count> nodes, Kernel kernel) {
  Assembled(std::make_unique<Module<Kernel>>(nodes, kernel), [&](const Number* z,
                                                                 Number* c) {
    kernel.value(z, c);
  }).expect_derivatives();
}

const Vec axis1{0.6, 0.8, 0}, axis2{-0.8, 0.6, 0}, axis3{0, 0, 1};

TEST(ConstraintSet, FixedPointOnMovingAnchorGivesAllDerivatives) {
  expect_assembled<Difference<Coincidence>>({particle1, anchor0}, {});
}
TEST(ConstraintSet, DistanceBetweenParticlesGivesAllDerivatives) {
  expect_assembled<Difference<FixedDistance>>({particle2, particle0}, {{0.7}});
}
TEST(ConstraintSet, DistanceToMovingAnchorGivesAllDerivatives) {
  expect_assembled<Difference<FixedDistance>>({anchor0, particle2}, {{0.7}});
}
TEST(ConstraintSet, MovingPlaneGivesAllDerivatives) {
  expect_assembled<Difference<OnPlane>>({particle1, anchor0}, {{axis2}});
}
TEST(ConstraintSet, MovingEllipseGivesAllDerivatives) {
  expect_assembled<Difference<OnEllipse>>({particle0, anchor0},
                                          {{axis1, axis2, axis3, 1.2, 0.5}});
}
TEST(ConstraintSet, MovingHelixGivesAllDerivatives) {
  expect_assembled<Difference<OnHelix>>({particle0, anchor0},
                                        {{axis1, axis2, axis3, 1.2, 0.5}});
}
TEST(ConstraintSet, AngleAtMovingAnchorGivesAllDerivatives) {
  expect_assembled<Angle>({particle2, anchor0, particle0},
                          {std::cos(0.9), std::sin(0.9)});
}
TEST(ConstraintSet, TriangleWithOneMovingCornerGivesAllDerivatives) {
  expect_assembled<Triangle>({particle1, particle2, anchor0}, {{0.7, 0.9, 1.1}});
}
TEST(ConstraintSet, PointOnAnyCurveGivesAllDerivatives) {
  const std::shared_ptr<const FourierCurve> knot = trefoil(1.5);
  Assembled(point_on_curve(particle1, parameter0, knot), [&](const Number* z, Number* c) {
    store3(load3(z) - knot->position(z[3]), c);
  }).expect_derivatives();
}

void build(std::unique_ptr<const Constraint> module) {
  Constraints modules;
  modules.push_back(std::move(module));
  ConstraintSet(std::move(modules), {}, 2, 1, 1.0);
}

TEST(ConstraintSet, RefusesNodesThatAreMissingRepeatedOrOfTheWrongKind) {
  EXPECT_NO_THROW(build(distance(particle0, particle1, 1)));
  EXPECT_THROW(build(distance(particle0, particle0, 1)), InputError);
  EXPECT_THROW(build(distance(particle0, particle2, 1)), InputError);
  EXPECT_THROW(build(distance(particle0, anchor0, 1)), InputError);
  EXPECT_THROW(build(distance(particle0, parameter0, 1)), InputError);
}

TEST(Modules, RefuseShapesThatDoNotExist) {
  EXPECT_THROW((void)distance(particle0, particle1, 0), InputError);
  EXPECT_THROW((void)distance(particle0, particle1, std::nan("")), InputError);
  EXPECT_THROW((void)point_on_plane(particle0, anchor0, {}), InputError);
  EXPECT_THROW((void)point_on_ellipse(particle0, anchor0, {1, 0, 0}, {1, 1, 0}),
               InputError);
  EXPECT_THROW((void)point_on_helix(particle0, anchor0, {1, 0, 0}, {0, 1, 0}, {}),
               InputError);
  EXPECT_THROW((void)angle(particle0, particle1, particle2, 0), InputError);
  EXPECT_THROW((void)across(particle0, particle1, particle2, 0), InputError);
  EXPECT_THROW((void)rigid_triangle(particle0, particle1, particle2, {1, 1, 2}),
               InputError);
  EXPECT_THROW((void)point_on_curve(particle0, particle1, trefoil(1)), InputError);
}

}  // namespace tress::test_constraint_set
