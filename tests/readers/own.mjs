// What a run wrote for us: its page, its time series, its .hair files.
import { readFileSync, readdirSync } from "node:fs";
import { basename, join } from "node:path";

const bytes = (text) => Buffer.from(text, "base64");

/// The page has positions in 16 bits of their box and channels in 8 bits of their range,
/// radii and times in full; the series has the tip, of strands the mean one, in full.
/// `head`: what h5py read in the file of a head, every strand's own points.
export function read_own(stem, head) {
  const page = JSON.parse(readFileSync(`${stem}.json`, "utf8"));
  const points = page.strand_points.reduce((a, b) => a + b);
  const frames = page.times_s.length;
  const places = bytes(page.positions);
  if (places.length !== 6 * points * frames) throw new Error(`${stem}.json: thinned frames`);
  const quantum = page.low.map((low, c) => (page.high[c] - low) / 65535);
  const decoded = (f) =>
    Array.from({ length: 3 * points }, (_, i) => {
      const u = places.readUInt16LE(2 * (3 * points * f + i));
      return page.low[i % 3] + u * quantum[i % 3];
    });
  const every = (make) => Array.from({ length: frames }, (_, f) => make(f));
  const channels = page.channels.map(({ name, unit, low, high, values }) => {
    const all = bytes(values);
    const step = (high - low) / 255;
    const of_frame = (f) => [...all.subarray(points * f, points * (f + 1))];
    return {
      name,
      unit,
      quantum: step,
      frames: every((f) => of_frame(f).map((u) => low + u * step)),
    };
  });
  const own = {
    times: page.times_s,
    counts: page.strand_points,
    ids: page.strand_ids,
    radii: page.radius_m,
    frames: every(decoded),
    quantum,
    channels,
  };
  if (head) {
    const n = head.points_of_a_strand;
    own.knots = head.frames.map((x) => ({
      points: n,
      of_strand: (k) => x.slice(3 * n * k, 3 * n * (k + 1)),
    }));
  } else {
    const [, ...rows] = readFileSync(`${stem}.csv`, "utf8").trim().split("\n");
    own.tips = rows.map((row) => row.split(",").slice(1, 4).map(Number));
  }
  return own;
}

/// A .hair file after its description by Yuksel; there is no reader of others to install.
function read_frame(folder, file) {
  const data = readFileSync(join(folder, file));
  const [strands, points, arrays, usual_segments] = [4, 8, 12, 16].map((at) =>
    data.readUInt32LE(at),
  );
  if (data.toString("latin1", 0, 4) !== "HAIR" || !(arrays & 2) || arrays & 24) {
    throw new Error(`${file}: not a .hair file with points and without colours`);
  }
  let at = 128;
  const counts = Array.from({ length: strands }, () => {
    if (!(arrays & 1)) return usual_segments + 1;
    return data.readUInt16LE((at += 2) - 2) + 1;
  });
  const floats = (count) => Array.from({ length: count }, () => data.readFloatLE((at += 4) - 4));
  if (data.length !== at + 4 * points * (arrays & 4 ? 4 : 3)) throw new Error(`${file}: its size`);
  const places = floats(3 * points);
  const thickness = arrays & 4 ? floats(points) : Array(points).fill(data.readFloatLE(20));
  const time = Number(/tress: (\S+) s, m, z up/.exec(data.toString("latin1", 40, 128))?.[1]);
  return { file, time, counts, points: places, thickness };
}

export function read_hair(folder) {
  const files = readdirSync(folder).sort();
  return { file: basename(folder), frames: files.map((file) => read_frame(folder, file)) };
}
