// Pieces of lines on the pixels of an image, blended in linear light.
import { levels, level_steps, quarter_levels } from './light.mjs';

const thin = 0.9; // pixels, half of a width

// The integral of a pixel's hat function up to x.
const up_to = (x) => {
  if (x >= 0) return x >= 1 ? 1 : 0.5 + x - 0.5 * x * x;
  return x <= -1 ? 0 : 0.5 + x + 0.5 * x * x;
};

const level_of = (light) =>
  levels[light < 1 ? (level_steps * light + 0.5) | 0 : level_steps];

export class Pixels {
  light = new Float32Array(0);
  touched = new Uint8Array(0); // 0: `light` is not of this picture yet

  // Of a picture to draw on. `background`: linear, also of what lies `rim` pixels beyond
  // the lines.
  begin(data, width, height, background, rim) {
    this.data = data;
    this.width = width;
    this.height = height;
    this.background = background;
    this.rim = rim;
    if (this.touched.length === width * height) {
      this.touched.fill(0);
      return;
    }
    this.light = new Float32Array(3 * width * height);
    this.touched = new Uint8Array(width * height);
  }

  // The piece from point a to the next. `seen`: x, y, half the width of each point, `along`:
  // the direction there, across which two pieces meet, `lit`: linear colours. It is scanned
  // along its longer direction. Thin pieces meet where a line of pixels ends: the difference
  // would be parts of a pixel.
  draw(seen, along, lit, a) {
    const b = a + 1;
    const steep =
      Math.abs(seen[3 * b + 1] - seen[3 * a + 1]) >= Math.abs(seen[3 * b] - seen[3 * a]);
    const major = steep ? 1 : 0;
    const minor = 1 - major;
    // m along the scan, n across it.
    const am = seen[3 * a + major];
    const an = seen[3 * a + minor];
    const bm = seen[3 * b + major];
    const bn = seen[3 * b + minor];
    if (am === bm) return;
    const { rim, light, touched } = this;
    const [back_red, back_green, back_blue] = this.background;
    const slope = (bn - an) / (bm - am);
    const cosine = 1 / Math.sqrt(1 + slope * slope);
    const widest = Math.max(seen[3 * a + 2], seen[3 * b + 2]);
    const wide = (widest + rim + 1) / cosine;
    const slanting = widest > thin;
    // The ends lie slanting: lines of pixels before and after belong to the piece in part.
    const longer = slanting ? wide * Math.abs(slope) * cosine * cosine : 0;
    const lines = steep ? this.height : this.width;
    const places = steep ? this.width : this.height;
    const line_step = steep ? this.width : 1;
    const place_step = steep ? 1 : this.width;
    const [am_way, an_way] = [along[2 * a + major], along[2 * a + minor]];
    const [bm_way, bn_way] = [along[2 * b + major], along[2 * b + minor]];
    const [a_half, a_red, a_green, a_blue] = [
      seen[3 * a + 2], lit[3 * a], lit[3 * a + 1], lit[3 * a + 2],
    ]; // prettier-ignore
    const more_half = seen[3 * b + 2] - a_half;
    const more_red = lit[3 * b] - a_red;
    const more_green = lit[3 * b + 1] - a_green;
    const more_blue = lit[3 * b + 2] - a_blue;
    const start = Math.max(0, Math.ceil(Math.min(am, bm) - longer - 0.5));
    const end = Math.min(lines, Math.ceil(Math.max(am, bm) + longer - 0.5));
    for (let line = start; line < end; ++line) {
      const m = line + 0.5;
      const t = Math.max(0, Math.min(1, (m - am) / (bm - am)));
      const centre = an + slope * (m - am);
      const half = a_half + t * more_half;
      const red = a_red + t * more_red;
      const green = a_green + t * more_green;
      const blue = a_blue + t * more_blue;
      const last = Math.min(places - 1, Math.floor(centre + wide - 0.5));
      for (let k = Math.max(0, Math.ceil(centre - wide - 0.5)); k <= last; ++k) {
        const n = k + 0.5;
        if (slanting) {
          if ((m - am) * am_way + (n - an) * an_way < 0) continue;
          if ((m - bm) * bm_way + (n - bn) * bn_way >= 0) continue;
        }
        const off = (n - centre) * cosine;
        const inner = up_to(off + half) - up_to(off - half);
        const pixel = line * line_step + k * place_step;
        const i = 3 * pixel;
        if (rim === 0) {
          if (inner === 0) continue;
          if (touched[pixel] === 0) this.#read(pixel);
          light[i] += inner * (red - light[i]);
          light[i + 1] += inner * (green - light[i + 1]);
          light[i + 2] += inner * (blue - light[i + 2]);
          continue;
        }
        const all = up_to(off + half + rim) - up_to(off - half - rim);
        if (all === 0) continue;
        if (touched[pixel] === 0) this.#read(pixel);
        const outer = all - inner;
        light[i] += inner * red + outer * back_red - all * light[i];
        light[i + 1] += inner * green + outer * back_green - all * light[i + 1];
        light[i + 2] += inner * blue + outer * back_blue - all * light[i + 2];
      }
    }
  }

  // A pixel that nothing was drawn on yet shows the background.
  #read(pixel) {
    const { data, light, background } = this;
    this.touched[pixel] = 1;
    const part = data[4 * pixel + 3] / 255;
    for (let c = 0; c < 3; ++c)
      light[3 * pixel + c] =
        part * quarter_levels[4 * data[4 * pixel + c]] + (1 - part) * background[c];
  }

  write() {
    const { data, light, touched } = this;
    for (let pixel = 0, i = 0, j = 0; pixel < touched.length; ++pixel, i += 3, j += 4) {
      if (touched[pixel] === 0) continue;
      data[j] = level_of(light[i]);
      data[j + 1] = level_of(light[i + 1]);
      data[j + 2] = level_of(light[i + 2]);
      data[j + 3] = 255;
    }
  }
}
