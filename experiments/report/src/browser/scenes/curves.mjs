// Strands as curves of points, finer than the recording's where there are few: Catmull-Rom
// curves through the recorded points; at the ends the curve goes on as mirrored.

const numbers = 4; // of a point: x, y, z (m) and its part of the colours' range, 0 .. 1
const strand_points = 36; // of a strand with fewer segments, where few strands are drawn
const all_points = 20000; // not many more are made by refining

export class Curves {
  // The first `count` strands of the scene.
  constructor(scene, count) {
    const { starts } = scene;
    const wanted = Math.min(strand_points, all_points / count);
    this.scene = scene;
    this.count = count;
    this.cuts = Array.from({ length: count }, (_, k) =>
      Math.max(1, Math.round(wanted / (scene.strand_points[k] - 1))),
    );
    this.size = this.cuts.reduce(
      (n, cuts, k) => n + cuts * (scene.strand_points[k] - 1) + 1,
      0,
    );
    this.points = new Float32Array(numbers * this.size);
    this.nearest = new Uint32Array(this.size); // the recorded point
    this.strand = new Uint32Array(this.size);
    this.first = new Uint8Array(this.size); // 1: of its strand
    this.last = new Uint8Array(this.size);
    let f = 0;
    for (let k = 0; k < count; ++k) {
      this.first[f] = 1;
      for (let p = starts[k]; p < starts[k + 1]; ++p)
        for (let c = 0; c < (p === starts[k + 1] - 1 ? 1 : this.cuts[k]); ++c, ++f) {
          this.nearest[f] = 2 * c > this.cuts[k] ? p + 1 : p;
          this.strand[f] = k;
        }
      this.last[f - 1] = 1;
    }
  }

  // Curves through `positions`, 3 numbers a recorded point.
  place(positions) {
    const { points } = this;
    const { starts } = this.scene;
    let f = 0;
    for (let k = 0; k < this.count; ++k) {
      const [first, last, cuts] = [starts[k], starts[k + 1] - 1, this.cuts[k]];
      for (let p = first; p <= last; ++p) {
        for (let i = 0; i < 3; ++i) {
          const at = 3 * p + i;
          const p1 = positions[at];
          points[numbers * f + i] = p1;
          if (cuts === 1 || p === last) continue;
          const p2 = positions[at + 3];
          const p0 = p > first ? positions[at - 3] : 2 * p1 - p2;
          const p3 = p + 1 < last ? positions[at + 6] : 2 * p2 - p1;
          for (let c = 1; c < cuts; ++c) {
            const t = c / cuts;
            points[numbers * (f + c) + i] =
              p1 +
              0.5 *
                t *
                (p2 -
                  p0 +
                  t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
          }
        }
        f += p === last ? 1 : cuts;
      }
    }
  }

  // Colours of frame number `frame`: of a channel on the scale `range`, or one a strand.
  colour(channel, frame, range) {
    const { points, nearest, strand, size } = this;
    if (channel === undefined) {
      for (let f = 0; f < size; ++f) points[numbers * f + 3] = scatter(strand[f]);
      return;
    }
    const from = frame * this.scene.points;
    const wide = range.high - range.low || 1;
    const offset = (channel.low - range.low) / wide;
    const factor = (channel.high - channel.low) / wide / 255;
    for (let f = 0; f < size; ++f)
      points[numbers * f + 3] = offset + factor * channel.values[from + nearest[f]];
  }
}

// Deterministic, so that a strand keeps its colour.
const scatter = (k) => ((Math.imul(k + 1, 2654435761) >>> 8) % 256) / 255;
