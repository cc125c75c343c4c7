// Segments of curves from the back to the front, by the depth of their middles.
const buckets = 4096;

export class Order {
  constructor(curves) {
    this.curves = curves;
    this.depth = new Float32Array(curves.size);
    this.bucket = new Uint16Array(curves.size);
    this.segments = new Uint32Array(curves.size); // by their first points
    this.starts = new Uint32Array(buckets + 1);
  }

  // Returns how many of `segments` are before the eye; those behind it are left out.
  sort({ eye, forward }) {
    const { depth, bucket, segments, starts } = this;
    const { points, last, size } = this.curves;
    const [fx, fy, fz] = forward;
    const offset = eye[0] * fx + eye[1] * fy + eye[2] * fz;
    let [near, far] = [Infinity, 0];
    for (let f = 0; f < size; ++f) {
      const d =
        points[4 * f] * fx + points[4 * f + 1] * fy + points[4 * f + 2] * fz - offset;
      depth[f] = d;
      if (d < near) near = d;
      if (d > far) far = d;
    }
    const factor = (buckets - 1) / (2 * (far - near) || 1);
    const seen = (f) => !last[f] && depth[f] > 0 && depth[f + 1] > 0;
    starts.fill(0);
    for (let f = 0; f < size; ++f) {
      if (!seen(f)) continue;
      bucket[f] = factor * (2 * far - depth[f] - depth[f + 1]);
      ++starts[bucket[f] + 1];
    }
    for (let b = 1; b <= buckets; ++b) starts[b] += starts[b - 1];
    const count = starts[buckets];
    for (let f = 0; f < size; ++f) if (seen(f)) segments[starts[bucket[f]]++] = f;
    return count;
  }
}
