// Scenes as `simulate` writes them (format "tress-strands-1", described in README.md):
// reads and checks every scenes/*.json of a results directory. Every complaint names the
// file and the key, and what to do.
import { existsSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { InputError, read_json, read_or_warn, size_limit } from './input.mjs';
import { is_object } from './objects.mjs';

export const scene_format = 'tress-strands-1';
export const shapes = ['plane', 'sphere', 'ellipsoid', 'capsule'];

const longest_m = 1e9; // a strand that flew away cannot be drawn

const is_count = (value) => Number.isSafeInteger(value) && value >= 0;
const is_text = (value) => typeof value === 'string' && value !== '';
const is_numbers = (value, length) =>
  Array.isArray(value) &&
  (length === undefined || value.length === length) &&
  value.every(Number.isFinite);

// Number of bytes in base64 with padding, undefined when the text is not that.
function base64_bytes(text) {
  if (typeof text !== 'string' || text.length % 4 !== 0) return undefined;
  if (!/^[A-Za-z0-9+/]*={0,2}$/.test(text)) return undefined;
  return (text.length / 4) * 3 - (text.match(/=*$/)[0].length);
}

const remedy = 'run simulate again or remove the file';

// {need(holds, key, wish)}: throws unless `holds`.
const checker = (file) => ({
  need(holds, key, wish) {
    if (!holds) throw new InputError(`${file}: key '${key}': ${wish}; ${remedy}`);
  },
  bytes(text, key, wanted, what) {
    const found = base64_bytes(text);
    this.need(found !== undefined, key, 'is not base64');
    this.need(found === wanted, key, `${found} bytes where ${what} need ${wanted}`);
  },
});

function check_bodies(bodies, frames, { need }) {
  need(Array.isArray(bodies), 'bodies', 'must be an array');
  bodies.forEach((body, i) => {
    const key = `bodies[${i}]`;
    const { shape, half_axes_m, poses } = body ?? {};
    need(shapes.includes(shape), `${key}.shape`, `must be one of ${shapes.join(', ')}`);
    need(
      shape === 'plane' || (is_numbers(half_axes_m, 3) && half_axes_m.every((a) => a > 0)),
      `${key}.half_axes_m`,
      'must hold three positive numbers',
    );
    need(
      Array.isArray(poses) && [1, frames].includes(poses.length),
      `${key}.poses`,
      `must hold one pose or ${frames}, one for each frame`,
    );
    const wrong = poses.findIndex(
      (pose) =>
        !is_numbers(pose, 7) || Math.abs(Math.hypot(...pose.slice(3)) - 1) > 1e-3,
    );
    need(
      wrong < 0,
      `${key}.poses[${wrong}]`,
      'must be [x, y, z, qw, qx, qy, qz] with a quaternion of length 1',
    );
  });
}

function check_contacts(contacts, frames, { need }) {
  if (contacts === undefined) return;
  need(
    Array.isArray(contacts) && contacts.length === frames,
    'contacts',
    `must hold ${frames} arrays, one of each frame`,
  );
  const wrong = contacts.findIndex((one) => !is_numbers(one) || one.length % 6 !== 0);
  need(
    wrong < 0,
    `contacts[${wrong}]`,
    'must hold six numbers of each contact: place and force',
  );
}

function check_series(series, { need }) {
  need(is_object(series), 'series', 'must be an object');
  const { columns, rows } = series;
  need(
    Array.isArray(columns) && columns.every(is_text) && columns[0] === 't_s',
    'series.columns',
    "must be names, the first 't_s'",
  );
  need(
    new Set(columns).size === columns.length,
    'series.columns',
    'a name appears twice',
  );
  need(Array.isArray(rows), 'series.rows', 'must be an array');
  const wrong = rows.findIndex(
    (row) =>
      !Array.isArray(row) ||
      row.length !== columns.length ||
      !Number.isFinite(row[0]) ||
      row.some((value) => value !== null && !Number.isFinite(value)),
  );
  need(
    wrong < 0,
    `series.rows[${wrong}]`,
    `must hold ${columns.length} numbers, null where there is none, and a time`,
  );
}

// Throws InputError unless `scene` is a whole scene.
export function check_scene(scene, file) {
  const check = checker(file);
  const { need } = check;
  if (!is_object(scene))
    throw new InputError(`${file}: must be a JSON object; ${remedy}`);
  need(scene.format === scene_format, 'format', `must be '${scene_format}'`);
  for (const key of ['scene', 'model', 'integrator'])
    need(is_text(scene[key]), key, 'must be a text that is not empty');
  for (const key of ['title', 'source'])
    need(typeof scene[key] === 'string', key, 'must be a text');
  need(
    scene.dt_s === null || (Number.isFinite(scene.dt_s) && scene.dt_s > 0),
    'dt_s',
    'must be a positive number, or null of an adaptive step',
  );
  const times = scene.times_s;
  need(
    is_numbers(times) && times.length > 0 && times.every((t, i) => !(t <= times[i - 1])),
    'times_s',
    'must hold growing numbers',
  );
  const counts = scene.strand_points;
  need(
    Array.isArray(counts) &&
      counts.length > 0 &&
      counts.every((n) => Number.isSafeInteger(n) && n >= 2),
    'strand_points',
    'must hold whole numbers of at least 2',
  );
  need(
    scene.guides === undefined || (is_count(scene.guides) && scene.guides <= counts.length),
    'guides',
    `must be a whole number up to ${counts.length}, the number of strands`,
  );
  need(is_numbers(scene.low, 3), 'low', 'must hold three numbers');
  need(is_numbers(scene.high, 3), 'high', 'must hold three numbers');
  need(
    scene.low.every((low, i) => low <= scene.high[i] && scene.high[i] - low < longest_m),
    'high',
    `must not be less than 'low', nor ${longest_m} m more`,
  );
  const points = counts.reduce((sum, n) => sum + n, 0);
  const what = `${times.length} frames of ${points} points`;
  check.bytes(scene.positions, 'positions', times.length * points * 6, what);
  need(Array.isArray(scene.channels), 'channels', 'must be an array');
  scene.channels.forEach((channel, i) => {
    const key = `channels[${i}]`;
    need(is_text(channel?.name), `${key}.name`, 'must be a text');
    need(typeof channel.unit === 'string', `${key}.unit`, "must be a text, '' for none");
    need(
      is_numbers([channel.low, channel.high]) && channel.low <= channel.high,
      `${key}.low`,
      "must be a number, as 'high', which is not less",
    );
    check.bytes(channel.values, `${key}.values`, times.length * points, what);
  });
  check_contacts(scene.contacts, times.length, check);
  check_bodies(scene.bodies, times.length, check);
  check_series(scene.series, check);
}

// What the manifest beside a scene says about its run.
function outcome_of(file) {
  const path = file.replace(/\.json$/, '.meta.json');
  const outcome = existsSync(path) ? read_json(path)?.outcome : undefined;
  return is_object(outcome) ? outcome : {};
}

function scene_files(folder, warn) {
  if (!existsSync(folder)) return [];
  try {
    return readdirSync(folder)
      .filter((file) => file.endsWith('.json') && !file.endsWith('.meta.json'))
      .sort();
  } catch (error) {
    warn(`${folder}: not a readable folder (${error.code}); rename or remove it`);
    return [];
  }
}

// Every readable scenes/*.json in `directory` but manifests; the others are warnings.
export function load_scenes(directory, warn) {
  const folder = join(directory, 'scenes');
  const scenes = new Map();
  let room = size_limit;
  const read = (file) => {
    const scene = read_json(file, room);
    check_scene(scene, file);
    if (scenes.has(scene.scene))
      throw new InputError(
        `${file}: another file holds the scene '${scene.scene}'; remove one`,
      );
    room -= scene.channels.reduce(
      (sum, { values }) => sum + values.length,
      scene.positions.length,
    );
    return {
      ...scene,
      title: scene.title === '' ? scene.scene : scene.title,
      outcome: read_or_warn(() => outcome_of(file), warn),
    };
  };
  for (const name of scene_files(folder, warn)) {
    const scene = read_or_warn(() => read(join(folder, name)), warn);
    if (scene !== undefined) scenes.set(scene.scene, scene);
  }
  return [...scenes.values()];
}
