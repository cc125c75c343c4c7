// A free body that no strand touches: Euler's equations.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "contract/forms/energetics.h"
#include "models/driven/driven_system.h"
#include "models/effects/gravity.h"
#include "models/strand/rod_joint.h"
#include "models/strand/strand_parameters.h"
#include "simulation/scene/joined_start.h"
#include "tests/support/catalogue_cases.h"
#include "tests/support/drive.h"

namespace tress::test_free_top {

using namespace models;
using testing_support::Drive;

const FreeBody top{.mass = 1,
                   .inertia = {1e-3, 2e-3, 2.5e-3},
                   .velocity = {0.1, 0, 0},
                   .spin = {0.05, 3, 0.1}};

/// A hair that is far from an asymmetric top, which begins to turn about the axis of its
/// middle moment of inertia and tumbles.
struct Tumbling {
  Effects effects;
  std::unique_ptr<System> system;
  explicit Tumbling(const FreeBody& body = top,
                    std::shared_ptr<const Effect> weight = nullptr) {
    const ModelEntry& model = find_model("super_helix");
    Parameters parameters(setup_parameters(model), "top");
    parameters.set("elements", "1");
    const BodyContact law{.stiffness = 1, .damping = 0, .friction = 0};
    effects.push_back(std::make_shared<DrivenBody>(
        Body(Sphere{0.01}, {{10, 0, 0}, rotation({1, 0, 0}, 0.4)}, law), body));
    if (weight != nullptr) effects.push_back(std::move(weight));
    Parameters options(model.parameters, "test");
    system = with_driven_bodies(
        model.on_strand(models::strand(parameters), options, effects), effects);
  }
  DrivenBodies::Motion motion(In q, In v) const {
    return driven_bodies(*system)->motion(q, v, 0);
  }
};

/// Angular momentum in the world and kinetic energy, from the motion alone.
struct Invariants {
  Vec momentum;
  double energy;
};
Invariants invariants(const DrivenBodies::Motion& now) {
  const Frame frame = now.turn * rotation({1, 0, 0}, 0.4);
  const Vec omega = frame.back(now.omega);
  const Vec& i = top.inertia;
  const Vec l{i.x * omega.x, i.y * omega.y, i.z * omega.z};
  return {frame * l, dot(l, omega) / 2};
}

DrivenBodies::Motion at(double t, std::string_view method, double step,
                        double tolerance = 0) {
  const Tumbling one;
  Options options;
  options.step = step;
  if (tolerance > 0) options.rtol = options.atol = tolerance;
  Drive drive(method, *one.system, options);
  EXPECT_EQ(drive.to(t), Status::ok) << method << drive.integrator->failure();
  return one.motion(drive.integrator->q(), drive.integrator->v());
}

double apart(const DrivenBodies::Motion& a, const DrivenBodies::Motion& b) {
  return std::max({norm(a.turn.e0 - b.turn.e0), norm(a.turn.e1 - b.turn.e1),
                   norm(a.turn.e2 - b.turn.e2)});
}

/// The top turns by 12 rad in 4 s, so its reference moves eight times. RADAU IIA of order
/// 5 with 1 ms errs by (omega h)^5 = 2e-13 a step and 1e-11 in all.
TEST(ATop, KeepsItsEnergyAndAngularMomentum) {
  const Invariants begin = invariants(at(0, "radau5", 1e-3));
  const Invariants end = invariants(at(4, "radau5", 1e-3));
  std::printf("momentum %.1e, energy %.1e apart\n",
              norm(end.momentum - begin.momentum) / norm(begin.momentum),
              end.energy / begin.energy - 1);
  EXPECT_LE(norm(end.momentum - begin.momentum), 1e-9 * norm(begin.momentum));
  EXPECT_NEAR(end.energy, begin.energy, 1e-9 * begin.energy);
}

/// Half the step, error by 2^order: every method of fixed step keeps its order on a
/// rotation of less than 1.5 rad. Bar: a third of an order, as higher terms remain.
TEST(ATop, TumblesWithTheOrderOfEveryMethod) {
  const DrivenBodies::Motion exact = at(0.4, "radau5", 2e-4);
  std::size_t driven = 0;
  for (const auto& method : integrators::integrator_catalogue()) {
    const Tumbling one;
    if (!method.order(Formulation::parametric)) continue;
    const std::string why =
        integrators::refusal(method, *one.system, Formulation::parametric);
    if (!why.empty()) {
      std::printf("%s: %s\n", std::string(method.id).c_str(), why.c_str());
      continue;
    }
    ++driven;
    if (method.adaptive) {
      EXPECT_LE(apart(at(0.4, method.id, 0, 1e-8), exact), 1e-5) << method.id;
      continue;
    }
    const double coarse = apart(at(0.4, method.id, 4e-3), exact),
                 fine = apart(at(0.4, method.id, 2e-3), exact);
    const double order = std::log2(coarse / fine);
    std::printf("%s: %.1e, %.1e, order %.2f of %d\n", std::string(method.id).c_str(),
                coarse, fine, order, *method.order(Formulation::parametric));
    EXPECT_TRUE(fine < 1e-10 || order > *method.order(Formulation::parametric) - 1.0 / 3)
        << method.id;
  }
  EXPECT_GE(driven, 15U);
}

/// The places that a method of order 2 or more finds are exact.
TEST(ABody, FallsFreely) {
  Tumbling one(top, std::make_shared<Gravity>(Vec{0, 0, -9.81}));
  Options options;
  options.step = 1e-3;
  Drive drive("implicit_midpoint", *one.system, options);
  ASSERT_EQ(drive.to(0.5), Status::ok) << drive.integrator->failure();
  const Vec x = one.motion(drive.integrator->q(), drive.integrator->v()).x;
  EXPECT_NEAR(x.z, -9.81 / 8, 1e-8);
  EXPECT_NEAR(x.x, 10.05, 1e-8);
}

/// A strand without weight that is welded to a body: forces of the joint cancel.
/// Momentum is linear in the velocities of nodes and body, so methods keep it to the
/// tolerance of Newton's iterations, 1e-9 of the typical velocities. Angular momentum is
/// kept to first order at least, as multipliers are.
TEST(AStrandOnABody, KeepsItsMomentum) {
  const ModelEntry& model = find_model("der");
  Parameters parameters(setup_parameters(model), "welded");
  Strand strand = models::strand(parameters);
  FreeRoot& root = strand.free_root.emplace();
  root.position = strand.root.position;
  root.frame = strand.root.frame;
  const BodyContact law{.stiffness = 1, .damping = 0, .friction = 0};
  const FreeBody body{.mass = 1e-6,
                      .inertia = {1e-11, 1.5e-11, 2e-11},
                      .velocity = {0.01, 0.02, 0},
                      .spin = {0, 3, 1}};
  const DrivenBody effect(Body(Sphere{1e-3}, {root.position + Vec{0, 0, 2e-3}, {}}, law),
                          body);
  Parameters options(model.parameters, "test");
  std::vector<std::unique_ptr<SupportedSystem>> members;
  members.push_back(as_supported(model.on_strand(strand, options, {})));
  auto own = make_body_system(effect, {}, typical_motion(*members.front()));
  constexpr double rigid = std::numeric_limits<double>::infinity();
  Joint joint{.kind = JointKind::weld};
  joint.a = {1, own->add_point(root.position)};
  joint.b = {0, 0};
  joint.half_a = {{}, {rigid, rigid, rigid}, {rigid, rigid, rigid}};
  joint.half_b = rod_joint(strand, nullptr, strand.segments.front(), {});
  members.push_back(as_supported(std::move(own)));
  JoinedSystem system(std::move(members), {joint}, {"joint"}, 1);
  simulation::begin_on_joints(system, {"joint"});
  const auto change = [&](double step) {
    static_cast<System&>(system).reset();
    Options of;
    of.step = step;
    of.formulation = Formulation::index3;
    Drive drive("implicit_midpoint", system, of);
    const auto momentum = [&](In q, In v) {
      return *static_cast<System&>(system).energetics()->momentum(0, q, v);
    };
    const Momentum before = momentum(drive.q0, drive.v0);
    EXPECT_EQ(drive.to(0.1), Status::ok) << drive.integrator->failure();
    const Momentum after = momentum(drive.integrator->q(), drive.integrator->v());
    const auto off = [](const auto& a, const auto& b) {
      return norm(load3(a.data()) - load3(b.data())) / norm(load3(a.data()));
    };
    return std::pair{off(before.linear, after.linear),
                     off(before.angular, after.angular)};
  };
  const auto coarse = change(1e-3), fine = change(5e-4);
  std::printf("linear %.1e, %.1e; angular %.1e, %.1e\n", coarse.first, fine.first,
              coarse.second, fine.second);
  EXPECT_LE(std::max(coarse.first, fine.first), 1e-9);
  EXPECT_LE(coarse.second, 1e-5);
  EXPECT_LE(fine.second, 0.6 * coarse.second);
}

}  // namespace tress::test_free_top
