// ODE: contacts as constraints of a mixed complementarity problem with a friction
// pyramid in the directions of sliding, symplectic Euler.
#include <ode/ode.h>

#include <cmath>
#include <vector>

#include "experiments/other_simulators/rubbing.h"

namespace tress::experiments::other_simulators {
namespace {

using Stepper = int (*)(dWorldID, dReal);

class World {
 public:
  explicit World(double friction) : friction_(friction) {
    dInitODE2(0);
    dRandSetSeed(1);
    world_ = dWorldCreate();
    space_ = dSimpleSpaceCreate(nullptr);
    joints_ = dJointGroupCreate(0);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    dJointGroupDestroy(joints_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dCloseODE();
  }
  dWorldID world() const { return world_; }
  dSpaceID space() const { return space_; }
  dBodyID body(double mass, const Vec& moments, const Vec& at) const {
    dMass own;
    dMassSetParameters(&own, mass, 0, 0, 0, moments.x, moments.y, moments.z, 0, 0, 0);
    const dBodyID made = dBodyCreate(world_);
    dBodySetMass(made, &own);
    dBodySetPosition(made, at.x, at.y, at.z);
    return made;
  }
  void step(Stepper stepper, double dt) {
    dSpaceCollide(space_, this, [](void* self, dGeomID a, dGeomID b) {
      static_cast<World*>(self)->touch(a, b);
    });
    stepper(world_, dt);
    dJointGroupEmpty(joints_);
  }

 private:
  void touch(dGeomID a, dGeomID b) {
    if (dGeomGetBody(a) != nullptr && dGeomGetBody(b) != nullptr) return;
    constexpr int most = 8;
    dContact contacts[most] = {};
    const int found = dCollide(a, b, most, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < found; ++i) {
      contacts[i].surface.mode = dContactApprox1;
      contacts[i].surface.mu = friction_;
      const dJointID joint = dJointCreateContact(world_, joints_, &contacts[i]);
      dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
    }
  }

  double friction_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID joints_;
};

template <Stepper stepper>
double slope(const Slope& slope, double dt) {
  World world(slope.friction);
  const Vec g = slope.gravity();
  dWorldSetGravity(world.world(), g.x, g.y, g.z);
  dCreatePlane(world.space(), 0, 0, 1, 0);
  const dBodyID block = world.body(Slope::mass, Slope::moments(), {0, 0, Slope::half.z});
  dGeomSetBody(
      dCreateBox(world.space(), 2 * Slope::half.x, 2 * Slope::half.y, 2 * Slope::half.z),
      block);
  double start = 0;
  const double end = Slope::settling + Slope::watched;
  for (int i = 0; i * dt < end; ++i) {
    if (i * dt < Slope::settling) start = dBodyGetPosition(block)[0];
    world.step(stepper, dt);
  }
  return dBodyGetPosition(block)[0] - start;
}

template <Stepper stepper>
double capstan(const Capstan& capstan, double dt) {
  World world(capstan.friction);
  dMatrix3 turned;
  dRFromAxisAndAngle(turned, 1, 0, 0, std::numbers::pi / 2);
  dGeomSetRotation(dCreateCapsule(world.space(), Capstan::radius, 50), turned);
  std::vector<dBodyID> links;
  const double moment = capstan.moment();
  for (int i = 0; i < capstan.links; ++i) {
    const dBodyID link =
        world.body(Capstan::mass, {moment, moment, moment}, capstan.centre(i));
    // A capsule lies along z of its body.
    dMatrix3 along;
    dRFromAxisAndAngle(along, 0, 1, 0, capstan.angle(i) + std::numbers::pi / 2);
    dBodySetRotation(link, along);
    dGeomSetBody(
        dCreateCapsule(world.space(), Capstan::link_radius, capstan.link_length()), link);
    if (i > 0) {
      const dJointID joint = dJointCreateBall(world.world(), nullptr);
      dJointAttach(joint, links.back(), link);
      const Vec at = capstan.joint(i);
      dJointSetBallAnchor(joint, at.x, at.y, at.z);
    }
    links.push_back(link);
  }
  const Vec start = capstan.centre(0);
  const double half = capstan.link_length() / 2;
  for (int i = 0; i * dt < Capstan::watched; ++i) {
    dBodyAddForceAtRelPos(links.front(), 0, 0, -Capstan::pull, 0, 0, -half);
    dBodyAddForceAtRelPos(links.back(), 0, 0, -capstan.ratio * Capstan::pull, 0, 0, half);
    world.step(stepper, dt);
  }
  return norm(load3(dBodyGetPosition(links.front())) - start);
}

constexpr RubbingMethod methods[] = {
    {"step", slope<dWorldStep>, capstan<dWorldStep>},
    {"quickstep", slope<dWorldQuickStep>, capstan<dWorldQuickStep>},
};

}  // namespace

std::span<const RubbingMethod> ode_rubbing() { return methods; }

}  // namespace tress::experiments::other_simulators
