// ODE (Open Dynamics Engine): free bodies held together by ball joints as constraints,
// symplectic Euler; the constraint forces by a dense factor (step) or by projected
// Gauss-Seidel sweeps (quickstep).
#include <ode/ode.h>

#include <vector>

#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {
namespace {

class Ode : public Simulator {
 public:
  using Stepper = int (*)(dWorldID, dReal);

  Ode(const Swing& swing, double dt, Stepper stepper)
      : swing_(swing), dt_(dt), stepper_(stepper) {
    dInitODE2(0);
    dRandSetSeed(1);  // quickstep shuffles the constraints
    world_ = dWorldCreate();
    dMass mass;
    const double moment = swing.moment();
    dMassSetParameters(&mass, swing.mass(), 0, 0, 0, moment, moment, moment, 0, 0, 0);
    for (int i = 0; i < swing.links; ++i) {
      const dBodyID body = dBodyCreate(world_);
      dBodySetMass(body, &mass);
      dBodySetPosition(body, (i + 0.5) * swing.link_length(), 0, 0);
      const dJointID joint = dJointCreateBall(world_, nullptr);
      dJointAttach(joint, body, i == 0 ? nullptr : bodies_.back());
      dJointSetBallAnchor(joint, i * swing.link_length(), 0, 0);
      bodies_.push_back(body);
    }
  }

  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;
  ~Ode() override {
    dWorldDestroy(world_);
    dCloseODE();
  }

  void step(double t) override {
    const Vec g = Swing::gravity(t);
    dWorldSetGravity(world_, g.x, g.y, g.z);
    for (int i = 0; i < swing_.links; ++i) {
      const dBodyID body = bodies_[static_cast<std::size_t>(i)];
      const Vec force = -Swing::damping * swing_.mass() * load3(dBodyGetLinearVel(body));
      dBodyAddForce(body, force.x, force.y, force.z);
      turn(body, -Swing::damping * swing_.moment() * load3(dBodyGetAngularVel(body)));
      bend(i);
    }
    stepper_(world_, dt_);
  }

  Motion motion() override {
    double energy = 0;
    for (const dBodyID body : bodies_) {
      const Vec velocity = load3(dBodyGetLinearVel(body));
      const Vec spin = load3(dBodyGetAngularVel(body));
      energy +=
          (swing_.mass() * dot(velocity, velocity) + swing_.moment() * dot(spin, spin)) /
          2;
    }
    dVector3 tip;
    dBodyGetRelPointPos(bodies_.back(), swing_.link_length() / 2, 0, 0, tip);
    return {load3(tip), energy};
  }

 private:
  static void turn(dBodyID body, const Vec& torque) {
    dBodyAddTorque(body, torque.x, torque.y, torque.z);
  }

  /// The spring of one hinge, between link i and the one before it (or the clamp).
  void bend(int i) const {
    const dBodyID body = bodies_[static_cast<std::size_t>(i)];
    const dReal* q = dBodyGetQuaternion(body);  // w, x, y, z
    if (i == 0) {
      turn(body, -swing_.stiffness(0) * rotation_vector(q[0], load3(q + 1)));
      return;
    }
    const dBodyID before = bodies_[static_cast<std::size_t>(i) - 1];
    dQuaternion relative;
    dQMultiply1(relative, dBodyGetQuaternion(before), q);
    const Vec local =
        swing_.stiffness(i) * rotation_vector(relative[0], load3(relative + 1));
    dVector3 world;
    dBodyVectorToWorld(before, local.x, local.y, local.z, world);
    turn(before, load3(world));
    turn(body, -1. * load3(world));
  }

  const Swing swing_;
  const double dt_;
  const Stepper stepper_;
  dWorldID world_;
  std::vector<dBodyID> bodies_;
};

template <Ode::Stepper stepper>
std::unique_ptr<Simulator> make(const Swing& swing, double dt) {
  return std::make_unique<Ode>(swing, dt, stepper);
}

constexpr Method methods[] = {
    {"ball joints: step", 1, make<dWorldStep>},
    {"ball joints: quickstep", 1, make<dWorldQuickStep>},
};

}  // namespace

std::span<const Method> ode_methods() { return methods; }

}  // namespace tress::experiments::other_simulators
