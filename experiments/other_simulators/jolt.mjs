// Jolt Physics as its makers publish it for JavaScript, in WebAssembly and single precision: a
// soft body of rods [Kugelstadt & Schömer 2016]. The first line is JSON: the links and their
// length, mass, moment and springs, the damping and the step.
import initJolt from 'jolt-physics';
import { serve } from './strand_in_node.mjs';

await serve(async (line) => {
  const jolt = await initJolt();
  const { links, length, mass, moment, hinge, stretch, damping, dt } = JSON.parse(line);
  const settings = new jolt.JoltSettings();
  settings.mMaxWorkerThreads = 0;
  // One layer, in which nothing collides.
  settings.mObjectLayerPairFilter = new jolt.ObjectLayerPairFilterTable(1);
  const layers = new jolt.BroadPhaseLayerInterfaceTable(1, 1);
  layers.MapObjectToBroadPhaseLayer(0, new jolt.BroadPhaseLayer(0));
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new jolt.ObjectVsBroadPhaseLayerFilterTable(
    layers,
    1,
    settings.mObjectLayerPairFilter,
    1,
  );
  const world = new jolt.JoltInterface(settings);
  const system = world.GetPhysicsSystem();

  // Nodes before and at the clamp do not move; the rod between them is the clamp's frame.
  const shape = new jolt.SoftBodySharedSettings();
  for (let i = -1; i <= links; ++i) {
    const node = new jolt.SoftBodySharedSettingsVertex();
    node.mPosition = new jolt.Float3(i * length, 0, 0);
    node.mInvMass = i <= 0 ? 0 : 1 / (i < links ? mass : mass / 2);
    shape.mVertices.push_back(node);
  }
  for (let i = 0; i <= links; ++i) {
    shape.mRodStretchShearConstraints.push_back(
      new jolt.SoftBodySharedSettingsRodStretchShear(i, i + 1, 1 / stretch),
    );
  }
  // A rod's constraint is sin(angle/2) of its bend: energy k angle^2/2 is 4 k of it.
  for (let i = 0; i < links; ++i) {
    const stiffness = 4 * (i === 0 ? 2 * hinge : hinge);
    shape.mRodBendTwistConstraints.push_back(
      new jolt.SoftBodySharedSettingsRodBendTwist(i, i + 1, 1 / stiffness),
    );
  }
  shape.CalculateRodProperties();
  // What is called inverse mass of a rod weighs its quaternion, whose mass is four moments.
  const rods = shape.mRodStretchShearConstraints;
  for (let i = 1; i <= links; ++i) rods.at(i).mInvMass = 1 / (4 * moment);
  shape.Optimize();

  const body = new jolt.SoftBodyCreationSettings(
    shape,
    new jolt.RVec3(0, 0, 0),
    jolt.Quat.prototype.sIdentity(),
    0,
  );
  body.mNumIterations = 1;
  body.mLinearDamping = damping;
  body.mMaxLinearVelocity = 1e9;
  body.mUpdatePosition = false;
  body.mAllowSleeping = false;
  const strand = system.GetBodyInterface().CreateSoftBody(body);
  system.GetBodyInterface().AddBody(strand.GetID(), jolt.EActivation_Activate);
  const motion = jolt.castObject(
    strand.GetMotionProperties(),
    jolt.SoftBodyMotionProperties,
  );
  const gravity = new jolt.Vec3(0, 0, 0);

  const nodes = Array.from({ length: links }, (_, i) => motion.GetVertex(i + 2));

  return {
    step(x, y, z) {
      gravity.Set(x, y, z);
      system.SetGravity(gravity);
      world.Step(dt, 1);
    },
    motion() {
      const kinetic = nodes.reduce(
        (sum, node, i) =>
          sum + ((i + 1 < links ? mass : mass / 2) / 2) * node.mVelocity.LengthSq(),
        0,
      );
      const at = nodes[links - 1].mPosition;
      const tip = [at.GetX(), at.GetY(), at.GetZ()];
      return { tip: tip.every(Number.isFinite) ? tip : null, kinetic };
    },
  };
});
