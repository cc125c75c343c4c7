// Simbody (SimTK): recursive multibody dynamics in joint coordinates, ball joints with
// quaternions; its own integrators at a fixed step.
//
// C++20 finds the comparison of two of Simbody 3.7's index types ambiguous: they convert
// to each kind of whole number. An exact match, declared before its headers, settles it.
namespace SimTK {
template <class Index>
requires requires { Index::isValidExtended(0); }
bool operator==(const Index& a, const Index& b) {
  return static_cast<int>(a) == static_cast<int>(b);
}
}  // namespace SimTK

#include <Simbody.h>

#include "contract/system.h"
#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {
namespace {

SimTK::Vec3 simtk(const Vec& a) { return {a.x, a.y, a.z}; }

/// Gravity, damping and springs of the whole strand in one force element.
class StrandForces : public SimTK::Force::Custom::Implementation {
 public:
  StrandForces(const SimTK::SimbodyMatterSubsystem& matter, const Swing& swing)
      : matter_(matter), swing_(swing) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& on_bodies,
                 SimTK::Vector_<SimTK::Vec3>& /*on_particles*/,
                 SimTK::Vector& on_joints) const override {
    const SimTK::Vec3 weight = swing_.mass() * simtk(Swing::gravity(state.getTime()));
    for (int i = 0; i < swing_.links; ++i) {
      const SimTK::MobilizedBodyIndex index(i + 1);  // 0 is the ground
      const SimTK::MobilizedBody& link = matter_.getMobilizedBody(index);
      const SimTK::SpatialVec& velocity = link.getBodyVelocity(state);
      on_bodies[index] +=
          SimTK::SpatialVec(-Swing::damping * swing_.moment() * velocity[0],
                            weight - Swing::damping * swing_.mass() * velocity[1]);

      const SimTK::Quaternion q =
          link.getMobilizerTransform(state).R().convertRotationToQuaternion();
      const SimTK::Vec3 torque =
          -swing_.stiffness(i) * simtk(rotation_vector(q[0], {q[1], q[2], q[3]}));
      for (int axis = 0; axis < 3; ++axis) {
        link.applyOneMobilityForce(state, axis, torque[axis], on_joints);
      }
    }
  }

  SimTK::Real calcPotentialEnergy(const SimTK::State& /*state*/) const override {
    return 0;  // asked for by reporters only
  }

 private:
  const SimTK::SimbodyMatterSubsystem& matter_;
  const Swing swing_;
};

template <class Integrator>
class Simbody : public Simulator {
 public:
  Simbody(const Swing& swing, double dt)
      : swing_(swing), matter_(system_), forces_(system_) {
    const double half = swing.link_length() / 2;
    const SimTK::Body::Rigid body(SimTK::MassProperties(swing.mass(), SimTK::Vec3(0),
                                                        SimTK::Inertia(swing.moment())));
    for (int i = 0; i < swing.links; ++i) {
      SimTK::MobilizedBody& parent =
          matter_.updMobilizedBody(SimTK::MobilizedBodyIndex(i));
      SimTK::MobilizedBody::Ball(parent, SimTK::Vec3(i == 0 ? 0 : half, 0, 0), body,
                                 SimTK::Vec3(-half, 0, 0));
    }
    SimTK::Force::Custom(forces_, new StrandForces(matter_, swing));  // forces_ owns it
    const SimTK::State start = system_.realizeTopology();
    integrator_ = make_integrator(dt);
    integrator_->setReturnEveryInternalStep(true);  // else it makes slivers of steps
    integrator_->setFinalTime(SimTK::Infinity);
    integrator_->initialize(start);
    integrator_->stepTo(SimTK::Infinity);  // reports the start
  }

  void step(double /*t*/) override {
    if (gave_up_) return;
    try {
      integrator_->stepTo(SimTK::Infinity);
    } catch (const SimTK::Exception::Base&) {  // on numbers that are not finite
      gave_up_ = true;
    }
  }

  Motion motion() override {
    try {
      if (!gave_up_) return reading();
    } catch (const SimTK::Exception::Base&) {
      gave_up_ = true;
    }
    return {.tip = {SimTK::NaN, 0, 0}};
  }

 private:
  Motion reading() const {
    const SimTK::State& state = integrator_->getState();
    system_.realize(state, SimTK::Stage::Velocity);
    const SimTK::Vec3 tip =
        matter_.getMobilizedBody(SimTK::MobilizedBodyIndex(swing_.links))
            .findStationLocationInGround(state,
                                         SimTK::Vec3(swing_.link_length() / 2, 0, 0));
    return {{tip[0], tip[1], tip[2]}, system_.calcKineticEnergy(state)};
  }

  std::unique_ptr<SimTK::Integrator> make_integrator(double dt) const {
    if constexpr (std::is_constructible_v<Integrator, const SimTK::System&, double>) {
      return std::make_unique<Integrator>(system_, dt);
    } else {
      auto integrator = std::make_unique<Integrator>(system_);
      integrator->setFixedStepSize(dt);
      return integrator;
    }
  }

  const Swing swing_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  std::unique_ptr<SimTK::Integrator> integrator_;
  bool gave_up_ = false;
};

template <class Integrator>
std::unique_ptr<Simulator> make(const Swing& swing, double dt) {
  return std::make_unique<Simbody<Integrator>>(swing, dt);
}

constexpr Method methods[] = {
    {"ball joints: semi-explicit Euler", 1, make<SimTK::SemiExplicitEulerIntegrator>},
    {"ball joints: Runge-Kutta-Merson", 4, make<SimTK::RungeKuttaMersonIntegrator>},
};

}  // namespace

std::span<const Method> simbody_methods() { return methods; }

}  // namespace tress::experiments::other_simulators
