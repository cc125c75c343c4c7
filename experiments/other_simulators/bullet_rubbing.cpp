// Bullet in double precision: rigid bodies, contacts and joints by projected Gauss-Seidel
// sweeps over impulses (sequential impulses), symplectic Euler.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>
#include <vector>

#include "experiments/other_simulators/rubbing.h"

namespace tress::experiments::other_simulators {
namespace {

btVector3 bt(const Vec& a) { return {a.x, a.y, a.z}; }

class World {
 public:
  explicit World(double friction)
      : friction_(friction),
        dispatcher_(&collisions_),
        world_(&dispatcher_, &broadphase_, &solver_, &collisions_) {
    world_.getSolverInfo().m_numIterations = 100;
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  btDiscreteDynamicsWorld& world() { return world_; }
  /// mass 0: fixed. Fixed bodies touch the others, which do not touch each other.
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, double mass,
                   const Vec& moments, const btTransform& at) {
    shape->setMargin(0.04);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(),
                                                  bt(moments));
    info.m_startWorldTransform = at;
    info.m_friction = std::sqrt(friction_);  // they are multiplied
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    shapes_.push_back(std::move(shape));
    btRigidBody& body = *bodies_.back();
    body.setActivationState(
        DISABLE_DEACTIVATION);  // what creeps must not be put to sleep
    world_.addRigidBody(&body, mass == 0 ? 1 : 2, mass == 0 ? 2 : 1);
    return body;
  }
  void join(btRigidBody& a, btRigidBody& b, const btVector3& in_a,
            const btVector3& in_b) {
    joints_.push_back(std::make_unique<btPoint2PointConstraint>(a, b, in_a, in_b));
    world_.addConstraint(joints_.back().get(), true);
  }
  void step(double dt) { world_.stepSimulation(dt, 0); }

 private:
  double friction_;
  btDefaultCollisionConfiguration collisions_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btPoint2PointConstraint>> joints_;
};

double slope(const Slope& slope, double dt) {
  World world(slope.friction);
  world.world().setGravity(bt(slope.gravity()));
  world.add(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0), 0, {},
            btTransform::getIdentity());
  const btRigidBody& block = world.add(
      std::make_unique<btBoxShape>(bt(Slope::half)), Slope::mass, Slope::moments(),
      btTransform(btQuaternion::getIdentity(), btVector3(0, 0, Slope::half.z)));
  double start = 0;
  const auto x = [&] { return block.getWorldTransform().getOrigin().x(); };
  for (int i = 0; i * dt < Slope::settling + Slope::watched; ++i) {
    if (i * dt < Slope::settling) start = x();
    world.step(dt);
  }
  return x() - start;
}

double capstan(const Capstan& capstan, double dt) {
  World world(capstan.friction);
  world.world().setGravity({0, 0, 0});
  world.add(std::make_unique<btCapsuleShape>(Capstan::radius, 50), 0, {},
            btTransform::getIdentity());  // along y
  const double l = capstan.link_length(), moment = capstan.moment();
  std::vector<btRigidBody*> links;
  for (int i = 0; i < capstan.links; ++i) {
    const double turned = capstan.angle(i) + std::numbers::pi / 2;
    links.push_back(
        &world.add(std::make_unique<btCapsuleShapeZ>(Capstan::link_radius, l),
                   Capstan::mass, {moment, moment, moment},
                   btTransform(btQuaternion({0, 1, 0}, turned), bt(capstan.centre(i)))));
    if (i > 0)
      world.join(*links[links.size() - 2], *links.back(), {0, 0, l / 2}, {0, 0, -l / 2});
  }
  const btVector3 start = links.front()->getWorldTransform().getOrigin();
  const auto pull = [](btRigidBody& body, double force, double along) {
    body.applyForce({0, 0, -force},
                    body.getWorldTransform().getBasis() * btVector3(0, 0, along));
  };
  for (int i = 0; i * dt < Capstan::watched; ++i) {
    pull(*links.front(), Capstan::pull, -l / 2);
    pull(*links.back(), capstan.ratio * Capstan::pull, l / 2);
    world.step(dt);
  }
  return (links.front()->getWorldTransform().getOrigin() - start).length();
}

constexpr RubbingMethod methods[] = {{"sequential impulses, 100 sweeps", slope, capstan}};

}  // namespace

std::span<const RubbingMethod> bullet_rubbing() { return methods; }

}  // namespace tress::experiments::other_simulators
