// Strands on a 2D canvas, drawn from the back to the front: pieces of curves of one place
// in the order and one colour are stroked together.
import { bins, css, mix } from './colours.mjs';

const slices = 14; // of depth
const shades = 4;

export class Strands {
  constructor(curves) {
    this.curves = curves;
    const fine = curves.size;
    this.x = new Float32Array(fine);
    this.y = new Float32Array(fine);
    this.depth = new Float32Array(fine);
    this.layer = new Uint8Array(fine);
    this.shade = new Uint8Array(fine);
    this.key = new Int32Array(fine);
    this.order = new Int32Array(fine);
    this.fine = fine;
  }

  // Places on the picture, the body before which each point is hidden (`bodies` from back
  // to front; their number when none hides it), and light by the direction of the strand.
  see(view, bodies) {
    const { eye, forward, right, up, scale, width, height } = view;
    const point = [0, 0, 0];
    const from = [0, 0, 0];
    for (let f = 0; f < this.fine; ++f) {
      for (let i = 0; i < 3; ++i) {
        point[i] = this.curves.points[4 * f + i];
        from[i] = point[i] - eye[i];
      }
      const depth = from[0] * forward[0] + from[1] * forward[1] + from[2] * forward[2];
      const factor = scale / depth;
      this.depth[f] = depth;
      this.x[f] =
        width / 2 +
        factor * (from[0] * right[0] + from[1] * right[1] + from[2] * right[2]);
      this.y[f] =
        height / 2 - factor * (from[0] * up[0] + from[1] * up[1] + from[2] * up[2]);
      const layer = bodies.findIndex((body) => body.hides(point));
      this.layer[f] = layer < 0 ? bodies.length : layer;
    }
    this.light(view);
  }

  // Kajiya-Kay's diffuse term: the sine of the angle between strand and light, which comes
  // from above and beside the eye.
  light({ forward, right, up }) {
    const light = [0, 1, 2].map((i) => 0.5 * up[i] - 0.4 * right[i] - 0.77 * forward[i]);
    const { points, last } = this.curves;
    for (let f = 0; f < this.fine; ++f) {
      if (last[f]) {
        this.shade[f] = this.shade[f - 1];
        continue;
      }
      let [along, length] = [0, 0];
      for (let i = 0; i < 3; ++i) {
        const d = points[4 * f + 4 + i] - points[4 * f + i];
        along += d * light[i];
        length += d * d;
      }
      const sine = Math.sqrt(Math.max(0, 1 - (along * along) / (length || 1)));
      this.shade[f] = Math.min(shades - 1, Math.floor(sine * sine * shades));
    }
  }

  // Pieces in the order in which they are drawn: layer, slice from far to near, colour.
  sort(layers) {
    const { points, last } = this.curves;
    let [near, far] = [Infinity, 0];
    for (let f = 0; f < this.fine; ++f) {
      near = Math.min(near, this.depth[f]);
      far = Math.max(far, this.depth[f]);
    }
    const starts = new Int32Array(layers * slices * bins * shades + 1);
    for (let f = 0; f < this.fine; ++f) {
      this.key[f] = -1;
      if (last[f] || this.depth[f] <= 0 || this.depth[f + 1] <= 0) continue;
      const part = (far - this.depth[f]) / (far - near || 1);
      const slice = Math.min(slices - 1, Math.floor(part * slices));
      const layer = Math.min(this.layer[f], this.layer[f + 1]);
      const bin = Math.min(bins - 1, Math.floor(points[4 * f + 3] * bins));
      this.key[f] = ((layer * slices + slice) * bins + bin) * shades + this.shade[f];
      ++starts[this.key[f] + 1];
    }
    for (let k = 1; k < starts.length; ++k) starts[k] += starts[k - 1];
    const next = starts.slice();
    for (let f = 0; f < this.fine; ++f)
      if (this.key[f] >= 0) this.order[next[this.key[f]]++] = f;
    this.starts = starts;
    this.slice_depth = (slice) => far - ((slice + 0.5) / slices) * (far - near);
  }

  trace(context, from, to) {
    context.beginPath();
    let previous = -2;
    for (let o = from; o < to; ++o) {
      const f = this.order[o];
      if (f !== previous + 1) context.moveTo(this.x[f], this.y[f]);
      context.lineTo(this.x[f + 1], this.y[f + 1]);
      previous = f;
    }
    context.stroke();
  }

  // What lies in `layer`. `colours`: rgb of each bin; strands far away fade.
  draw(context, layer, { colours, background, width, rim, distance, radius }) {
    context.lineCap = 'round';
    context.lineJoin = 'round';
    for (let slice = 0; slice < slices; ++slice) {
      const first = (layer * slices + slice) * bins * shades;
      const here = [first, first + bins * shades].map((key) => this.starts[key]);
      if (here[0] === here[1]) continue;
      const depth = this.slice_depth(slice);
      const thick = width * Math.min(2, distance / depth);
      const fog = 0.2 * Math.max(0, Math.min(2, 1 + (depth - distance) / radius));
      // A rim of the background's colour shows which of two crossing strands is nearer.
      if (rim > 0) {
        context.lineCap = 'butt';
        context.strokeStyle = css(background);
        context.lineWidth = thick + rim;
        this.trace(context, ...here);
        context.lineCap = 'round';
      }
      context.lineWidth = thick;
      for (let bin = 0; bin < bins; ++bin) {
        for (let shade = 0; shade < shades; ++shade) {
          const key = first + bin * shades + shade;
          const [from, to] = [this.starts[key], this.starts[key + 1]];
          if (from === to) continue;
          const light = 0.72 + 0.28 * (shade / (shades - 1));
          const lit = colours[bin].map((c) => c * light);
          context.strokeStyle = css(mix(lit, background, fog));
          this.trace(context, from, to);
        }
      }
    }
  }
}
