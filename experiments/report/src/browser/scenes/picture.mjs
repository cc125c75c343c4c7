// The picture of one moment of a scene on a canvas.
import { bodies_at, draw_body } from './bodies.mjs';
import { Camera, add } from './camera.mjs';
import { bins, page_theme_colours } from './colours.mjs';
import { positions_at } from './data.mjs';
import { Strands } from './strands.mjs';

// The middle of all strands of all frames and all bodies but planes, and a radius that
// fills the picture: 0.85 half diagonals of their box, of which every side shows less.
function extent({ low, high, bodies }) {
  const [least, most] = [[...low], [...high]];
  for (const { shape, half_axes_m: half, poses } of bodies) {
    if (shape === 'plane') continue;
    const reach = shape === 'capsule' ? half[0] + half[2] : Math.max(...half);
    for (const pose of poses) {
      for (let i = 0; i < 3; ++i) {
        least[i] = Math.min(least[i], pose[i] - reach);
        most[i] = Math.max(most[i], pose[i] + reach);
      }
    }
  }
  const middle = least.map((l, i) => (l + most[i]) / 2);
  return { middle, radius: 0.425 * Math.hypot(...add(most, least, -1)) || 1 };
}

// A length of 1, 2 or 5 times a power of ten, not longer than `most`.
function round_length(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return power * [5, 2, 1].find((m) => m * power <= most);
}

const length_text = (metres) => {
  const [factor, unit] =
    metres >= 1 ? [1, 'm'] : metres >= 0.01 ? [100, 'cm'] : [1000, 'mm'];
  return `${Number((metres * factor).toPrecision(3))} ${unit}`;
};

// Deterministic, so that a strand keeps its colour.
const scatter = (k) => (Math.imul(k + 1, 2654435761) >>> 8) % bins;

export class Picture {
  constructor(canvas, scene) {
    this.canvas = canvas;
    this.scene = scene;
    this.extent = extent(scene);
    this.camera = new Camera(this.extent.middle, this.extent.radius);
    this.positions = new Float64Array(3 * scene.points);
    this.show_strands(false);
    this.channel = scene.channels[0];
  }

  show_strands(guides_only) {
    const { guides, strand_points } = this.scene;
    this.strands = new Strands(
      this.scene,
      guides_only ? (guides ?? strand_points.length) : strand_points.length,
    );
  }

  // Pixels of the canvas follow its size on the page; returns the size in CSS pixels.
  fit() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const size = [width, height].map((pixels) => Math.round(pixels * ratio));
    if (this.canvas.width !== size[0]) this.canvas.width = size[0];
    if (this.canvas.height !== size[1]) this.canvas.height = size[1];
    return { width, height, ratio };
  }

  view() {
    return this.camera.projection(this.canvas.clientWidth, this.canvas.clientHeight);
  }

  // Draws the frame number `moment`; returns the colours it used.
  draw(moment) {
    const { width, height, ratio } = this.fit();
    const theme = page_theme_colours();
    if (width === 0 || height === 0) return theme;
    const { scene, strands } = this;
    const view = this.view();
    const context = this.canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const bodies = bodies_at(scene.bodies, moment, view, this.extent);
    const frame = Math.min(Math.floor(moment), scene.frames - 1) * scene.points;
    const colour_of = this.channel
      ? (_, p) => Math.floor((this.channel.values[frame + p] / 256) * bins)
      : scatter;
    strands.curve(positions_at(scene, moment, this.positions), colour_of);
    strands.see(view, bodies);
    strands.sort(bodies.length + 1);
    const style = {
      colours: Array.from({ length: bins }, (_, bin) =>
        (this.channel ? theme.channel : theme.hair)(bin / (bins - 1)),
      ),
      background: theme.background,
      width: Math.max(1.2, 3.6 - 0.8 * Math.log10(strands.count)),
      distance: view.distance,
      radius: this.extent.radius,
    };
    for (let layer = 0; layer <= bodies.length; ++layer) {
      strands.draw(context, layer, style);
      if (layer < bodies.length) draw_body(context, bodies[layer], theme);
    }
    this.draw_scale(context, view, theme);
    return theme;
  }

  // The directions of the axes and a length at the depth of the target.
  draw_scale(context, { right, up, scale, distance, height }, theme) {
    const [x, y, size] = [38, height - 52, 22];
    context.strokeStyle = context.fillStyle = theme.muted;
    context.lineWidth = 1.4;
    context.font = '12px system-ui, sans-serif';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    ['x', 'y', 'z'].forEach((name, i) => {
      const [dx, dy] = [right[i], -up[i]];
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x + size * dx, y + size * dy);
      context.stroke();
      if (Math.hypot(dx, dy) > 0.25)
        context.fillText(name, x + (size + 8) * dx, y + (size + 8) * dy);
    });
    const metre = scale / distance;
    const length = round_length(110 / metre);
    const from = 84;
    context.beginPath();
    context.moveTo(from, height - 26);
    context.lineTo(from, height - 20);
    context.lineTo(from + length * metre, height - 20);
    context.lineTo(from + length * metre, height - 26);
    context.stroke();
    context.textAlign = 'left';
    context.fillText(length_text(length), from, height - 36);
  }
}
