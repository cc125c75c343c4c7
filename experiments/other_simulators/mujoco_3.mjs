// MuJoCo 3 as its makers publish it for JavaScript, in WebAssembly. The first line is JSON:
// the model in MuJoCo's format, its links and their length, and the damping.
import loadMujoco from '@mujoco/mujoco';
import { serve } from './strand_in_node.mjs';

await serve(async (line) => {
  const mujoco = await loadMujoco();
  const { model: text, links, length, damping, dt, split } = JSON.parse(line);
  const model = mujoco.MjModel.from_xml_string(text);
  const data = new mujoco.MjData(model);
  const gravity = model.opt.gravity;
  const velocity = data.qvel;
  const applied = data.qfrc_applied;
  const buffer = new mujoco.DoubleBuffer(model.nv);
  const momentum = buffer.GetView();
  const { mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC } = mujoco.mjtWarning;
  const restarts = [mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC].map((w) => w.value);

  // Damping of every body by its mass and moment is damping by the mass matrix: a force,
  // or, where a method takes several stages in a step, what it does to the velocities
  // before and after (Strang's splitting, order 2).
  const half = Math.exp((-damping * dt) / 2);
  const decay = () => {
    for (let k = 0; k < velocity.length; ++k) velocity[k] *= half;
  };
  const step = split
    ? () => {
        decay();
        mujoco.mj_step(model, data);
        decay();
      }
    : () => {
        mujoco.mj_step1(model, data);
        mujoco.mj_mulM(model, data, buffer, velocity);
        for (let k = 0; k < velocity.length; ++k) applied[k] = -damping * momentum[k];
        mujoco.mj_step2(model, data);
      };

  return {
    step(x, y, z) {
      gravity[0] = x;
      gravity[1] = y;
      gravity[2] = z;
      step();
    },
    motion() {
      // On bad numbers MuJoCo warns and starts over from the initial state.
      if (restarts.some((kind) => data.warning.get(kind).number > 0))
        return { tip: null };
      mujoco.mj_fwdPosition(model, data);
      mujoco.mj_mulM(model, data, buffer, velocity);
      const kinetic = velocity.reduce((sum, v, k) => sum + (v * momentum[k]) / 2, 0);
      // Body 0 is the world; the first column of a matrix is the link's axis.
      const at = data.xpos.subarray(3 * links);
      const axes = data.xmat.subarray(9 * links);
      return { tip: [0, 1, 2].map((d) => at[d] + length * axes[3 * d]), kinetic };
    },
  };
});
