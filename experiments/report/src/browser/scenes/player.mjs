// Plays a scene: time runs, the picture, the controls and the address follow.
import { format_number } from '../../format.mjs';
import { outcome_text } from '../../outcome.mjs';
import { scene_of_bytes } from '../../packing.mjs';
import { unpacked } from '../unpack.mjs';
import { decode_scene, moment_at, time_at } from './data.mjs';
import { comparable, differences } from './difference.mjs';
import { steer } from './gestures.mjs';
import { Painter } from './gl/painter.mjs';
import { Picture } from './picture.mjs';
import { Series } from './series.mjs';

const at = (id) => document.getElementById(`scene-${id}`);

function caption({ strand_points, guides, dt_s, model, integrator, source, outcome }) {
  const all = strand_points.length;
  const interpolated = all - (guides ?? all);
  const strands =
    interpolated > 0
      ? `${guides} simulated strands, ${interpolated} interpolated`
      : `${all} strand${all === 1 ? '' : 's'}`;
  const step = dt_s === null ? 'adaptive steps' : `dt = ${format_number(dt_s * 1e3)} ms`;
  const origin = source === '' ? '' : ` Source: ${source}`;
  const run = outcome_text(outcome);
  return `${strands}, ${model}, ${integrator}, ${step}.${origin}${run === '' ? '' : ` ${run}`}`;
}

// The drop-down list of what strands may be coloured by: no channel that is 0 everywhere, but
// that of two runs without a difference.
const colour_options = (channels, hair) => [
  ...channels.flatMap(({ name, unit, low, high }, i) =>
    high > low || name === 'difference'
      ? [new Option(unit === '' ? name : `${name} (${unit})`, String(i))]
      : [],
  ),
  ...(hair ? [new Option('as hair in light', 'hair')] : []),
  new Option('one colour a strand', 'strand'),
];

export class Player {
  moment = 0; // frame number, between two frames while time runs
  playing = false;
  full = '';
  #last_tick = undefined;
  #drawing = false;
  #painter = undefined; // null: there is no WebGL

  constructor(texts) {
    this.texts = texts; // name of a scene -> it, packed, read when shown
    this.series = new Series(at('series'), (t) => this.seek(t));
    at('name').addEventListener('change', () => this.open(at('name').value));
    at('beside').replaceChildren(
      new Option('nothing', ''),
      ...[...texts.keys()].map((name) => new Option(name, name)),
    );
    at('beside').addEventListener('change', () =>
      this.open(this.name, at('beside').value, true),
    );
    at('colour').addEventListener('change', () => this.colour(at('colour').value));
    at('strands').addEventListener('change', () => this.show_strands());
    at('forces').addEventListener('change', () => this.show_forces(at('forces').value));
    at('scrub').addEventListener('input', () => this.go_to(Number(at('scrub').value)));
    at('play').addEventListener('click', () => this.play(!this.playing));
    at('loop').addEventListener('change', () => this.changed());
    at('full').addEventListener('click', () => this.fill(this.full === '' ? '1' : ''));
    for (const button of document.querySelectorAll('[data-view]'))
      button.addEventListener('click', () => {
        this.picture.camera.look(button.dataset.view);
        this.changed();
      });
    steer(this, at('canvas'));
    // For films: the picture of a time (s), drawn before the event returns.
    at('canvas').addEventListener('scene-time', ({ detail }) => {
      this.moment = moment_at(this.scene, detail);
      this.#show();
      this.draw();
    });
    const redraw = () => this.draw();
    new ResizeObserver(redraw).observe(at('canvas'));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  }

  #decoded(name) {
    return decode_scene(scene_of_bytes(unpacked(this.texts.get(name))));
  }

  // WebGL's painter, made when a scene is first drawn.
  painter(wanted = true) {
    if (wanted && this.#painter === undefined) this.#painter = Painter.create() ?? null;
    return (wanted && this.#painter) || undefined;
  }

  // The scene, alone or with another next to it; `stay`: at the frame and camera of now.
  open(name, beside = '', stay = false) {
    this.play(false);
    const before = stay ? this.picture?.camera.text() : undefined;
    this.picture?.free();
    this.name = name;
    this.scene = this.#decoded(name);
    const other = beside === '' ? undefined : this.#decoded(beside);
    if (other !== undefined && comparable(this.scene, other))
      differences(this.scene, other).forEach((channel, i) =>
        [this.scene, other][i].channels.push(channel),
      );
    const painter = this.painter(this.drawn_by !== 'canvas');
    this.picture = new Picture(
      at('canvas'),
      other === undefined ? [this.scene] : [this.scene, other],
      { painter, always: this.drawn_by === 'webgl' },
    );
    if (before !== undefined) this.picture.camera.read(before);
    else this.moment = 0;
    const { scene } = this;
    at('name').value = name;
    at('beside').value = beside;
    at('scrub').max = scene.frames - 1;
    at('colour').replaceChildren(
      ...colour_options(scene.channels, painter !== undefined),
    );
    at('forces').parentNode.hidden = this.picture.usual_force === 0;
    at('forces').value = 'hidden';
    at('strands').value = 'all';
    at('strands').parentNode.hidden =
      (scene.guides ?? scene.strand_points.length) === scene.strand_points.length;
    at('caption').textContent = [scene, other]
      .filter((shown) => shown !== undefined)
      .map(caption)
      .join(' Next to it: ');
    at('title').textContent = scene.title;
    at('canvas').dataset.seconds = scene.times_s.at(-1) - scene.times_s[0];
    at('canvas').dataset.start = scene.times_s[0];
    const beside_text = other === undefined ? '' : `, and ${other.title} next to it`;
    at('canvas').setAttribute('aria-label', `${scene.title}${beside_text}, drawn in 3D`);
    const offered = [...at('colour').options].map(({ value }) => value);
    const compared = scene.channels.findIndex(
      ({ name: title }) => title === 'difference',
    );
    this.colour(compared >= 0 ? String(compared) : offered.find((v) => v !== 'hair'));
    this.drawn = this.series.draw(scene, this.time());
    return this.drawn;
  }

  // 'hair', 'strand' or the number of a channel.
  colour(value) {
    const channel = this.scene.channels[value];
    this.picture.colour = channel ?? value;
    at('colour').value = value;
    const bar = at('bar');
    bar.hidden = channel === undefined;
    if (channel !== undefined) {
      const part = (name) => bar.querySelector(`.bar-${name}`);
      const { low, high } = this.picture.range();
      part('name').textContent =
        channel.unit === '' ? channel.name : `${channel.name} (${channel.unit})`;
      part('low').textContent = format_number(low);
      part('high').textContent = format_number(high);
    }
    this.changed();
  }

  show_forces(how) {
    at('forces').value = how;
    this.picture.arrows = how === 'arrows';
    this.changed();
  }

  show_strands() {
    this.picture.show_strands(at('strands').value === 'guides');
    this.changed();
  }

  // '': a part of the page; '1': fills the window; 'picture': does so without controls.
  fill(full) {
    this.full = full;
    const { classList } = document.documentElement;
    classList.toggle('full-scene', full !== '');
    classList.toggle('only-picture', full === 'picture');
    at('full').textContent = full === '' ? 'Fill window' : 'Back to page';
    this.changed();
  }

  play(playing) {
    this.playing = playing;
    at('play').textContent = playing ? 'Pause' : 'Play';
    at('play').setAttribute('aria-pressed', String(playing));
    this.#last_tick = undefined;
    if (!playing) {
      if (this.scene) this.go_to(Math.round(this.moment));
      return;
    }
    if (this.moment >= this.scene.frames - 1) this.go_to(0);
    requestAnimationFrame((now) => this.#tick(now));
  }

  #tick(now) {
    if (!this.playing) return;
    const elapsed = Math.min(0.1, (now - (this.#last_tick ?? now)) / 1000);
    this.#last_tick = now;
    const time = this.time() + elapsed * Number(at('speed').value);
    this.moment = moment_at(this.scene, time);
    if (this.moment >= this.scene.frames - 1) {
      if (!at('loop').checked || this.scene.frames === 1) {
        this.play(false);
        return;
      }
      this.moment = 0;
    }
    this.#show();
    requestAnimationFrame((next) => this.#tick(next));
  }

  time() {
    return time_at(this.scene, this.moment);
  }

  seek(time) {
    this.go_to(Math.round(moment_at(this.scene, time)));
  }

  go_to(frame) {
    this.moment = Math.max(0, Math.min(this.scene.frames - 1, frame));
    this.changed();
  }

  // Something else is to be seen, and the address says what.
  changed() {
    this.#show();
    if (!this.playing) this.write_address();
  }

  #show() {
    const frame = Math.floor(this.moment);
    const { frames } = this.scene;
    at('scrub').value = frame;
    at('scrub').setAttribute('aria-valuetext', `${this.time().toFixed(3)} s`);
    at('time').textContent =
      `${this.time().toFixed(3)} s, frame ${frame} of ${frames - 1}`;
    at('canvas').dataset.frame = frame;
    this.series.mark(this.time());
    if (this.#drawing) return;
    this.#drawing = true;
    requestAnimationFrame(() => {
      this.#drawing = false;
      this.draw();
    });
  }

  draw() {
    const theme = this.picture?.draw(this.moment);
    if (theme) at('bar').querySelector('.bar-ramp').style.background = theme.channel_bar;
  }

  write_address() {
    const address = new URLSearchParams({
      scene: this.name,
      frame: String(Math.floor(this.moment)),
      view: this.picture.camera.text(),
      colour: this.picture.colour.name ?? this.picture.colour,
    });
    if (at('beside').value !== '') address.set('beside', at('beside').value);
    if (at('loop').checked) address.set('loop', '1');
    if (this.drawn_by !== '') address.set('draw', this.drawn_by);
    if (this.picture.arrows) address.set('forces', 'arrows');
    if (at('strands').value !== 'all') address.set('strands', at('strands').value);
    if (this.full !== '') address.set('full', this.full);
    const text = `#${address.toString().replaceAll('%2C', ',')}`;
    if (text !== location.hash) history.replaceState(null, '', text);
  }

  // Opens what an address names; what it does not name stays at its default.
  read_address(hash) {
    const address = new URLSearchParams(hash.replace(/^#/, ''));
    const known = (key) =>
      this.texts.has(address.get(key)) ? address.get(key) : undefined;
    const draw = address.get('draw');
    this.drawn_by = ['canvas', 'webgl'].includes(draw) ? draw : '';
    at('loop').checked = address.get('loop') === '1';
    const drawn = this.open(known('scene') ?? [...this.texts.keys()][0], known('beside'));
    if (address.has('view')) this.picture.camera.read(address.get('view'));
    const colour = address.get('colour');
    const index = this.scene.channels.findIndex(({ name }) => name === colour);
    const value = index >= 0 ? String(index) : colour;
    if ([...at('colour').options].some((option) => option.value === value))
      this.colour(value);
    if (address.get('forces') === 'arrows' && !at('forces').parentNode.hidden)
      this.show_forces('arrows');
    if (address.get('strands') === 'guides' && !at('strands').parentNode.hidden) {
      at('strands').value = 'guides';
      this.show_strands();
    }
    this.fill(address.get('full') ?? '');
    const frame = Number(address.get('frame') ?? 0);
    this.go_to(Number.isSafeInteger(frame) ? frame : 0);
    this.draw();
    return drawn;
  }
}
