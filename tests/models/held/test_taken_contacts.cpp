// The laws of rigid contact linear about a state: on a strand that leans on a tilted
// plane and a sphere, by every model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "contract/forms/contact_form.h"
#include "contract/system.h"
#include "models/catalogue.h"
#include "models/contact/cone.h"
#include "models/effects/exact_body.h"
#include "models/strand/strand.h"
#include "tests/support/apart.h"

namespace tress::models {
namespace {

constexpr double radius = 40e-6, length = 0.05, tau = 0.01, friction = 0.4;

class TakenContactsOn : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const Strand strand = make_strand(
        {}, {radius, radius}, {.elements = 5, .length = length}, uniform_shape({}));
    // Both come upon the strand in the step.
    const auto coming = [](const Vec& along) {
      RootMotion motion;
      motion.translations = {{along, smooth_step(3e-3, 0, tau)}};
      return motion;
    };
    const StrandPlace tilted{{0.7 * length, 0, -3e-3}, rotation({0, 1, 0}, 0.05)};
    const StrandPlace beside{{0.4 * length, 0.0225, 0}, {}};
    const ExactContact law{{.offset = radius}, true, friction};
    const ModelEntry& model = find_model(GetParam());
    system_ = model.on_strand(
        strand, Parameters(model.parameters, "test"),
        {std::make_shared<ExactBody>(Plane{}, tilted, law, coming({0, 0, 1})),
         std::make_shared<ExactBody>(Sphere{0.02}, beside, law, coming({0, -1, 0}))});
    const auto n = static_cast<std::size_t>(system_->layout().coordinates);
    q_.resize(n);
    v_.resize(n);
    a_.assign(n, 0.0);
    std::vector<double> q_typ(n), v_typ(n);
    system_->initial_state(q_, v_);
    system_->scale(q_typ, v_typ);
    const std::vector<double> change = random(v_typ);
    for (std::size_t i = 0; i < n; ++i) v_[i] += 0.01 * change[i];
    changed_ = random(v_typ);
    form_ = system_->contact_form();
    std::vector<double> start(form_->tracked());
    form_->places(0, q_, v_, start);
    form_->begin(tau, tau, q_, v_, start);
    laws_ = form_->complementarity();
    ASSERT_NE(laws_, nullptr);
    count_ = 3 * laws_->take(tau, q_, v_, q_, v_);
    ASSERT_GE(count_, 6);
  }

  std::vector<double> random(const std::vector<double>& size) {
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<double> x = size;
    for (double& entry : x) entry *= any(engine_);
    return x;
  }
  std::vector<double> random(double size) {
    return random(std::vector<double>(count_, size));
  }
  /// That do not pull.
  std::vector<double> forces(double size) {
    std::vector<double> f = random(size);
    for (std::size_t k = 0; k < count_; k += 3) f[k] = std::abs(f[k]);
    return f;
  }
  std::vector<double> residual(In forces) {
    laws_->set_forces(forces);
    std::vector<double> r(q_.size());
    EXPECT_EQ(system_->residual(tau, q_, v_, a_, r), Status::ok);
    return r;
  }
  std::vector<double> responses(In dv) {
    std::vector<double> du(count_);
    laws_->responses(dv, du);
    return du;
  }
  /// By unit forces, as a stage of backward Euler finds them; by columns.
  std::vector<double> compliance() {
    std::vector<double> w(count_ * count_), force(count_);
    EXPECT_EQ(system_->linearize(tau, q_, v_, a_, {1, tau, tau * tau}), Status::ok);
    const std::vector<double> free = residual(force);
    for (std::size_t k = 0; k < count_; ++k) {
      force[k] = 1;
      std::vector<double> r = residual(force);
      force[k] = 0;
      for (std::size_t i = 0; i < r.size(); ++i) r[i] = tau * (free[i] - r[i]);
      EXPECT_EQ(system_->solve(r, r), Status::ok);
      laws_->responses(r, Out(w).subspan(count_ * k, count_));
    }
    return w;
  }

  std::mt19937 engine_{7};
  std::unique_ptr<System> system_;
  ContactForm* form_ = nullptr;
  Complementarity* laws_ = nullptr;
  std::size_t count_ = 0;  // of velocities
  std::vector<double> q_, v_, a_, changed_;
};

TEST_P(TakenContactsOn, ForcesWorkAsTheirPointsMove) {
  // Its equations are those of accelerations, not of forces.
  if (GetParam() == "kirchhoff_nodal") GTEST_SKIP();
  const std::vector<double> force = forces(1e-4);
  const std::vector<double> none = residual(std::vector<double>(count_));
  const std::vector<double> some = residual(force), du = responses(changed_);
  double power = 0, size = 0, of_points = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    power += (none[i] - some[i]) * changed_[i];
    size += (std::abs(none[i]) + std::abs(some[i])) * std::abs(changed_[i]);
  }
  for (std::size_t k = 0; k < count_; ++k) of_points += force[k] * du[k];
  ASSERT_GT(std::abs(of_points), 1e-7);
  // What sums of a few hundred terms of this size lose to rounding.
  EXPECT_NEAR(power, of_points, 1e-13 * size);
}

// A change dv of velocities comes with tau dv of places, which the laws are about. On the
// sphere the normal turns with them by tau du/radius, and with it what the step closes of
// the gap, at less than `closing`; on the plane nothing turns.
TEST_P(TakenContactsOn, RespondAsTheyMove) {
  constexpr double part = 1e-4, closing = 3e-3 / tau, radius_of_sphere = 0.02;
  const auto moved = [&](double by) {
    std::vector<double> q = q_, u(count_);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += by * tau * changed_[i];
    laws_->velocities(tau, q, v_, u);
    return u;
  };
  const std::vector<double> before = moved(-part), after = moved(part);
  const std::vector<double> du = responses(changed_);
  double largest = 0;
  for (const double one : du) largest = std::max(largest, std::abs(one));
  EXPECT_GT(largest, 1e-3);
  const double turns = tau / radius_of_sphere * closing * largest;
  const double exact = 1e-6 * largest;  // differences: rounding of 1e-17 m / tau / part
  std::size_t as_told = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const double change = (after[k] - before[k]) / (2 * part);
    EXPECT_NEAR(change, du[k], turns) << k;
    if (std::abs(change - du[k]) <= exact) ++as_told;
  }
  EXPECT_GE(as_told, 6u);  // of two or more points on the plane
}

TEST_P(TakenContactsOn, ForcesThatAreFoundObeyTheLaws) {
  const std::vector<double> w = compliance();
  // Some are pushed in, some slide away: at speeds as of a hair that falls.
  const std::vector<double> u = random(0.3), given = forces(1e-5);
  constexpr double tolerance = 1e-9;  // m/s
  std::vector<double> force = given;
  EXPECT_LE(laws_->balance(w, u, tolerance, force), tolerance);
  int closed = 0, open = 0;
  for (std::size_t i = 0; i < count_; i += 3) {
    Vec now = load3(&u[i]);
    for (std::size_t k = 0; k < count_; ++k) {
      now = now + (force[k] - given[k]) * load3(&w[count_ * k + i]);
    }
    Mat3 own{};
    for (int k = 0; k < 3; ++k) {
      const Vec axis{k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
      own = own + outer(load3(&w[count_ * (i + static_cast<std::size_t>(k)) + i]), axis);
    }
    const Vec f = load3(&force[i]);
    ++(f.x > 0 ? closed : open);
    EXPECT_LE(contact_violation(own, now, f, friction), 2 * tolerance) << i;
  }
  EXPECT_GT(closed, 0);
  EXPECT_GT(open, 0);
}

TEST_P(TakenContactsOn, MultipliersAreThoseOfBeforeUnlessForcesWereFound) {
  const std::vector<double> before = form_->multipliers();
  std::vector<double> force(count_, 0.0);
  for (std::size_t k = 0; k < count_; k += 3) force[k] = 1e-5;
  const std::vector<double> r = residual(force);
  laws_->let_go(false);
  EXPECT_EQ(form_->multipliers(), before);
  laws_->take(tau, q_, v_, q_, v_);
  EXPECT_EQ(residual(force), r);
  laws_->let_go(true);
  EXPECT_NE(form_->multipliers(), before);
  laws_->take(tau, q_, v_, q_, v_);
  std::vector<double> held(count_);
  laws_->forces(held);
  EXPECT_LE(apart(held, force), 1e-19);  // N: turned there and back
}

INSTANTIATE_TEST_SUITE_P(Models, TakenContactsOn,
                         testing::Values("super_helix", "super_clothoid",
                                         "articulated_chain", "force_transport", "der",
                                         "corde", "xpbd_cosserat", "dynamic_spline",
                                         "kirchhoff_nodal", "mass_spring",
                                         "inextensible_strand", "lifted_curls"),
                         [](const auto& of) { return of.param; });

TEST(Complementarity, IsOfRigidContactsOnly) {
  const Strand strand = make_strand({}, {radius, radius},
                                    {.elements = 5, .length = length}, uniform_shape({}));
  const ModelEntry& model = find_model("der");
  const auto with = [&](bool rigid) {
    const ExactContact law{{.stiffness = 1e3, .offset = radius}, rigid, friction};
    return model.on_strand(strand, Parameters(model.parameters, "test"),
                           {std::make_shared<ExactBody>(Plane{}, StrandPlace{}, law)});
  };
  EXPECT_EQ(with(false)->contact_form()->complementarity(), nullptr);
  EXPECT_NE(with(true)->contact_form()->complementarity(), nullptr);
}

}  // namespace
}  // namespace tress::models
