// The picture of one moment of a scene on a canvas.
import { contacts_at, draw_arrows, usual_force } from './arrows.mjs';
import { bodies_at, draw_body } from './bodies.mjs';
import { Camera, add, profile_of } from './camera.mjs';
import { bins, page_theme_colours } from './colours.mjs';
import { positions_at } from './data.mjs';
import { Strands } from './strands.mjs';

const samples = 4000;

// Positions (m) of some points of some frames, ends of strands among them.
function some_points(scene) {
  const { points, frames, starts } = scene;
  const frame_stride = Math.ceil(frames / 40);
  const stride = Math.max(1, Math.floor((points * Math.min(frames, 40)) / samples));
  const ends = new Set(starts.map((start) => start - 1));
  const out = [];
  const positions = new Float64Array(3 * points);
  for (let frame = 0; frame < frames; frame += frame_stride) {
    positions_at(scene, frame, positions);
    for (let p = 0; p < points; ++p)
      if (p % stride === 0 || ends.has(p)) out.push([...positions.subarray(3 * p, 3 * p + 3)]);
  }
  return out;
}

// The ends of a body but a plane in every direction, at each of its poses.
const body_points = ({ shape, half_axes_m: half, poses }) => {
  if (shape === 'plane') return [];
  const reach = shape === 'capsule' ? half[0] + half[2] : Math.max(...half);
  return poses.flatMap((pose) =>
    [0, 1, 2].flatMap((i) =>
      [reach, -reach].map((r) => [0, 1, 2].map((k) => pose[k] + (k === i ? r : 0))),
    ),
  );
};

// The middle of all that is shown, planes apart, the radius (m) of a ball about it that
// holds it, and its profile.
function extent(scene) {
  const points = [...some_points(scene), ...scene.bodies.flatMap(body_points)];
  const [least, most] = [Math.min, Math.max].map((of) =>
    [0, 1, 2].map((i) => points.reduce((end, point) => of(end, point[i]), points[0][i])),
  );
  const middle = least.map((l, i) => (l + most[i]) / 2);
  const radius = 0.5 * Math.hypot(...add(most, least, -1)) || 1;
  return { middle, radius, profile: profile_of(points, middle) };
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
    const { middle, radius, profile } = this.extent;
    this.camera = new Camera(middle, radius, profile);
    this.positions = new Float64Array(3 * scene.points);
    this.show_strands(false);
    this.channel = scene.channels[0];
    this.usual_force = usual_force(scene);
    this.arrows = false;
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
    if (this.arrows)
      draw_arrows(context, contacts_at(scene, moment), {
        view,
        usual: this.usual_force,
        radius: this.extent.radius,
        theme,
      });
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
