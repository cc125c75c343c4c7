// Strands on a 2D canvas as WebGL draws them (gl/shaders.mjs): the same colours, coverage and
// order, pixel by pixel.
import { linear, quarter_levels, towards_light } from './light.mjs';
import { Order } from './order.mjs';
import { Pixels } from './pixels.mjs';

export class Strands {
  constructor(curves) {
    this.curves = curves;
    this.order = new Order(curves);
    this.seen = new Float32Array(3 * curves.size); // x, y (pixels), half the width
    this.along = new Float32Array(2 * curves.size); // direction on the picture
    this.lit = new Float32Array(3 * curves.size);
    this.layer = new Uint8Array(curves.size);
    this.pixels = new Pixels();
  }

  // Where the points are on the picture, how they are lit, and the body before which each is
  // hidden (`bodies` from back to front; their number when none hides it).
  see(view, bodies, style) {
    const { points, size } = this.curves;
    const { eye, forward, right, up, scale, width, height } = view;
    const { seen, layer } = this;
    this.count = this.order.sort(view);
    this.width = width;
    this.height = height;
    const point = [0, 0, 0];
    for (let f = 0; f < size; ++f) {
      const x = (point[0] = points[4 * f]) - eye[0];
      const y = (point[1] = points[4 * f + 1]) - eye[1];
      const z = (point[2] = points[4 * f + 2]) - eye[2];
      const depth = this.order.depth[f];
      const factor = scale / depth;
      seen[3 * f] = width / 2 + factor * (x * right[0] + y * right[1] + z * right[2]);
      seen[3 * f + 1] = height / 2 - factor * (x * up[0] + y * up[1] + z * up[2]);
      seen[3 * f + 2] =
        0.5 *
        Math.max(
          style.width * Math.min(2, view.distance / depth),
          style.diameter * factor,
        );
      layer[f] = bodies.length;
      for (let b = 0; b < bodies.length; ++b)
        if (bodies[b].hides(point)) {
          layer[f] = b;
          break;
        }
    }
    this.#direct();
    this.#light(view, style);
  }

  #direct() {
    const { seen, along } = this;
    const { first, last, size } = this.curves;
    for (let f = 0; f < size; ++f) {
      const a = first[f] ? f : f - 1;
      const b = last[f] ? f : f + 1;
      along[2 * f] = seen[3 * b] - seen[3 * a];
      along[2 * f + 1] = seen[3 * b + 1] - seen[3 * a + 1];
    }
  }

  // Kajiya-Kay's diffuse term: the sine of the angle between strand and light, which comes
  // from above and beside the eye; strands far away are mixed with the background.
  #light(view, { ramp, background, radius }) {
    const { points, last, first, size } = this.curves;
    const { distance } = view;
    const [lx, ly, lz] = towards_light(view);
    const colours = new Float32Array(3 * 256);
    for (let i = 0; i < 256; ++i) colours.set(ramp(i / 255), 3 * i);
    for (let f = 0; f < size; ++f) {
      const a = first[f] ? f : f - 1;
      const b = last[f] ? f : f + 1;
      const x = points[4 * b] - points[4 * a];
      const y = points[4 * b + 1] - points[4 * a + 1];
      const z = points[4 * b + 2] - points[4 * a + 2];
      const along = (x * lx + y * ly + z * lz) ** 2 / (x * x + y * y + z * z || 1);
      const bright = 0.72 + 0.28 * Math.max(0, 1 - along);
      const off = (this.order.depth[f] - distance) / radius;
      const mist = 0.2 * Math.max(0, Math.min(2, 1 + off));
      const at = 3 * Math.round(255 * points[4 * f + 3]);
      for (let c = 0; c < 3; ++c) {
        const level = (1 - mist) * bright * colours[at + c] + mist * background[c];
        this.lit[3 * f + c] = quarter_levels[Math.round(4 * level)];
      }
    }
  }

  // Draws what lies in `layer` over the part of the canvas whose left edge is `left` (pixels).
  draw(context, layer, { background, rim, left }) {
    const { width, height } = this;
    const { segments } = this.order;
    const image = context.getImageData(left, 0, width, height);
    const { pixels: picture } = this;
    picture.begin(image.data, width, height, linear(background), rim);
    for (let o = 0; o < this.count; ++o) {
      const f = segments[o];
      if (Math.min(this.layer[f], this.layer[f + 1]) === layer)
        picture.draw(this.seen, this.along, this.lit, f);
    }
    picture.write();
    context.putImageData(image, left, 0);
  }
}
