// Two runs next to each other, and the difference between them.
import { moment_at, positions_at } from './data.mjs';

const levels = 255;

// Two runs with equal numbers of strands can be subtracted; their numbers of points may differ.
export const comparable = (one, other) =>
  one.strand_points.length === other.strand_points.length;

// Of each point, how far along its strand it lies, 0 .. 1.
function parts_of({ starts, points }, positions) {
  const parts = new Float64Array(points);
  for (let k = 0; k + 1 < starts.length; ++k) {
    for (let p = starts[k] + 1; p < starts[k + 1]; ++p)
      parts[p] =
        parts[p - 1] +
        Math.hypot(
          positions[3 * p] - positions[3 * p - 3],
          positions[3 * p + 1] - positions[3 * p - 2],
          positions[3 * p + 2] - positions[3 * p - 1],
        );
    const length = parts[starts[k + 1] - 1] || 1;
    for (let p = starts[k] + 1; p < starts[k + 1]; ++p) parts[p] /= length;
  }
  return parts;
}

// Distance (m) of each point of `scene` from the place of `other` that lies as far along
// the same strand at the same time.
function distances(scene, other) {
  const { points, frames, times_s, starts } = scene;
  const all = new Float32Array(frames * points);
  const here = new Float64Array(3 * points);
  const there = new Float64Array(3 * other.points);
  for (let frame = 0; frame < frames; ++frame) {
    positions_at(scene, frame, here);
    positions_at(other, moment_at(other, times_s[frame]), there);
    const parts = parts_of(scene, here);
    const other_parts = parts_of(other, there);
    for (let k = 0; k + 1 < starts.length; ++k) {
      let q = other.starts[k];
      for (let p = starts[k]; p < starts[k + 1]; ++p) {
        while (q + 2 < other.starts[k + 1] && other_parts[q + 1] < parts[p]) ++q;
        const wide = other_parts[q + 1] - other_parts[q];
        const t = wide > 0 ? Math.min(1, (parts[p] - other_parts[q]) / wide) : 0;
        const off = [0, 1, 2].map(
          (i) => here[3 * p + i] - (1 - t) * there[3 * q + i] - t * there[3 * q + 3 + i],
        );
        all[frame * points + p] = Math.hypot(...off);
      }
    }
  }
  return all;
}

// The channel of that for both, on one scale.
export function differences(one, other) {
  const both = [distances(one, other), distances(other, one)];
  const high = both.reduce((most, all) => all.reduce((a, b) => Math.max(a, b), most), 0);
  return both.map((all) => ({
    name: 'difference',
    unit: 'm',
    low: 0,
    high,
    values: Uint8Array.from(all, (x) => (high > 0 ? Math.round((levels * x) / high) : 0)),
  }));
}
