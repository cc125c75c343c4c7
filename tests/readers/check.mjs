// Compares what readers say about one run's files with each other and with the run's own.

const tolerance = 1e-6; // of the longest line

const length = ([a, b]) => Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
const point = (x, i) => [x[3 * i], x[3 * i + 1], x[3 * i + 2]];
const ends_of = (counts) => {
  let end = 0;
  return counts.map((count) => (end += count));
};

export function longest(counts, x) {
  let first = 0;
  let most = 0;
  for (const end of ends_of(counts)) {
    let sum = 0;
    for (let i = first; i + 1 < end; i++) sum += length([point(x, i), point(x, i + 1)]);
    most = Math.max(most, sum);
    first = end;
  }
  return most;
}

/// What VTK read, as curves; arrays of points become numbers of lines.
function of_vtk({ pvd, read }) {
  const counts = read.frames[0].ends.map((end, k) => end - (k ? read.frames[0].ends[k - 1] : 0));
  return {
    file: pvd,
    reader: "VTK",
    times: read.times,
    counts,
    frames: read.frames.map((frame) => ({
      ...frame,
      counts: frame.ends.map((end, k) => end - (k ? frame.ends[k - 1] : 0)),
    })),
  };
}

/// Complaints about what Blender found, beside another reading of the same file. It keeps
/// times as frames of its own rate, in floats, and neither radii nor strands of points.
export function check_drawn(found, other, own) {
  const complaints = [];
  const scale = longest(own.counts, own.frames[0]);
  const say = (what) => complaints.push(`${found.file} by Blender: ${what}`);
  if (String(found.counts) !== String(own.counts)) say("points of lines");
  const float = 2 ** -23;
  if (
    found.times.length !== own.times.length ||
    found.times.some((t, f) => !(Math.abs(t - own.times[f]) <= 2 * float * own.times.at(-1)))
  ) {
    say(`times ${found.times}`);
  }
  let off = 0;
  found.frames.forEach(({ points }, f) => {
    const wanted = other.frames[f].points;
    if (points.length !== wanted.length) return say(`frame ${f}: ${points.length / 3} points`);
    points.forEach((x, i) => (off = Math.max(off, Math.abs(x - wanted[i]) / scale)));
  });
  if (!(off <= tolerance)) say(`a point is ${off} of the length off ${other.reader}'s`);
  if (!(found.covered > 1e-3 && found.covered < 0.9)) say("its picture shows no lines");
  return { complaints, figures: { off } };
}

/// Complaints about the readings of a run, and figures: the largest distance over the
/// longest line between readers, from the run's own points, and from the page's.
export function check({ own, vtk, usd, hair, gltf }) {
  const complaints = [];
  const say = (file, what) => complaints.push(`${file}: ${what}`);
  const figures = { readers: 0, own: 0, page: 0 };
  for (const part of [vtk.read, usd, hair, gltf]) if (part.error) complaints.push(part.error);
  if (complaints.length) return { complaints, figures };

  const scale = longest(own.counts, own.frames[0]);
  const close = (a, b, rel = tolerance) => Math.abs(a - b) <= rel * Math.abs(b);
  const same_time = (a, b) => Math.abs(a - b) <= 1e-9 * own.times.at(-1);
  const first_unlike = (a, b, like) => {
    if (a?.length !== b.length) return `${a?.length} instead of ${b.length} numbers`;
    const i = b.findIndex((x, k) => !like(a[k], x));
    return i < 0 ? "" : `${a[i]} instead of ${b[i]} (number ${i})`;
  };
  const expect = (file, name, a, b, like) => {
    const unlike = first_unlike(a, b, like);
    if (unlike) say(file, `${name}: ${unlike}`);
  };
  const exactly = (a, b) => a === b;
  const radii = own.radii ?? own.counts.map(() => undefined);
  const each = (of_line) => own.counts.flatMap((n, k) => Array(n).fill(of_line[k]));

  // Of one reading of one frame.
  const check_points = (file, frame, x) => {
    const paged = own.frames[frame];
    if (x.length !== paged.length)
      return say(file, `${x.length / 3} points, not ${paged.length / 3}`);
    for (let i = 0; i < x.length; i++) {
      const away = Math.abs(x[i] - paged[i]);
      figures.page = Math.max(figures.page, away / own.quantum[i % 3] || 0);
      if (!(away <= own.quantum[i % 3] / 2 + tolerance * scale)) {
        return say(
          file,
          `point ${Math.floor(i / 3)} is ${away / scale} of the length off the page's`,
        );
      }
    }
    if (own.knots) check_knots(file, own.knots[frame], x);
    if (own.tips) {
      const tips = ends_of(own.counts).map((end) => point(x, end - 1));
      const mean = [0, 1, 2].map((c) => tips.reduce((sum, tip) => sum + tip[c], 0) / tips.length);
      // Of a tree it is the end of a line.
      const ends = own.ids ? [mean] : tips;
      const away = Math.min(...ends.map((end) => length([end, own.tips[frame]]) / scale));
      figures.own = Math.max(figures.own, away);
      if (!(away <= tolerance)) say(file, `its tip is ${away} of the length off the series'`);
    }
    const base = hair.frames[frame].points;
    for (let i = 0; 3 * i < x.length; i++) {
      const away = length([point(x, i), point(base, i)]) / scale;
      figures.readers = Math.max(figures.readers, away);
      if (!(away <= tolerance)) {
        return say(file, `point ${i} is ${away} of the length off ${hair.frames[frame].file}`);
      }
    }
  };

  // The run's own points lie in this order on the exported line, its ends are theirs.
  const check_knots = (file, { of_strand, points }, x) => {
    let first = 0;
    for (const [k, end] of ends_of(own.counts).entries()) {
      let i = first;
      for (let knot = 0; knot < points; knot++) {
        const at = point(of_strand(own.ids[k]), knot);
        const left = knot === 0 ? i : knot === points - 1 ? end - 1 : undefined;
        let nearest = Infinity;
        for (i = left ?? i; i < (left === undefined ? end : left + 1); i++) {
          const away = length([point(x, i), at]) / scale;
          nearest = Math.min(nearest, away);
          if (away <= tolerance) break;
        }
        if (!(nearest <= tolerance)) {
          const where = `point ${knot} of strand ${own.ids[k]}`;
          return say(file, `${where} is ${nearest} of the length off the run's own`);
        }
        figures.own = Math.max(figures.own, nearest);
      }
      first = end;
    }
  };

  for (const [f, { file, points, time, thickness, counts }] of hair.frames.entries()) {
    expect(file, "points of lines", counts, own.counts, exactly);
    expect(file, "time", [time], [own.times[f]], same_time);
    if (own.radii) {
      expect(file, "thickness", thickness, each(own.radii.map((r) => 2 * r)), close);
    }
    check_points(file, f, points);
  }
  if (hair.frames.length !== own.times.length) say(hair.file, `${hair.frames.length} frames`);
  if (complaints.length) return { complaints, figures };

  const seen = of_vtk(vtk);
  expect(seen.file, "times", seen.times, own.times, same_time);
  for (const [f, frame] of seen.frames.slice(0, own.times.length).entries()) {
    expect(frame.file, "points of lines", frame.counts, own.counts, exactly);
    expect(frame.file, "time", [frame.time], [own.times[f]], same_time);
    check_points(frame.file, f, frame.points);
    if (own.radii) {
      expect(frame.file, "radius", frame.arrays["radius [m]"], each(radii), close);
      expect(frame.file, "strand", frame.arrays.strand, each(own.ids), exactly);
    }
    for (const { name, unit, frames, quantum } of own.channels) {
      const near = (a, b) => Math.abs(a - b) <= quantum * (0.5 + 1e-4);
      expect(frame.file, name, frame.arrays[`${name} [${unit}]`], frames[f], near);
    }
  }

  for (const reading of usd) {
    const file = `${reading.file} by ${reading.reader}`;
    expect(file, "times", reading.times, own.times, same_time);
    expect(file, "endTimeCode", [reading.ends], [own.times.at(-1)], same_time);
    expect(file, "curveVertexCounts", reading.counts, own.counts, exactly);
    if (!reading.upright) say(file, "upAxis or metersPerUnit");
    if (reading.interpolation !== (own.radii ? "uniform" : "constant")) {
      say(file, `interpolation ${reading.interpolation} of widths`);
    }
    const widths = own.radii?.map((r) => 2 * r) ?? [0.002];
    expect(file, "widths", reading.widths, widths, close);
    if (own.radii) expect(file, "strand", reading.ids, own.ids, exactly);
    for (const [f, { points, extent }] of reading.frames.slice(0, own.times.length).entries()) {
      check_points(`${file}, frame ${f}`, f, points);
      const margin = Math.max(...widths) / 2;
      const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
      points.forEach((x, i) => {
        box[i % 3] = Math.min(box[i % 3], x - margin);
        box[3 + (i % 3)] = Math.max(box[3 + (i % 3)], x + margin);
      });
      const near = (a, b) => Math.abs(a - b) <= tolerance * scale;
      expect(`${file}, frame ${f}`, "extent", extent, box, near);
    }
  }
  for (const reading of gltf) {
    const file = `${reading.file} by ${reading.reader}`;
    // Its times are floats.
    expect(file, "times", reading.times, own.times.map(Math.fround), exactly);
    expect(file, "points of lines", reading.counts, own.counts, exactly);
    if (own.radii) {
      expect(file, "radius", reading.radius, each(radii), close);
      expect(file, "strand", reading.strand, each(own.ids), exactly);
    }
    for (const [f, { points }] of reading.frames.slice(0, own.times.length).entries()) {
      check_points(`${file}, frame ${f}`, f, points);
    }
    if (!reading.channels) continue;
    for (const { name, unit, frames, quantum } of own.channels) {
      // The page's step, and the rounding of differences of floats.
      const near = (a, b) => Math.abs(a - b) <= quantum * (0.5 + 1e-4);
      for (const [f, values] of frames.entries()) {
        const found = reading.channels[`${name} [${unit}]`]?.[f];
        expect(`${file}, frame ${f}`, name, found, values, near);
      }
    }
  }
  return { complaints, figures };
}
