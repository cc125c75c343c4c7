// Exact friction: the law of a point, and a free strand on a tilted plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "contract/forms/contact_form.h"
#include "contract/forms/material_points.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/body.h"
#include "models/effects/exact_body.h"
#include "models/effects/gravity.h"
#include "models/strand/strand.h"

namespace tress::models {
namespace {

// ---- the law of a point ------------------------------------------------------------

struct LawCase {
  const char* name;
  bool rigid;
  bool slips;
  bool rebounds;
};
void PrintTo(const LawCase& law, std::ostream* out) { *out << law.name; }

class ExactLaw : public testing::TestWithParam<LawCase> {
 protected:
  static constexpr double friction = 0.4;
  ExactContact law() const {
    return {{.stiffness = 50, .damping = 2, .offset = 1e-3}, GetParam().rigid, friction};
  }
  /// Deep enough for either normal force; pulled within the cone, or well out of it.
  HeldContact held() const {
    const double pull = GetParam().slips ? 4e-4 : 1e-5;
    return {1.5e-4, {pull, -pull, pull / 2}, -1e-5, 0, 0, {}};
  }
  ExactContact::Penalty penalty() const {
    ExactContact::Penalty own{.length = 2e-3,
                              .rho = 1e-4,
                              .tau = 0.01,
                              .rebound = {},
                              .from = x_ - 0.01 * along_};
    if (GetParam().rebounds) own.rebound = 0.3;
    return own;
  }
  ExactContact::State at(const Vec& x, const Vec& u) const {
    return {law_, held_, penalty_, sphere_.distance(x), x, u};
  }

  const Sphere sphere_{0.02};
  const Vec x_ = (0.0205 / std::sqrt(3.0)) * Vec{1, 1, 1};
  const Vec u_{0.02, -0.05, 0.01}, along_{0.03, -0.06, 0.02};
  const ExactContact law_ = law();
  const HeldContact held_ = held();
  const ExactContact::Penalty penalty_ = penalty();
};

TEST_P(ExactLaw, SlopesAreThoseOfTheLoad) {
  const ExactContact::State state = at(x_, u_);
  ASSERT_EQ(state.slips(), GetParam().slips);
  ASSERT_GT(state.normal(), 0);
  const ContactSlopes slopes = state.slopes(sphere_.curvature(x_));
  const Vec axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double largest = 0;
  for (const Vec& axis : axes) {
    constexpr double dx = 1e-7, du = 1e-5;  // errors of order d^2 and eps/d: 1e-8 each
    const Vec by_x =
        (0.5 / dx) * (at(x_ + dx * axis, u_).load() - at(x_ - dx * axis, u_).load());
    const Vec by_u =
        (0.5 / du) * (at(x_, u_ + du * axis).load() - at(x_, u_ - du * axis).load());
    const double of_x = std::max(1e-6, norm(by_x)), of_u = std::max(1e-8, norm(by_u));
    EXPECT_LE(norm(slopes.by_x * axis - by_x), 1e-5 * of_x);
    EXPECT_LE(norm(slopes.by_u * axis - by_u), 1e-5 * of_u);
    largest = std::max({largest, norm(by_x), norm(by_u)});
  }
  EXPECT_GT(largest, 1e-5);  // N s/m: the comparison is not one of zeros
}

TEST_P(ExactLaw, ForceIsInTheConeAndAgainstTheSlide) {
  const ExactContact::State state = at(x_, u_);
  EXPECT_LE(norm(state.tangential()), friction * state.normal() * (1 + 1e-12));
  EXPECT_NEAR(dot(state.tangential(), x_), 0, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ExactLaw,
                         testing::Values(LawCase{"compliant_sticks", false, false, false},
                                         LawCase{"compliant_slips", false, true, false},
                                         LawCase{"rigid_sticks", true, false, false},
                                         LawCase{"rigid_slips", true, true, false},
                                         LawCase{"rebounds", true, false, true}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(ExactContactLaw, ViolationVanishesWhereTheMultipliersAreTheForce) {
  const ExactContact law{{.offset = 0}, true, 0.5};
  const Plane plane;
  const ExactContact::Penalty penalty{
      .length = 1, .rho = 1, .tau = 1, .rebound = {}, .from = {}};
  // Sticks: no motion. Slides: |T| = mu N against the motion. Open: no force.
  HeldContact sticks, slides, open;
  sticks.normal = slides.normal = 1;
  sticks.tangential = {0.3, 0, 0};
  slides.tangential = {0.5, 0, 0};
  const auto violation = [&](const HeldContact& held, double gap, const Vec& u) {
    return ExactContact::State(law, held, penalty, plane.distance({0, 0, gap}), u, u)
        .violation();
  };
  EXPECT_EQ(violation(sticks, 0, {}), 0);
  EXPECT_NEAR(violation(slides, 0, {-2, 0, 0}), 0, 1e-15);
  EXPECT_EQ(violation(open, 0.1, {3, 4, 5}), 0);
  EXPECT_NEAR(violation(sticks, 0, {0.1, 0, 0}), 0.1, 1e-15);
  EXPECT_NEAR(violation(sticks, 0.2, {}), 0.2, 1e-15);
  EXPECT_NEAR(violation(slides, 0, {0, 0.2, 0}), 0.2, 0.05);  // across its force
}

// ---- a strand on a tilted plane ------------------------------------------------------

constexpr double radius = 40e-6, mu = 0.3, g = 9.81;

struct OnPlane {
  std::string model;
  bool rigid;
};
void PrintTo(const OnPlane& of, std::ostream* out) {
  *out << of.model << (of.rigid ? "_rigid" : "_compliant");
}

/// How a run ended: its points, and where they were at the start and at half of the time.
struct Course {
  std::vector<double> start, half, end, velocity;
  Stats stats;

  static double farthest(const std::vector<double>& x, const std::vector<double>& y) {
    double most = 0;
    for (std::size_t i = 0; i < x.size(); i += 3) {
      most = std::max(most, std::abs(x[i] - y[i]));
    }
    return most;
  }
  double moved() const { return farthest(end, start); }  // m, along the slope
};

Course run(System& system, Options options, double t_end,
           const std::string& integrator = "backward_euler") {
  if (system.layout().constraints > 0) {
    options.formulation =
        options.tolerance > 0 ? Formulation::projection : Formulation::index3;
  }
  const auto method = integrators::make_integrator(integrator, system, options);
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  std::vector<double> q(n), v(n);
  system.initial_state(q, v);
  MaterialPoints& points = *system.material_points();
  Course of;
  of.start.resize(3 * static_cast<std::size_t>(points.count()));
  of.half = of.end = of.velocity = of.start;
  points.positions(0, q, of.start);
  EXPECT_EQ(method->start(0, q, v), Status::ok) << method->failure();
  EXPECT_EQ(method->advance(t_end / 2), Status::ok) << method->failure();
  points.positions(t_end / 2, method->q(), of.half);
  EXPECT_EQ(method->advance(t_end), Status::ok) << method->failure();
  points.positions(t_end, method->q(), of.end);
  points.velocities(t_end, method->q(), method->v(), of.velocity);
  of.stats = method->stats();
  return of;
}
Course run(System& system, double step, double t_end) {
  Options options;
  options.step = step;
  return run(system, options, t_end);
}

ExactContact law(bool rigid, double restitution = 0) {
  return {{.stiffness = 1e3, .damping = 1, .offset = radius}, rigid, mu, restitution};
}

/// A straight strand along x on, or above, the plane z = 0.
std::unique_ptr<System> strand_on_plane(const std::string& id, const Vec& gravity,
                                        const FreeRoot& root,
                                        std::shared_ptr<const Effect> plane) {
  Strand strand = make_strand({}, {radius, radius}, {.elements = 5, .length = 0.05},
                              uniform_shape({}));
  strand.free_root = root;
  const ModelEntry& model = find_model(id);
  Parameters options(model.parameters, "test");
  if (id == "super_clothoid") options.set("quadrature", "4");  // as helices have
  return model.on_strand(strand, options,
                         {std::make_shared<Gravity>(gravity), std::move(plane)});
}

std::unique_ptr<System> thrown(const std::string& id, const Vec& velocity,
                               double restitution) {
  return strand_on_plane(
      id, {}, {{0, 0, 1.5e-3 + radius}, {}, velocity, {}},
      std::make_shared<ExactBody>(Plane{}, StrandPlace{}, law(true, restitution)));
}

class TiltedPlane : public testing::TestWithParam<OnPlane> {
 protected:
  /// Gravity as on a slope whose angle has this tangent.
  std::unique_ptr<System> lying(double tangent) const {
    const double angle = std::atan(tangent);
    return strand_on_plane(
        GetParam().model, {g * std::sin(angle), 0, -g * std::cos(angle)},
        {{0, 0, radius}, {}, {}, {}},
        std::make_shared<ExactBody>(Plane{}, StrandPlace{}, law(GetParam().rigid)));
  }
};

TEST_P(TiltedPlane, WhatSticksDoesNotMove) {
  for (const double step : {1.0 / 30, 1.0 / 300}) {
    const Course of = run(*lying(0.29), step, 0.5);
    EXPECT_LT(of.moved(), 1e-9) << step;
    EXPECT_LT(Course::farthest(of.end, of.half), 1e-15) << step;  // it has come to rest
    EXPECT_EQ(of.stats.contact_unfinished, 0) << step;
    // Where nothing changes one solution is enough.
    EXPECT_LE(of.stats.contact_iterations, of.stats.steps + 5) << step;
  }
}

TEST_P(TiltedPlane, SticksOrSlidesByTheFifthDigitOfFriction) {
  constexpr double step = 1.0 / 300, t_end = 0.5;
  const Course sticks = run(*lying(mu - 1e-5), step, t_end);
  EXPECT_LT(Course::farthest(sticks.end, sticks.half), 1e-9);  // it has sunk in
  // a t^2/2 with a = g 1e-5 cos^3, less what the settling of the first steps takes.
  EXPECT_GT(run(*lying(mu + 1e-5), step, t_end).moved(),
            0.5 * g * 1e-5 * t_end * t_end / 2);
}

TEST_P(TiltedPlane, SlidesAsBackwardEulerDoesByHand) {
  constexpr double tangent = 0.5, step = 1.0 / 300;
  constexpr int steps = 60;
  const Course of = run(*lying(tangent), step, steps * step);
  const double angle = std::atan(tangent);
  const double a = g * (std::sin(angle) - mu * std::cos(angle));
  const double by_hand = a * step * step * steps * (steps + 1) / 2;
  EXPECT_NEAR(of.moved(), by_hand, 1e-6 * by_hand);
}

TEST_P(TiltedPlane, RegularisedFrictionCreeps) {
  const double angle = std::atan(0.29);
  const BodyContact regularised{
      .stiffness = 1e3, .damping = 0, .friction = mu, .slip = 1e-3, .offset = radius};
  const auto system =
      strand_on_plane(GetParam().model, {g * std::sin(angle), 0, -g * std::cos(angle)},
                      {{0, 0, radius}, {}, {}, {}},
                      std::make_shared<Body>(Plane{}, StrandPlace{}, regularised));
  // At the speed u at which (2 - u/v) u/v = 0.29/0.3.
  const double speed = 1e-3 * (1 - std::sqrt(1 - 0.29 / 0.3));
  EXPECT_NEAR(run(*system, 1.0 / 30, 0.5).moved(), 0.5 * speed, 0.1 * 0.5 * speed);
}

TEST_P(TiltedPlane, SticksByTolerance) {
  for (const std::string integrator : {"tr_bdf2", "esdirk43"}) {
    // The frame of a chain's free root has no acceleration to start a stage from.
    if (GetParam().model == "articulated_chain") GTEST_SKIP() << "no mass at its root";
    Options options;
    options.tolerance = 1e-3;
    options.max_step = 1.0 / 30;
    const Course of = run(*lying(0.29), options, 0.5, integrator);
    // It moves while a method starts from a force that is not yet known; and on a
    // compliant surface, which swings at 12 kHz, whenever that lifts it.
    EXPECT_LT(of.moved(), 2e-3 * 0.05) << integrator;
    // A strand with more contacts than unknowns, whose forces are not unique, does not
    // come to rest by tr_bdf2 on a rigid surface: its contacts open and close.
    const bool chatters =
        integrator == "tr_bdf2" && GetParam().model.starts_with("super_");
    if (!GetParam().rigid || chatters) continue;
    EXPECT_LT(Course::farthest(of.end, of.half), 1e-9) << integrator;
  }
}

TEST_P(TiltedPlane, GoesOnBitwiseFromItsMemory) {
  const auto first = lying(0.5), second = lying(0.5);
  Options options;
  options.step = 1.0 / 300;
  if (first->layout().constraints > 0) options.formulation = Formulation::index3;
  const auto ahead = integrators::make_integrator("backward_euler", *first, options);
  const auto after = integrators::make_integrator("backward_euler", *second, options);
  const auto n = static_cast<std::size_t>(first->layout().coordinates);
  std::vector<double> q(n), v(n);
  first->initial_state(q, v);
  ASSERT_EQ(ahead->start(0, q, v), Status::ok);
  ASSERT_EQ(ahead->advance(0.05), Status::ok);
  q.assign(ahead->q().begin(), ahead->q().end());
  v.assign(ahead->v().begin(), ahead->v().end());
  const std::vector<double> memory = first->memory();
  EXPECT_TRUE(std::ranges::any_of(memory, [](double x) { return x != 0; }));
  // Both from the same state, without guesses from the steps before.
  second->recall(memory);
  ASSERT_EQ(second->memory(), memory);
  ASSERT_EQ(ahead->start(0.05, q, v), Status::ok);
  ASSERT_EQ(after->start(0.05, q, v), Status::ok);
  ASSERT_EQ(ahead->advance(0.1), Status::ok);
  ASSERT_EQ(after->advance(0.1), Status::ok);
  EXPECT_TRUE(std::ranges::equal(ahead->q(), after->q()));
  EXPECT_EQ(first->memory(), second->memory());
  first->reset();
  EXPECT_TRUE(std::ranges::all_of(first->contact_form()->multipliers(),
                                  [](double x) { return x == 0; }));
}

// ---- impacts -------------------------------------------------------------------------

class FlatImpact : public testing::TestWithParam<std::string> {};

// All points hit at once: v_t' = max(0, v_t - mu (1 + e) v_n), v_n' = -e v_n.
TEST_P(FlatImpact, VelocitiesAreThoseOfTheImpulse) {
  for (const double restitution : {0.0, 0.5}) {
    for (const double along : {0.05, 1.0}) {
      const auto system = thrown(GetParam(), {along, 0, -0.4}, restitution);
      const Course of = run(*system, 1e-3, 0.02);
      const double left = std::max(0.0, along - mu * (1 + restitution) * 0.4);
      for (std::size_t i = 0; i < of.velocity.size(); i += 3) {
        EXPECT_NEAR(of.velocity[i], left, 1e-6) << restitution << ' ' << along;
        EXPECT_NEAR(of.velocity[i + 2], restitution * 0.4, 1e-6) << restitution;
      }
    }
  }
}

TEST_P(FlatImpact, IsNotAnErrorThatShorterStepsWouldRemove) {
  for (const std::string integrator : {"tr_bdf2", "esdirk43"}) {
    const auto system = thrown(GetParam(), {1, 0, -0.4}, 0);
    Options options;
    options.tolerance = 1e-4;
    const Course of = run(*system, options, 0.02, integrator);
    EXPECT_LT(of.stats.steps, 200);
    for (std::size_t i = 0; i < of.velocity.size(); i += 3) {
      EXPECT_NEAR(of.velocity[i], 1 - mu * 0.4, 1e-3) << integrator;
      EXPECT_NEAR(of.velocity[i + 2], 0, 1e-3) << integrator;
      EXPECT_NEAR(of.end[i + 2], radius, 2 * 1e-4 * 0.05) << integrator;
    }
  }
}

// Points on rigid joints or with constraints share their impulses.
INSTANTIATE_TEST_SUITE_P(Models, FlatImpact,
                         testing::Values("super_helix", "der", "corde", "mass_spring",
                                         "dynamic_spline"),
                         [](const auto& of) { return of.param; });

// ---- what is refused -----------------------------------------------------------------

TEST(ExactContactRefusals, NameTheMethodsThatDo) {
  const auto system = thrown("der", {}, 0), rebounding = thrown("der", {}, 0.5);
  const auto message = [](const std::string& integrator, System& of) -> std::string {
    try {
      (void)integrators::make_integrator(integrator, of, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message("implicit_midpoint", *system).find("use backward_euler, bdf2"),
            std::string::npos);
  EXPECT_NE(message("velocity_verlet", *system).find("exact friction"),
            std::string::npos);
  EXPECT_EQ(message("bdf2", *system), "");
  EXPECT_NE(message("bdf2", *rebounding).find("restitution"), std::string::npos);
  EXPECT_EQ(message("backward_euler", *rebounding), "");
}

TEST(ExactContactRefusals, SettingsThatContradictEachOther) {
  const auto make = [](const std::vector<std::pair<std::string, std::string>>& settings) {
    Parameters parameters(body_parameters(), "effect body");
    for (const auto& [key, value] : settings) parameters.set(key, value);
    return make_body(parameters, {});
  };
  EXPECT_THROW((void)make({{"normal", "rigid"}}), InputError);
  EXPECT_THROW((void)make({{"restitution", "0.5"}}), InputError);
  EXPECT_THROW((void)make({{"friction_law", "exact"}, {"restitution", "0.5"}}),
               InputError);
  EXPECT_NO_THROW((void)make(
      {{"friction_law", "exact"}, {"normal", "rigid"}, {"restitution", "0.5"}}));
}

std::vector<OnPlane> on_plane() {
  std::vector<OnPlane> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (!model.on_strand || model.roots != Roots::clamped_or_free) continue;
    for (const bool rigid : {false, true}) all.push_back({std::string(model.id), rigid});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Models, TiltedPlane, testing::ValuesIn(on_plane()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace tress::models
