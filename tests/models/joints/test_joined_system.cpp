// Joined strands: their matrix and constraints against differences and the full matrix.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "linear/kkt.h"
#include "models/effects/driven_body.h"
#include "models/strand/rod_joint.h"
#include "tests/models/joints/joined_strands.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_joined_system {

using namespace testing_support;
using models::Joint;
using models::JointKind;

constexpr double t = 0.013;  // s

struct Case {
  const char* name;
  const char* model;
  JointKind kind;
  bool loop = false;  // a second joint between the middles of the strands
  enum class Body { none, turns, free } body = Body::none;  // in place of the second
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }  // NOLINT

const ModelSettings curved{{"elements", "4"},
                           {"natural_curvature_per_m", "10"},
                           {"internal_friction_kg_m3_s", "0"}};

/// A strand with a moving clamp, and a body at its tip. It is as heavy as the strand.
std::unique_ptr<models::JoinedSystem> with_body(const Case& of) {
  const ModelSettings settings = with(curved, {{"motion", "shake_rotate"}});
  const Strand strand = strand_at(of.model, settings);
  const Vec tip = tip_of(strand).x;
  const models::BodyContact law{.stiffness = 1, .damping = 0, .friction = 0};
  models::BodyDrive drive = models::FreeBody{.mass = 1e-6,
                                             .inertia = {1e-10, 1.5e-10, 2e-10},
                                             .velocity = {},
                                             .spin = {1, 2, 3}};
  if (of.body == Case::Body::turns) {
    drive = models::Bearing{.axis = {0.3, 1, -0.2},
                            .pivot = tip + Vec{0.01, -0.02, 0.03},
                            .inertia = 1e-9,
                            .damping = 1e-9};
  }
  static std::vector<std::unique_ptr<models::DrivenBody>> bodies;
  bodies.push_back(std::make_unique<models::DrivenBody>(
      models::Body(models::Sphere{0.01},
                   {tip + Vec{0.01, 0, 0.02}, rotation({0, 0, 1}, 0.3)}, law),
      drive));
  std::vector<std::unique_ptr<SupportedSystem>> members;
  members.push_back(joinable(of.model, settings, strand));
  auto body = models::make_body_system(*bodies.back(), {0, 0, -9.81},
                                       models::typical_motion(*members.front()));
  Joint joint = joint_of(of.kind, {1, body->add_point(tip)}, {0, 4});
  joint.axis = {0.3, 1, -0.2};
  constexpr double rigid = std::numeric_limits<double>::infinity();
  joint.half_a = {{}, {rigid, rigid, rigid}, {rigid, rigid, rigid}};
  joint.half_b = rod_joint(strand, nullptr, strand.segments.back(), {});
  members.push_back(models::as_supported(std::move(body)));
  return std::make_unique<models::JoinedSystem>(std::move(members),
                                                std::vector<Joint>{joint},
                                                std::vector<std::string>{"joint"}, 1);
}

/// A strand with a moving clamp, and one whose free root begins at its tip, at an angle.
std::unique_ptr<models::JoinedSystem> pair_of(const Case& of) {
  if (of.body != Case::Body::none) return with_body(of);
  const ModelSettings settings = with(curved, {{"motion", "shake_rotate"}});
  const Strand a = strand_at(of.model, settings);
  StrandPlace root = tip_of(a);
  root.frame = root.frame * rotation({0, 0, 1}, 0.7) * rotation({1, 0, 0}, 0.4);
  const Strand b = strand_at(of.model, settings, root);
  Joint joint = joint_of(of.kind, {0, 4}, {1, 0});
  joint.axis = {0.3, 1, -0.2};
  joint.stiffness = 0.01;
  joint.rest_length = 0;
  joint.half_a = rod_joint(a, nullptr, a.segments.back(), {});
  joint.half_b = rod_joint(b, nullptr, b.segments.front(), {});
  std::vector<Joint> joints{joint};
  if (of.loop) {
    Joint spring = joint_of(JointKind::spring, {0, 2}, {1, 3});
    spring.stiffness = 0.02;
    spring.rest_length = 0.01;
    joints.push_back(spring);
  }
  std::vector<std::unique_ptr<SupportedSystem>> strands;
  strands.push_back(joinable(of.model, settings, a));
  strands.push_back(joinable(of.model, settings, b));
  return joined(std::move(strands), joints);
}

class JoinedStrands : public testing::TestWithParam<Case> {
 protected:
  std::unique_ptr<models::JoinedSystem> system_ = pair_of(GetParam());
  States state_ = [this] {
    States made(*system_);
    made.shake(0.02);
    return made;
  }();
  /// Forces that turn a coordinate by its typical size in the typical time.
  std::vector<double> lambda_ = [this] {
    std::vector<double> of(state_.m);
    for (std::size_t k = 0; k < of.size(); ++k) {
      of[k] = (system_->rows().turns(int(k)) ? 1e-7 : 1e-5) * state_.uniform();
    }
    return of;
  }();

  /// r - G^T lambda at the state moved by s times w x.
  std::vector<double> residual(double s, Weights w, In x) {
    std::vector<double> q = state_.q, v = state_.v, a = state_.a, r(q.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += s * w.pos * x[i];
      v[i] += s * w.vel * x[i];
      a[i] += s * w.acc * x[i];
    }
    EXPECT_EQ(system_->residual(t, q, v, a, r), Status::ok);
    if (lambda_.empty()) return r;
    const Pattern& pattern = system_->constraint_form()->pattern();
    std::vector<double> gt(std::size_t(pattern.nonzeros()));
    EXPECT_EQ(system_->constraint_form()->gradient(t, q, gt), Status::ok);
    for (std::size_t k = 0; k < lambda_.size(); ++k) {
      for (auto p = std::size_t(pattern.start[k]); p < std::size_t(pattern.start[k + 1]);
           ++p) {
        r[std::size_t(pattern.row[p])] -= lambda_[k] * gt[p];
      }
    }
    return r;
  }
};

/// S x = b for x = S^-1 b, with S x from differences of the residual. Steps change no
/// coordinate by more than 7e-4 of its typical size: the differences err by 1e-12 of
/// the terms, which cancel to b in stiff strands, by up to 1e5. Bar: 1e-7 of the largest.
/// Strands of edges take second derivatives of sections from differences (1e-10).
TEST_P(JoinedStrands, SolveWithTheDerivativeOfTheResidual) {
  for (const Weights w :
       {Weights{1, 1e-3, 1e-6}, Weights{1, 0, 1e-4}, Weights{1, 1e-2, 1e-4}}) {
    ASSERT_EQ(system_->linearize_bordered(t, state_.q, state_.v, state_.a, lambda_, w),
              Status::ok);
    std::vector<double> b = residual(0, w, state_.q), x(b.size());
    ASSERT_EQ(system_->solve(b, x), Status::ok);
    double size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      size = std::max({size, w.pos * std::abs(x[i]) / state_.q_typ[i],
                       w.vel * std::abs(x[i]) / state_.v_typ[i],
                       std::abs(x[i]) / state_.a_typ[i]});
    }
    const std::vector<double> found =
        central_difference(testing_support::difference_step / size,
                           [&](double s) { return residual(s, w, x); });
    double off = 0, terms = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      off = std::max(off, state_.q_typ[i] * std::abs(found[i] - b[i]));
      terms = std::max(terms, state_.q_typ[i] * std::abs(b[i]));
    }
    std::printf("%s: %.1e of the residual\n", GetParam().name, off / terms);
    EXPECT_LE(off, 1e-7 * terms);
  }
}

/// g', g'' - G a and the derivative of g' against differences along the motion (relative
/// error 1e-10 of the rates of the strand, which are about 1 per typical time).
TEST_P(JoinedStrands, HaveTheRatesOfTheirConstraints) {
  ConstraintForm* const rows = system_->constraint_form();
  if (rows == nullptr) return;
  const std::size_t n = state_.n, m = state_.m;
  double rate = 0;
  for (std::size_t i = 0; i < n; ++i) {
    rate = std::max(rate, std::abs(state_.v[i]) / state_.q_typ[i]);
  }
  const double h = models::difference_step / rate;
  const auto moved = [&](double s) {
    std::vector<double> q = state_.q;
    for (std::size_t i = 0; i < n; ++i) {
      q[i] += s * state_.v[i] + s * s / 2 * state_.a[i];
    }
    return q;
  };
  const auto velocity = [&](double s) {
    std::vector<double> v = state_.v;
    for (std::size_t i = 0; i < n; ++i) v[i] += s * state_.a[i];
    return v;
  };
  std::vector<double> ahead(m), behind(m), exact(m), scale(m);
  rows->scale(scale);
  const auto apart = [&](double over) {
    double most = 0;
    for (std::size_t k = 0; k < m; ++k) {
      most = std::max(most, std::abs((ahead[k] - behind[k]) / (2 * h) - exact[k]) /
                                (scale[k] * over));
    }
    return most;
  };
  ASSERT_EQ(rows->value(t + h, moved(h), ahead), Status::ok);
  ASSERT_EQ(rows->value(t - h, moved(-h), behind), Status::ok);
  ASSERT_EQ(rows->rate(t, state_.q, state_.v, exact), Status::ok);
  EXPECT_LE(apart(rate), 1e-8);
  ASSERT_EQ(rows->rate(t + h, moved(h), velocity(h), ahead), Status::ok);
  ASSERT_EQ(rows->rate(t - h, moved(-h), velocity(-h), behind), Status::ok);
  ASSERT_EQ(rows->bias(t, state_.q, state_.v, exact), Status::ok);
  std::vector<double> gt(std::size_t(rows->pattern().nonzeros()));
  ASSERT_EQ(rows->gradient(t, state_.q, gt), Status::ok);
  for (std::size_t k = 0; k < m; ++k) {
    for (int p = rows->pattern().start[k]; p < rows->pattern().start[k + 1]; ++p) {
      exact[k] +=
          gt[std::size_t(p)] * state_.a[std::size_t(rows->pattern().row[std::size_t(p)])];
    }
  }
  EXPECT_LE(apart(rate * rate), 1e-8);
}

/// Corrections of Newton's method against those of the full matrix with constraints as
/// rows. The full one is an inverse of solutions (1e-16 times a condition of 1e6 in
/// typical sizes), with second derivatives by differences (1e-10).
TEST_P(JoinedStrands, HaveTheCorrectionsOfTheFullMatrix) {
  if (system_->layout().constraints == 0) return;
  Options options;
  options.formulation = Formulation::index3;
  integrators::Dynamics dynamics(*system_, options);
  SparseForm& form = *static_cast<System&>(*system_).sparse_form();
  ConstraintForm& rows = *system_->constraint_form();
  std::vector<double> s(std::size_t(form.pattern().nonzeros())),
      gt(std::size_t(rows.pattern().nonzeros()));
  Kkt kkt(LinearKind::automatic, form.pattern(), rows.pattern());
  for (const Weights w :
       {Weights{1, 0, 0}, Weights{1, 1e-3, 1e-6}, Weights{1, 0, 1e-4}}) {
    ASSERT_EQ(form.values(t, state_.q, state_.v, state_.a, w, s), Status::ok);
    if (w.pos != 0) {
      ASSERT_EQ(rows.add_curvature(t, state_.q, lambda_, -w.pos, s), Status::ok);
    }
    ASSERT_EQ(rows.gradient(t, state_.q, gt), Status::ok);
    ASSERT_EQ(kkt.factor(s, gt, gt), Status::ok);
    ASSERT_EQ(dynamics.linearize(t, state_.q, state_.v, state_.a, lambda_, w),
              Status::ok);
    EXPECT_EQ(dynamics.stats.solver, "bordered");
    EXPECT_EQ(dynamics.stats.rank_deficiency, 0);
    std::vector<double> b = residual(0, w, state_.q), c(state_.m);
    for (std::size_t k = 0; k < c.size(); ++k) {
      c[k] = (system_->rows().turns(int(k)) ? 0.1 : 1e-3) * state_.uniform();
    }
    std::vector<double> x = b, y = c;
    for (double& entry : c) entry *= w.pos == 0 ? 1 : w.pos;  // as index 3 divides it
    ASSERT_EQ(dynamics.solve(b, c), Status::ok);
    ASSERT_EQ(kkt.solve(x, y), Status::ok);
    std::vector<double> sizes(y.size());
    for (std::size_t k = 0; k < y.size(); ++k) {
      sizes[k] = system_->rows().turns(int(k)) ? system_->rows().length() : 1;
    }
    std::printf("%s: x %.1e, y %.1e apart\n", GetParam().name,
                relative_difference(b, x, state_.a_typ),
                relative_difference(c, y, sizes));
    EXPECT_LE(relative_difference(b, x, state_.a_typ), 1e-7);
    EXPECT_LE(relative_difference(c, y, sizes), 1e-7);
  }
}

/// The forces at a frame take the mass matrix. A matrix that a method keeps is there
/// again afterwards, to the same bits. Both ends of a joint have opposite forces, which
/// the residual with the multipliers of the forces must balance.
TEST_P(JoinedStrands, KeepTheMatrixOfAMethodWhenTheirForcesAreRead) {
  ASSERT_EQ(system_->linearize_bordered(t, state_.q, state_.v, state_.a, lambda_,
                                        {1, 1e-3, 1e-6}),
            Status::ok);
  const std::vector<double> b = residual(0, {}, state_.q);
  std::vector<double> before(b.size()), after = before, forces(3 * system_->joints()),
                                        moments = forces;
  ASSERT_EQ(system_->solve(b, before), Status::ok);
  ASSERT_EQ(system_->joint_forces(0, state_.q, state_.v, forces, moments), Status::ok);
  EXPECT_GT(norm(load3(forces.data())), 0);
  ASSERT_EQ(system_->solve(b, after), Status::ok);
  EXPECT_EQ(after, before);
}

INSTANTIATE_TEST_SUITE_P(
    Models, JoinedStrands,
    testing::Values(Case{"helix_ball", "super_helix", JointKind::ball},
                    Case{"helix_weld", "super_helix", JointKind::weld},
                    Case{"helix_hinge", "super_helix", JointKind::hinge},
                    Case{"helix_spring", "super_helix", JointKind::spring},
                    Case{"helix_loop", "super_helix", JointKind::hinge, true},
                    Case{"clothoid_weld", "super_clothoid", JointKind::weld},
                    Case{"clothoid_hinge", "super_clothoid", JointKind::hinge, true},
                    Case{"der_ball", "der", JointKind::ball},
                    Case{"der_weld", "der", JointKind::weld},
                    Case{"der_hinge", "der", JointKind::hinge, true},
                    Case{"der_spring", "der", JointKind::spring}),
    [](const auto& test) { return std::string(test.param.name); });

constexpr auto turns = Case::Body::turns, moves = Case::Body::free;

INSTANTIATE_TEST_SUITE_P(
    Bodies, JoinedStrands,
    testing::Values(
        Case{"helix_ball_turns", "super_helix", JointKind::ball, false, turns},
        Case{"helix_ball_free", "super_helix", JointKind::ball, false, moves},
        Case{"helix_weld_turns", "super_helix", JointKind::weld, false, turns},
        Case{"helix_weld_free", "super_helix", JointKind::weld, false, moves},
        Case{"helix_hinge_free", "super_helix", JointKind::hinge, false, moves},
        Case{"clothoid_weld_free", "super_clothoid", JointKind::weld, false, moves},
        Case{"clothoid_hinge_turns", "super_clothoid", JointKind::hinge, false, turns},
        Case{"chain_ball_free", "articulated_chain", JointKind::ball, false, moves},
        Case{"chain_weld_free", "articulated_chain", JointKind::weld, false, moves},
        Case{"der_ball_free", "der", JointKind::ball, false, moves},
        Case{"der_weld_turns", "der", JointKind::weld, false, turns},
        Case{"der_weld_free", "der", JointKind::weld, false, moves},
        Case{"der_hinge_free", "der", JointKind::hinge, false, moves},
        Case{"springs_ball_free", "mass_spring", JointKind::ball, false, moves},
        Case{"corde_weld_free", "corde", JointKind::weld, false, moves}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace tress::test_joined_system
