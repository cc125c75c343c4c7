// One scene in its part of the picture, by WebGL or on the 2D canvas.
import { contacts_at, draw_arrows } from './arrows.mjs';
import { bodies_at, draw_body } from './bodies.mjs';
import { Curves } from './curves.mjs';
import { pose_at, positions_at } from './data.mjs';
import { Strands } from './strands.mjs';

export class Pane {
  // `painter`: of gl/painter.mjs, undefined where there is none; `always`: whether it draws
  // also what a software renderer would draw slowly.
  constructor(scene, extent, { painter, always }) {
    this.scene = scene;
    this.extent = extent;
    this.painter = painter;
    this.always = always;
    this.positions = new Float64Array(3 * scene.points);
    this.usual_force = scene.usual_force_n ?? 0;
    this.diameter = 2 * mean(scene.radius_m ?? [0]);
    this.show_strands(false);
  }

  show_strands(guides_only) {
    const all = this.scene.strand_points.length;
    this.free();
    this.curves = new Curves(this.scene, guides_only ? (this.scene.guides ?? all) : all);
    this.strands = undefined;
  }

  free() {
    if (this.curves) this.painter?.forget(this.curves);
  }

  // How the strands are drawn; lengths in CSS pixels.
  style({ colour, theme }, view) {
    const { count } = this.curves;
    return {
      fibres: colour === 'hair',
      // Also where the scene beside has a channel that this one lacks.
      ramp: this.channel_of(colour) === undefined ? theme.hair : theme.channel,
      background: theme.background,
      body: theme.body,
      width: Math.max(1.2, 3.6 - 0.8 * Math.log10(count)),
      // Of the background's colour: shows which of two crossing strands is nearer.
      rim: count <= 4 && colour !== 'hair' ? 0.8 : 0,
      distance: view.distance,
      ...this.extent,
    };
  }

  // `area`: {x, width, height} in CSS pixels; `look`: {colour: 'hair', 'strand' or a
  // channel, range, theme, arrows, ratio}; `camera`: of the whole picture.
  draw(context, area, camera, moment, look) {
    const { scene, curves } = this;
    const view = camera.projection(area.width, area.height);
    const frame = Math.min(Math.floor(moment), scene.frames - 1);
    curves.place(positions_at(scene, moment, this.positions));
    curves.colour(this.channel_of(look.colour), frame, look.range);
    const style = this.style(look, view);
    context.save();
    context.translate(area.x, 0);
    context.beginPath();
    context.rect(0, 0, area.width, area.height);
    context.clip();
    this.drawn_by = this.#by_webgl(style) ? 'webgl' : 'canvas';
    if (this.drawn_by === 'webgl')
      this.#draw_by_webgl(context, area, camera, moment, style, look);
    else this.#draw_on_canvas(context, area, camera, moment, style, look);
    if (look.arrows)
      draw_arrows(context, contacts_at(scene, moment), {
        view,
        usual: look.usual_force,
        radius: this.extent.radius,
        theme: look.theme,
      });
    context.restore();
    return view;
  }

  channel_of(colour) {
    return typeof colour === 'string'
      ? undefined
      : this.scene.channels.find(({ name }) => name === colour.name);
  }

  // A processor that plays the graphics card draws faster without the detour.
  #by_webgl({ fibres }) {
    const { painter, always } = this;
    return painter && !painter.lost && (fibres || always || !painter.software);
  }

  // The camera's view and the style in pixels of the canvas.
  #in_pixels({ width, height }, camera, style, ratio) {
    return [
      camera.projection(Math.round(width * ratio), Math.round(height * ratio)),
      {
        ...style,
        width: style.width * ratio,
        rim: style.rim * ratio,
        diameter: this.diameter,
      },
    ];
  }

  #draw_by_webgl(context, area, camera, moment, style, { ratio }) {
    const bodies = this.scene.bodies.map((body) => ({
      ...body,
      ...pose_at(body, moment),
    }));
    this.painter.draw(
      this.curves,
      bodies,
      ...this.#in_pixels(area, camera, style, ratio),
    );
    context.drawImage(this.painter.canvas, 0, 0, area.width, area.height);
  }

  #draw_on_canvas(context, area, camera, moment, style, { ratio, theme }) {
    this.strands ??= new Strands(this.curves);
    const view = camera.projection(area.width, area.height);
    const bodies = bodies_at(this.scene.bodies, moment, view, this.extent);
    const [pixels, scaled] = this.#in_pixels(area, camera, style, ratio);
    this.strands.see(pixels, bodies, scaled);
    for (let layer = 0; layer <= bodies.length; ++layer) {
      this.strands.draw(context, layer, { ...scaled, left: Math.round(area.x * ratio) });
      if (layer < bodies.length) draw_body(context, bodies[layer], theme);
    }
  }
}

const mean = (list) => list.reduce((sum, x) => sum + x, 0) / list.length;
