// Plays a scene: time runs, the picture, the controls and the address follow.
import { format_number } from '../../format.mjs';
import { outcome_text } from '../../outcome.mjs';
import { decode_scene } from './data.mjs';
import { steer } from './gestures.mjs';
import { Picture } from './picture.mjs';
import { Series } from './series.mjs';

const at = (id) => document.getElementById(`scene-${id}`);
const no_channel = 'strand';

function caption({ strand_points, guides, dt_s, model, integrator, source, outcome }) {
  const all = strand_points.length;
  const interpolated = all - (guides ?? all);
  const strands =
    interpolated > 0
      ? `${guides} simulated strands, ${interpolated} interpolated`
      : `${all} strand${all === 1 ? '' : 's'}`;
  const step =
    dt_s === null ? 'adaptive steps' : `dt = ${format_number(dt_s * 1e3)} ms`;
  const origin = source === '' ? '' : ` Source: ${source}`;
  const run = outcome_text(outcome);
  return `${strands}, ${model}, ${integrator}, ${step}.${origin}${run === '' ? '' : ` ${run}`}`;
}

export class Player {
  moment = 0; // frame number, between two frames while time runs
  playing = false;
  full = '';
  #last_tick = undefined;
  #drawing = false;

  constructor(texts) {
    this.texts = texts; // name of a scene -> its JSON, read when shown
    this.series = new Series(at('series'), (t) => this.seek(t));
    at('name').addEventListener('change', () => this.open(at('name').value));
    at('colour').addEventListener('change', () => this.colour(at('colour').value));
    at('strands').addEventListener('change', () => this.show_strands());
    at('forces').addEventListener('change', () => this.show_forces(at('forces').value));
    at('scrub').addEventListener('input', () => this.go_to(Number(at('scrub').value)));
    at('play').addEventListener('click', () => this.play(!this.playing));
    at('full').addEventListener('click', () => this.fill(this.full === '' ? '1' : ''));
    for (const button of document.querySelectorAll('[data-view]'))
      button.addEventListener('click', () => {
        this.picture.camera.look(button.dataset.view);
        this.changed();
      });
    steer(this, at('canvas'));
    const redraw = () => this.draw();
    new ResizeObserver(redraw).observe(at('canvas'));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  }

  open(name) {
    this.play(false);
    this.name = name;
    this.scene = decode_scene(JSON.parse(this.texts.get(name)));
    this.picture = new Picture(at('canvas'), this.scene);
    this.moment = 0;
    const { scene } = this;
    at('name').value = name;
    at('scrub').max = scene.frames - 1;
    at('colour').replaceChildren(
      ...scene.channels.map(
        (channel, i) =>
          new Option(
            `${channel.name}${channel.unit === '' ? '' : ` (${channel.unit})`}`,
            String(i),
          ),
      ),
      new Option('one colour a strand', no_channel),
    );
    at('forces').parentNode.hidden = this.picture.usual_force === 0;
    at('forces').value = 'hidden';
    at('strands').value = 'all';
    at('strands').parentNode.hidden =
      (scene.guides ?? scene.strand_points.length) === scene.strand_points.length;
    at('caption').textContent = caption(scene);
    at('title').textContent = scene.title;
    at('canvas').setAttribute('aria-label', `${scene.title}, drawn in 3D`);
    this.colour(scene.channels.length > 0 ? '0' : no_channel);
    this.drawn = this.series.draw(scene, scene.times_s[0]);
    return this.drawn;
  }

  colour(value) {
    const channel = value === no_channel ? undefined : this.scene.channels[Number(value)];
    this.picture.channel = channel;
    at('colour').value = value;
    const bar = at('bar');
    bar.hidden = channel === undefined;
    if (channel !== undefined) {
      const part = (name) => bar.querySelector(`.bar-${name}`);
      part('name').textContent =
        channel.unit === '' ? channel.name : `${channel.name} (${channel.unit})`;
      part('low').textContent = format_number(channel.low);
      part('high').textContent = format_number(channel.high);
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
    this.moment = this.moment_of(time);
    if (this.moment >= this.scene.frames - 1) {
      this.play(false);
      return;
    }
    this.#show();
    requestAnimationFrame((next) => this.#tick(next));
  }

  // Time of the moment, and back, between the frames' times.
  time() {
    const { times_s: times, frames } = this.scene;
    const i = Math.min(Math.floor(this.moment), frames - 1);
    const next = times[Math.min(i + 1, frames - 1)];
    return times[i] + (this.moment - i) * (next - times[i]);
  }
  moment_of(time) {
    const { times_s: times, frames } = this.scene;
    if (time <= times[0]) return 0;
    const next = times.findIndex((t) => t > time);
    if (next < 0) return frames - 1;
    return next - 1 + (time - times[next - 1]) / (times[next] - times[next - 1]);
  }

  seek(time) {
    this.go_to(Math.round(this.moment_of(time)));
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
    at('time').textContent = `${this.time().toFixed(3)} s, frame ${frame} of ${frames - 1}`;
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
      colour: this.picture.channel?.name ?? no_channel,
    });
    if (this.picture.arrows) address.set('forces', 'arrows');
    if (at('strands').value !== 'all') address.set('strands', at('strands').value);
    if (this.full !== '') address.set('full', this.full);
    const text = `#${address.toString().replaceAll('%2C', ',')}`;
    if (text !== location.hash) history.replaceState(null, '', text);
  }

  // Opens what an address names; what it does not name stays at its default.
  read_address(hash) {
    const address = new URLSearchParams(hash.replace(/^#/, ''));
    const named = address.get('scene');
    const drawn = this.open(this.texts.has(named) ? named : [...this.texts.keys()][0]);
    if (address.has('view')) this.picture.camera.read(address.get('view'));
    const index = this.scene.channels.findIndex(
      ({ name }) => name === address.get('colour'),
    );
    if (index >= 0) this.colour(String(index));
    else if (address.get('colour') === no_channel) this.colour(no_channel);
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
