// What Khronos' validator, three.js and glTF-Transform find in a .glb file.
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { NodeIO } from "@gltf-transform/core";
import validator from "gltf-validator";
import { AnimationMixer, LoopOnce, Vector3 } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";

globalThis.self = globalThis; // which the loader asks for pictures

/// Complaints of Khronos' validator, as texts.
async function invalid(file, bytes) {
  const { issues } = await validator.validateBytes(new Uint8Array(bytes));
  return issues.messages
    .filter(({ severity }) => severity < 2)
    .map(({ code, message, pointer }) => `${file}: ${code}: ${message} ${pointer ?? ""}`);
}

/// Points of each line of pairs that go on where the one before ends.
function counts_of(pairs) {
  const counts = [];
  for (let i = 0; i < pairs.length; i += 2) {
    if (i === 0 || pairs[i] !== pairs[i - 1]) counts.push(1);
    if (pairs[i + 1] !== pairs[i] + 1) throw new Error("lines do not take points in order");
    ++counts[counts.length - 1];
  }
  return counts;
}

/// As three.js draws it: its own animation at every time, in the world, turned to z up.
async function by_three(file, bytes) {
  const model = await new GLTFLoader().parseAsync(bytes.buffer, "");
  let lines;
  model.scene.traverse((node) => {
    if (node.isLineSegments) lines = node;
  });
  const { attributes, index, morphAttributes } = lines.geometry;
  const clip = model.animations[0];
  const action = new AnimationMixer(model.scene).clipAction(clip);
  action.setLoop(LoopOnce).clampWhenFinished = true;
  const times = [...clip.tracks[0].times];
  const point = new Vector3();
  const frames = times.map((time) => {
    action.reset().play();
    action.time = time;
    action.getMixer().update(0);
    lines.updateWorldMatrix(true, false);
    const blended = Float64Array.from(attributes.position.array);
    lines.morphTargetInfluences.forEach((weight, target) => {
      if (weight === 0) return;
      const moved = morphAttributes.position[target].array;
      for (let i = 0; i < blended.length; i++) blended[i] += weight * moved[i];
    });
    for (let i = 0; i < blended.length; i += 3) {
      point.fromArray(blended, i).applyMatrix4(lines.matrixWorld);
      [blended[i], blended[i + 1], blended[i + 2]] = [point.x, -point.z, point.y];
    }
    return { points: [...blended] };
  });
  return {
    file,
    reader: "three.js",
    times,
    frames,
    counts: counts_of([...index.array]),
    radius: attributes._radius && [...attributes._radius.array],
    strand: attributes._strand && [...attributes._strand.array],
  };
}

/// Attributes of all frames, which three.js drops.
async function by_transform(file, bytes) {
  const root = (await new NodeIO().readBinary(new Uint8Array(bytes))).getRoot();
  const [mesh] = root.listMeshes();
  const [primitive] = mesh.listPrimitives();
  const [sampler] = root.listAnimations()[0].listSamplers();
  const targets = primitive.listTargets();
  const values = (name) => {
    const first = [...primitive.getAttribute(name).getArray()];
    const moved = targets.map((target) => target.getAttribute(name).getArray());
    return [first, ...moved.map((more) => first.map((x, i) => x + more[i]))];
  };
  const titled = Object.entries(mesh.getExtras().attributes);
  const constant = (name) => {
    const found = primitive.getAttribute(name)?.getArray();
    return found && [...found];
  };
  return {
    file,
    reader: "glTF-Transform",
    times: [...sampler.getInput().getArray()],
    frames: values("POSITION").map((points) => ({ points })),
    counts: counts_of([...primitive.getIndices().getArray()]),
    radius: constant("_RADIUS"),
    strand: constant("_STRAND"),
    channels: Object.fromEntries(
      titled
        .filter(([name]) => !/^_(RADIUS|STRAND)$/.test(name))
        .map(([name, title]) => [title, values(name)]),
    ),
  };
}

/// One reading by each; throws Error where one cannot read the file.
export async function read_gltf(path) {
  const file = basename(path);
  const bytes = Uint8Array.from(readFileSync(path));
  const wrong = await invalid(file, bytes);
  if (wrong.length > 0) throw new Error(wrong.slice(0, 3).join("; "));
  try {
    return [await by_three(file, bytes), await by_transform(file, bytes)];
  } catch (error) {
    throw new Error(`${file}: ${error.message}`);
  }
}
