// What scenes fill of space, for the camera.
import { add, profile_of } from './camera.mjs';
import { positions_at } from './data.mjs';

const samples = 4000;

// Positions (m) of some points of some frames, ends of strands among them.
function some_points(scene) {
  const { points, frames, starts } = scene;
  const frame_stride = Math.ceil(frames / 40);
  const stride = Math.max(1, Math.floor((points * Math.min(frames, 40)) / samples));
  const ends = new Set(starts.map((start) => start - 1));
  const out = [];
  const positions = new Float64Array(3 * points);
  for (let frame = 0; frame < frames; frame += frame_stride) {
    positions_at(scene, frame, positions);
    for (let p = 0; p < points; ++p)
      if (p % stride === 0 || ends.has(p))
        out.push([...positions.subarray(3 * p, 3 * p + 3)]);
  }
  return out;
}

// The ends of a body but a plane in every direction, at each of its poses.
const body_points = ({ shape, half_axes_m: half, poses }) => {
  if (shape === 'plane') return [];
  const reach = shape === 'capsule' ? half[0] + half[2] : Math.max(...half);
  return poses.flatMap((pose) =>
    [0, 1, 2].flatMap((i) =>
      [reach, -reach].map((r) => [0, 1, 2].map((k) => pose[k] + (k === i ? r : 0))),
    ),
  );
};

// The middle of all that is shown, planes apart, the radius (m) of a ball about it that
// holds it, and its profile. `more`: further points to hold.
export function extent_of(scenes, more = []) {
  const points = scenes
    .flatMap((scene) => [...some_points(scene), ...scene.bodies.flatMap(body_points)])
    .concat(more);
  const [least, most] = [Math.min, Math.max].map((of) =>
    [0, 1, 2].map((i) => points.reduce((end, point) => of(end, point[i]), points[0][i])),
  );
  const middle = least.map((l, i) => (l + most[i]) / 2);
  const radius = 0.5 * Math.hypot(...add(most, least, -1)) || 1;
  return { middle, radius, profile: profile_of(points, middle) };
}
