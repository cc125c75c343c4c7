// A scene with its arrays, and the positions of one moment.
import { bending_strain } from './strain.mjs';

function bytes_of(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// A scene's arrays out of their base64.
export const arrays_of = (scene) => ({
  ...scene,
  positions: words_of(scene.positions),
  channels: scene.channels.map((channel) => ({
    ...channel,
    values: bytes_of(channel.values),
  })),
});

// Uint16 in the file's byte order, little endian, whatever the machine's is.
function words_of(base64) {
  const bytes = bytes_of(base64);
  const view = new DataView(bytes.buffer);
  const words = new Uint16Array(bytes.length / 2);
  for (let i = 0; i < words.length; ++i) words[i] = view.getUint16(2 * i, true);
  return words;
}

// `scene` with arrays in place of base64.
export function decode_scene(scene) {
  const starts = [0];
  for (const n of scene.strand_points) starts.push(starts.at(-1) + n);
  const decoded = {
    ...scene,
    frames: scene.times_s.length,
    starts, // of strand k the points starts[k] .. starts[k + 1]
    points: starts.at(-1),
    channels: [...scene.channels],
  };
  decoded.channels.push(...bending_strain(decoded));
  return decoded;
}

// Positions (m) at the frame number `moment`, between two frames by linear blending, into
// `out`, 3 numbers a point.
export function positions_at({ low, high, positions, points, frames }, moment, out) {
  const first = Math.min(Math.floor(moment), frames - 1);
  const second = Math.min(first + 1, frames - 1);
  const part = moment - first;
  const scale = low.map((l, i) => (high[i] - l) / 65535);
  const a = first * points * 3;
  const b = second * points * 3;
  for (let c = 0; c < 3; ++c) {
    for (let i = c; i < 3 * points; i += 3) {
      const word = (1 - part) * positions[a + i] + part * positions[b + i];
      out[i] = low[c] + scale[c] * word;
    }
  }
  return out;
}

// Time of a moment, and back, between the frames' times.
export function time_at({ times_s: times, frames }, moment) {
  const i = Math.min(Math.floor(moment), frames - 1);
  const next = times[Math.min(i + 1, frames - 1)];
  return times[i] + (moment - i) * (next - times[i]);
}
export function moment_at({ times_s: times, frames }, time) {
  if (time <= times[0]) return 0;
  const next = times.findIndex((t) => t > time);
  if (next < 0) return frames - 1;
  return next - 1 + (time - times[next - 1]) / (times[next] - times[next - 1]);
}

// The pose of a body at `moment`: {centre, axes}, axes its local x, y, z in the world. The
// shorter way between the quaternions of two frames, blended and normalised.
export function pose_at({ poses }, moment) {
  const first = poses[Math.min(Math.floor(moment), poses.length - 1)];
  const second = poses[Math.min(Math.floor(moment) + 1, poses.length - 1)];
  const part = moment - Math.floor(moment);
  const cosine = [3, 4, 5, 6].reduce((sum, i) => sum + first[i] * second[i], 0);
  const mixed = first.map((value, i) => {
    const other = i >= 3 && cosine < 0 ? -second[i] : second[i];
    return (1 - part) * value + part * other;
  });
  const length = Math.hypot(...mixed.slice(3));
  const [w, x, y, z] = mixed.slice(3).map((q) => q / length);
  return {
    centre: mixed.slice(0, 3),
    axes: [
      [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
      [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
      [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ],
  };
}
