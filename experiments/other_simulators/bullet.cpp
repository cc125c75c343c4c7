// Bullet's multibody in double precision: Featherstone's articulated-body sweep,
// spherical joints, symplectic Euler.
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletCollisionCommon.h>

#include <vector>

#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {
namespace {

btVector3 bt(const Vec& a) { return {a.x, a.y, a.z}; }

class Bullet : public Simulator {
 public:
  Bullet(const Swing& swing, double dt)
      : swing_(swing),
        dt_(dt),
        dispatcher_(&collisions_),
        world_(&dispatcher_, &broadphase_, &solver_, &collisions_),
        strand_(swing.links, 0, btVector3(0, 0, 0), true, false),
        spin_(static_cast<std::size_t>(swing.links) + 1),
        velocity_(spin_.size()) {
    const double half = swing.link_length() / 2, moment = swing.moment();
    for (int i = 0; i < swing.links; ++i) {
      strand_.setupSpherical(i, swing.mass(), btVector3(moment, moment, moment), i - 1,
                             btQuaternion::getIdentity(),
                             btVector3(i == 0 ? 0 : half, 0, 0), btVector3(half, 0, 0),
                             true);
    }
    strand_.finalizeMultiDof();
    strand_.setLinearDamping(0);  // it has a part quadratic in speed: ours instead
    strand_.setAngularDamping(0);
    strand_.setMaxCoordinateVelocity(BT_LARGE_FLOAT);
    world_.addMultiBody(&strand_);
    world_.forwardKinematics();
  }

  ~Bullet() override { world_.removeMultiBody(&strand_); }

  void step(double t) override {
    world_.setGravity(bt(Swing::gravity(t)));
    find_velocities();
    for (int i = 0; i < swing_.links; ++i) {
      const btMatrix3x3& to_world = strand_.getLink(i).m_cachedWorldTransform.getBasis();
      const auto at = static_cast<std::size_t>(i) + 1;
      strand_.addLinkForce(i,
                           to_world * (-Swing::damping * swing_.mass() * velocity_[at]));
      strand_.addLinkTorque(i,
                            to_world * (-Swing::damping * swing_.moment() * spin_[at]));
      const btScalar* q = strand_.getLink(i).m_jointPos;  // x, y, z, w
      const Vec torque = -swing_.stiffness(i) * rotation_vector(q[3], {q[0], q[1], q[2]});
      strand_.addJointTorqueMultiDof(i, bt(torque));
    }
    world_.stepSimulation(dt_, 0);  // one step of just this length
  }

  Motion motion() override {
    find_velocities();
    double energy = 0;
    for (std::size_t i = 1; i < spin_.size(); ++i) {
      energy += (swing_.mass() * velocity_[i].length2() +
                 swing_.moment() * spin_[i].length2()) /
                2;
    }
    const btVector3 tip = strand_.getLink(swing_.links - 1).m_cachedWorldTransform *
                          btVector3(swing_.link_length() / 2, 0, 0);
    return {{tip.x(), tip.y(), tip.z()}, energy};
  }

 private:
  /// Of the base (0) and the links, at their centres and in their own axes.
  void find_velocities() {
    strand_.compTreeLinkVelocities(spin_.data(), velocity_.data());
  }

  const Swing swing_;
  const double dt_;
  btDefaultCollisionConfiguration collisions_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_;
  btMultiBody strand_;
  std::vector<btVector3> spin_, velocity_;
};

constexpr Method methods[] = {
    {"spherical joints: multibody in double", 1,
     [](const Swing& swing, double dt) -> std::unique_ptr<Simulator> {
       return std::make_unique<Bullet>(swing, dt);
     }},
};

}  // namespace

std::span<const Method> bullet_methods() { return methods; }

}  // namespace tress::experiments::other_simulators
