// Scenes as bytes that compress well, and back: what a picture of `levels` pixels can show.
//
// Positions lie on a grid of the longest side of the box over `levels`, and are stored as
// differences from what their neighbours in time and along the strand say; channels have
// 64 levels, less than the colours of their ramp; numbers of the time series are rounded to
// a part of 4096 of their range. Whatever needs more reads results/scenes/.
import { bytes_of_contacts, contacts_of_bytes } from './contact_packing.mjs';

export const page_levels = 4096;
export const most_levels = 65535;
const channel_levels = 63;
const series_levels = 4096;
const header_bytes = 4; // of the text's length, little endian

// Small numbers of either sign as small words without one.
export const folded = (d) => ((d << 1) ^ (d >> 31)) & 65535;
export const unfolded = (z) => (z >>> 1) ^ -(z & 1);

// Weights of extrapolation from 0, 1, 2 values before.
const orders = [[], [1], [2, -1]];

// Calls `each(frame, i, expected, k)` for every value of `grid`, `width` of them a point and
// those of one kind together; `k` counts. `expected`: by `time` frames before, and as the `along` points
// before on the strand were off that, so is this one.
function predicted(grid, { frames, strand_points, width, time, along }, each) {
  const frame_size = width * strand_points.reduce((sum, n) => sum + n, 0);
  let k = 0;
  for (let c = 0; c < width; ++c)
    for (let frame = 0; frame < frames; ++frame) {
      const before = orders[Math.min(time, frame)];
      const by_time = (at) => {
        let sum = 0;
        for (let j = 0; j < before.length; ++j)
          sum += before[j] * grid[at - (j + 1) * frame_size];
        return sum;
      };
      let i = c;
      for (const n of strand_points)
        for (let p = 0; p < n; ++p, i += width) {
          const at = frame * frame_size + i;
          const weights = orders[Math.min(along, p)];
          let expected = by_time(at);
          for (let j = 0; j < weights.length; ++j) {
            const other = at - (j + 1) * width;
            expected += weights[j] * (grid[other] - by_time(other));
          }
          each(at, expected, k++);
        }
    }
}

// The orders of extrapolation that leave the fewest bits.
function best_orders(grid, shape, offered) {
  const bits = offered.map(([time, along]) => {
    let sum = 0;
    predicted(grid, { ...shape, time, along }, (at, expected) => {
      sum += Math.log2(1 + Math.abs(grid[at] - expected));
    });
    return sum;
  });
  return offered[bits.indexOf(Math.min(...bits))];
}

const position_orders = [[1, 1], [1, 2], [2, 1], [2, 2]]; // prettier-ignore
const channel_orders = [[0, 1], [0, 2], [1, 0], [1, 1]]; // prettier-ignore

// Positions (words over the box) as numbers of the grid, and the grid's factor on each axis.
function factors_of({ low, high }, levels) {
  const sides = high.map((x, i) => x - low[i]);
  const longest = Math.max(...sides);
  return sides.map((side) => (longest > 0 ? (side / longest) * (levels / 65535) : 0));
}

// Numbers of a column to the decimals that its range needs.
function rounded_series({ columns, rows }) {
  const values = columns.map((_, c) => {
    const column = rows.map((row) => row[c]);
    const known = column.filter((value) => value !== null);
    const range =
      known.reduce((a, b) => Math.max(a, b), -Infinity) -
      known.reduce((a, b) => Math.min(a, b), Infinity);
    const unit = range > 0 ? 10 ** Math.ceil(Math.log10(series_levels / range)) : 0;
    const exact = unit === 0 || !Number.isFinite(unit);
    return column.map((value) =>
      value === null || exact ? value : Math.round(value * unit) / unit,
    );
  });
  return { columns, values };
}
const rows_of_series = ({ columns, values }) => ({
  columns,
  rows: values[0].map((_, r) => values.map((column) => column[r])),
});

// `scene`: as data.mjs decodes it, positions and values as arrays.
export function bytes_of_scene(
  { positions, channels, contacts, series, ...rest },
  levels = page_levels,
) {
  const shape = { frames: rest.times_s.length, strand_points: rest.strand_points };
  const factors = factors_of(rest, levels);
  const grid = Int32Array.from(positions, (word, i) => Math.round(word * factors[i % 3]));
  const coarse = channels.map(({ values }) =>
    Int32Array.from(values, (v) => Math.round((v * channel_levels) / 255)),
  );
  const points = { ...shape, width: 3 };
  const values = { ...shape, width: 1 };
  const by = best_orders(grid, points, position_orders);
  const channels_by = coarse.map((one) => best_orders(one, values, channel_orders));
  const seen = bytes_of_contacts(contacts, rest);
  const header = {
    ...rest,
    levels,
    orders: by,
    series: rounded_series(series),
    contacts: seen?.header,
    channels: channels.map(({ values: _, ...channel }, i) => ({
      ...channel,
      orders: channels_by[i],
    })),
  };
  const text = new TextEncoder().encode(JSON.stringify(header));
  const low = header_bytes + text.length;
  const at_channels = low + 2 * grid.length;
  const at_contacts = at_channels + coarse.reduce((sum, one) => sum + one.length, 0);
  const out = new Uint8Array(at_contacts + (seen?.bytes.length ?? 0));
  new DataView(out.buffer).setUint32(0, text.length, true);
  out.set(text, header_bytes);
  predicted(grid, { ...points, time: by[0], along: by[1] }, (at, expected, k) => {
    const word = folded(((grid[at] - expected) << 16) >> 16);
    out[low + k] = word & 255;
    out[low + grid.length + k] = word >> 8;
  });
  coarse.reduce((start, one, i) => {
    const [time, along] = channels_by[i];
    predicted(one, { ...values, time, along }, (at, expected, k) => {
      out[start + k] = folded(((one[at] - expected) << 24) >> 24);
    });
    return start + one.length;
  }, at_channels);
  if (seen !== undefined) out.set(seen.bytes, at_contacts);
  return out;
}

export function scene_of_bytes(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const low = header_bytes + view.getUint32(0, true);
  const {
    levels,
    orders: by,
    contacts,
    series,
    channels,
    ...rest
  } = JSON.parse(new TextDecoder().decode(bytes.subarray(header_bytes, low)));
  const shape = { frames: rest.times_s.length, strand_points: rest.strand_points };
  const points = rest.strand_points.reduce((sum, n) => sum + n, 0) * shape.frames;
  // Differences wrap at 16 bits: so do the numbers of the grid, which are all positive.
  const grid = new Uint16Array(3 * points);
  predicted(
    grid,
    { ...shape, width: 3, time: by[0], along: by[1] },
    (at, expected, k) => {
      grid[at] =
        expected + unfolded(bytes[low + k] | (bytes[low + grid.length + k] << 8));
    },
  );
  const factors = factors_of(rest, levels);
  const positions = grid.map((n, i) =>
    factors[i % 3] > 0 ? Math.min(65535, Math.round(n / factors[i % 3])) : 0,
  );
  let start = low + 2 * grid.length;
  const decoded = channels.map(({ orders: [time, along], ...channel }) => {
    const one = new Uint8Array(points);
    predicted(one, { ...shape, width: 1, time, along }, (at, expected, k) => {
      one[at] = expected + unfolded(bytes[start + k]);
    });
    start += points;
    return { ...channel, values: one.map((n) => Math.round((n * 255) / channel_levels)) };
  });
  const seen = contacts && contacts_of_bytes(bytes.subarray(start), contacts, rest);
  return {
    ...rest,
    ...seen,
    series: rows_of_series(series),
    positions,
    channels: decoded,
  };
}
