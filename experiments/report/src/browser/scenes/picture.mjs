// The picture of one moment of a scene, or of two next to each other, on a canvas.
import { Camera } from './camera.mjs';
import { page_theme_colours } from './colours.mjs';
import { moment_at, time_at } from './data.mjs';
import { extent_of } from './extent.mjs';
import { Pane } from './pane.mjs';

const names_below = 84; // CSS pixels: under the title and the bar of colours

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

export class Picture {
  // `scenes`: one, or two that share the camera, the scale of colours and the time; `by`: as
  // Pane takes it; `extent`: what the picture holds.
  constructor(canvas, scenes, by, extent = extent_of(scenes)) {
    this.canvas = canvas;
    this.scenes = scenes;
    this.extent = extent;
    const { middle, radius, profile } = this.extent;
    this.camera = new Camera(middle, radius, profile);
    this.panes = scenes.map((scene) => new Pane(scene, this.extent, by));
    this.colour = 'strand'; // or 'hair', or a channel of the first scene
    this.usual_force = Math.max(...this.panes.map((pane) => pane.usual_force));
    this.arrows = false;
    this.reads = by.painter === undefined || by.painter.software; // pixels back from the canvas
  }

  free() {
    this.panes.forEach((pane) => pane.free());
  }

  show_strands(guides_only) {
    this.panes.forEach((pane) => pane.show_strands(guides_only));
  }

  // {low, high} of the colours: of the chosen channel in all that is shown.
  range() {
    const channels = this.panes
      .map((pane) => pane.channel_of(this.colour))
      .filter(Boolean);
    return {
      low: Math.min(...channels.map(({ low }) => low)),
      high: Math.max(...channels.map(({ high }) => high)),
    };
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
    return this.camera.projection(
      this.canvas.clientWidth / this.panes.length,
      this.canvas.clientHeight,
    );
  }

  // Draws the frame number `moment` of the first scene; returns the colours it used.
  draw(moment) {
    const { width, height, ratio } = this.fit();
    const theme = page_theme_colours();
    if (width === 0 || height === 0) return theme;
    const context = this.canvas.getContext('2d', { willReadFrequently: this.reads });
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const { panes, colour, arrows, usual_force } = this;
    const look = { colour, range: this.range(), theme, arrows, usual_force, ratio };
    const time = time_at(this.scenes[0], moment);
    // Whole pixels of the canvas.
    const area = { width: Math.round((width * ratio) / panes.length) / ratio, height };
    panes.forEach((pane, i) => {
      const here = i === 0 ? moment : moment_at(pane.scene, time);
      pane.draw(context, { ...area, x: i * area.width }, this.camera, here, look);
    });
    this.canvas.dataset.drawn = panes[0].drawn_by;
    if (panes.length > 1) this.#draw_names(context, area, theme);
    this.#draw_scale(context, this.view(), theme);
    return theme;
  }

  #draw_names(context, { width, height }, theme) {
    context.font = '13px system-ui, sans-serif';
    context.textAlign = 'left';
    context.textBaseline = 'alphabetic';
    context.fillStyle = theme.text;
    context.strokeStyle = theme.muted;
    context.lineWidth = 1;
    this.scenes.forEach(({ scene, model, integrator }, i) =>
      context.fillText(
        `${scene}: ${model}, ${integrator}`,
        i * width + 10,
        names_below,
        width - 20,
      ),
    );
    context.beginPath();
    context.moveTo(Math.round(width) + 0.5, 0);
    context.lineTo(Math.round(width) + 0.5, height);
    context.stroke();
  }

  // The directions of the axes and a length at the depth of the target.
  #draw_scale(context, { right, up, scale, distance, height }, theme) {
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
