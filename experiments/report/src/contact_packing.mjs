// Forces of contacts and supports as bytes, and back: what arrows of them show. A place lies
// on a grid of the longest side of the scene's box over 1024, a force is rounded to a part of
// 128 of the usual one, whose arrow is a sixth of the scene's radius; forces that are rounded
// to nothing are left out. The order within a frame is by x.
import { folded, unfolded } from './packing.mjs';

const numbers = 6; // of a contact: place and force
const place_levels = 1024;
const force_levels = 128;
const most_force = 32767;
const usual_part = 0.95; // of all forces of a scene are not larger than the usual one

const size = (force) => Math.hypot(...force);
const step_of = ({ low, high }) =>
  Math.max(...high.map((x, i) => x - low[i])) / place_levels;

const split = (flat) =>
  Array.from({ length: flat.length / numbers }, (_, i) => ({
    place: flat.slice(numbers * i, numbers * i + 3),
    force: flat.slice(numbers * i + 3, numbers * (i + 1)),
  }));

// The force (N) that few of a scene exceed.
export function usual_force(frames) {
  const sizes = frames
    .flatMap((flat) => split(flat).map(({ force }) => size(force)))
    .sort((a, b) => a - b);
  return sizes[Math.floor(usual_part * (sizes.length - 1))] ?? 0;
}

// {header, bytes}; undefined where nothing was recorded.
export function bytes_of_contacts(frames, box) {
  if (frames === undefined) return undefined;
  const usual = usual_force(frames);
  const step = step_of(box);
  const rounded = frames.map((flat) =>
    split(usual > 0 ? flat : [])
      .map(({ place, force }) => {
        const units = force.map((f) => (f / usual) * force_levels);
        const kept = Math.min(1, most_force / size(units));
        return [
          ...place.map((x, i) => Math.round((x - box.low[i]) / step)),
          ...units.map((u) => Math.round(u * kept)),
        ];
      })
      .filter((contact) => contact.slice(3).some((u) => u !== 0))
      .sort((a, b) => a[0] - b[0]),
  );
  const count = rounded.reduce((sum, one) => sum + one.length, 0);
  const bytes = new Uint8Array(2 * numbers * count);
  let k = 0;
  for (let c = 0; c < numbers; ++c)
    for (const one of rounded)
      one.forEach((contact, i) => {
        const before = c === 0 && i > 0 ? one[i - 1][0] : 0;
        const word = folded(contact[c] - before);
        bytes[k] = word & 255;
        bytes[numbers * count + k++] = word >> 8;
      });
  return { header: { usual_n: usual, counts: rounded.map((one) => one.length) }, bytes };
}

// {contacts, usual_force_n}.
export function contacts_of_bytes(bytes, { usual_n, counts }, box) {
  const count = counts.reduce((sum, n) => sum + n, 0);
  const step = step_of(box);
  const contacts = counts.map((n) => new Array(numbers * n));
  let k = 0;
  for (let c = 0; c < numbers; ++c)
    for (const flat of contacts) {
      let before = 0;
      for (let at = c; at < flat.length; at += numbers) {
        const value = before + unfolded(bytes[k] | (bytes[numbers * count + k] << 8));
        ++k;
        if (c === 0) before = value;
        flat[at] = c < 3 ? box.low[c] + step * value : (usual_n / force_levels) * value;
      }
    }
  return { contacts, usual_force_n: usual_n };
}
