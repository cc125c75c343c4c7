// Compliant contact (Hunt and Crossley) with friction that is regularised below a
// transition speed, semi-explicit Euler with a fixed step.
#include "experiments/other_simulators/simbody_block.h"

#include <Simbody.h>

namespace tress::experiments::other_simulators {

double SimbodyBlock::way(double dt) const {
  using namespace SimTK;
  constexpr double foot = 0.2;  // radius of the spheres on which the block stands
  MultibodySystem system;
  SimbodyMatterSubsystem matter(system);
  GeneralForceSubsystem forces(system);
  ContactTrackerSubsystem tracker(system);
  CompliantContactSubsystem contact(system, tracker);
  contact.setTransitionVelocity(1);  // mm/s
  const Force::Gravity weight(forces, matter, Vec3(gravity[0], gravity[1], gravity[2]));
  // It sinks by 10 um.
  const ContactMaterial material(4e7, 1e-2, friction, friction, 0);
  // A half space fills x > 0 of its frame.
  matter.Ground().updBody().addContactSurface(
      Transform(Rotation(Pi / 2, YAxis), Vec3(0)),
      ContactSurface(ContactGeometry::HalfSpace(), material));
  Body::Rigid body(
      MassProperties(mass, Vec3(0), Inertia(moments[0], moments[1], moments[2])));
  for (const double x : {-half[0], half[0]}) {
    for (const double y : {-half[1], half[1]}) {
      body.addContactSurface(Transform(Vec3(x, y, foot - half[2])),
                             ContactSurface(ContactGeometry::Sphere(foot), material));
    }
  }
  const MobilizedBody::Free block(matter.Ground(), Transform(Vec3(0)), body,
                                  Transform(Vec3(0)));
  State state = system.realizeTopology();
  block.setQToFitTranslation(state, Vec3(0, 0, half[2]));
  SemiExplicitEulerIntegrator integrator(system, dt);
  TimeStepper stepper(system, integrator);
  stepper.initialize(state);
  stepper.stepTo(settling);
  const double start = block.getBodyOriginLocation(stepper.getState())[0];
  stepper.stepTo(settling + watched);
  return block.getBodyOriginLocation(stepper.getState())[0] - start;
}

}  // namespace tress::experiments::other_simulators
