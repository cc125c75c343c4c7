// The live view of ./tress play: pictures come as server-sent events, commands go back.
import { format_number } from '../../format.mjs';
import { add } from '../scenes/camera.mjs';
import { arrays_of, decode_scene, positions_at } from '../scenes/data.mjs';
import { extent_of } from '../scenes/extent.mjs';
import { is_own_key, steer_camera } from '../scenes/gestures.mjs';
import { Painter } from '../scenes/gl/painter.mjs';
import { Picture } from '../scenes/picture.mjs';
import { Pull, length_of, point_of } from './pull.mjs';

const at = (id) => document.getElementById(`live-${id}`);
const canvas = document.getElementById('scene-canvas');

// Where strands may come to: they hang down, or swing to a side.
function reached({ starts }, positions) {
  const directions = [[0, 0, -1], [0, 0, 0.4], [0.7, 0, 0], [-0.7, 0, 0], [0, 0.7, 0], [0, -0.7, 0]]; // prettier-ignore
  return starts.slice(0, -1).flatMap((start, k) => {
    const length = length_of(positions, start, starts[k + 1]);
    const root = point_of(positions, start);
    return directions.map((direction) => add(root, direction, length));
  });
}

class Live {
  #drawing = false;
  #next = undefined; // pull to send once the last is answered
  #sending = false;

  constructor() {
    this.painter = Painter.create();
    this.pull = new Pull(this, canvas); // before the camera, which takes what it leaves
    steer_camera(this, canvas);
    at('run').addEventListener('click', () => this.run(!this.state.playing));
    at('step').addEventListener('click', () => this.send({ do: 'step' }));
    at('restart').addEventListener('click', () => this.send({ do: 'restart' }));
    at('colour').addEventListener('change', () => this.colour(at('colour').value));
    at('key').addEventListener('input', () => this.show_value());
    at('change').addEventListener('submit', (event) => {
      event.preventDefault();
      this.set();
    });
    for (const button of document.querySelectorAll('[data-view]'))
      button.addEventListener('click', () => {
        this.picture?.camera.look(button.dataset.view);
        this.changed();
      });
    document.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.changed()).observe(canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () =>
      this.changed(),
    );
    this.events = new EventSource('events');
    this.events.onmessage = ({ data }) => this.show(JSON.parse(data));
    this.events.onerror = () => this.tell('no connection: ./tress play has ended', true);
  }

  async send(command) {
    try {
      const reply = await fetch('command', {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(command),
      });
      const { refused } = await reply.json();
      this.refused = refused;
    } catch {
      this.refused = 'no connection: ./tress play has ended';
    }
    this.show_status();
  }

  // Of several places of the mouse the last one counts.
  async send_last(command) {
    this.#next = command;
    if (this.#sending) return;
    this.#sending = true;
    while (this.#next !== undefined) {
      const now = this.#next;
      this.#next = undefined;
      await this.send(now);
    }
    this.#sending = false;
  }

  run(on) {
    this.send({ do: on ? 'run' : 'pause' });
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || this.state === undefined) return;
    const { target, key } = event;
    const actions = {
      ' ': () => this.run(!this.state.playing),
      '.': () => this.send({ do: 'step' }),
      r: () => this.send({ do: 'restart' }),
    };
    if (actions[key] === undefined || is_own_key(target, key)) return;
    if (target.matches('input')) return;
    event.preventDefault();
    actions[key]();
  }

  set() {
    const text = at('value').value.trim();
    let value = text;
    try {
      value = JSON.parse(text);
    } catch {
      // A word.
    }
    this.send({ do: 'set', key: at('key').value.trim(), value });
  }

  show_value() {
    const value = this.state?.keys[at('key').value];
    at('value').value = value === undefined ? '' : JSON.stringify(value);
  }

  show(state) {
    const first = this.state === undefined;
    this.state = state;
    const scene = decode_scene(arrays_of(state.picture));
    if (first) at('title').textContent = scene.title;
    const names = Object.keys(state.keys);
    if (first || names.length !== at('keys-known').children.length)
      at('keys-known').replaceChildren(...names.map((name) => new Option(name, name)));
    if (first) {
      at('stiffness').value = String(Number(state.stiffness_n_m.toPrecision(3)));
      at('key').value = names.find((name) => /^(effects|material)/.test(name)) ?? names[0];
      this.show_value();
    }
    this.take(scene);
    this.show_readings(scene);
    this.show_status();
    at('run').textContent = state.playing ? 'Pause' : 'Run';
    at('run').setAttribute('aria-pressed', String(state.playing));
    this.changed();
    document.documentElement.dataset.ready = 'yes';
  }

  // The picture of another moment, on the same camera and the same scale of colours.
  take(scene) {
    this.scene = scene;
    const channels = scene.channels.map(({ name }) => name).join();
    if (this.picture === undefined || this.channels !== channels) {
      const camera = this.picture?.camera.text();
      this.picture?.free();
      const extent = extent_of([scene], reached(scene, this.positions()));
      const by = { painter: this.painter, always: false };
      this.picture = new Picture(canvas, [scene], by, extent);
      if (camera !== undefined) this.picture.camera.read(camera);
      this.channels = channels;
      this.most = new Map();
      this.picture.range = () => ({
        low: 0,
        high: this.most.get(this.picture.colour.name) ?? 0,
      });
      at('colour').replaceChildren(
        ...scene.channels.map(
          ({ name, unit }, i) =>
            new Option(unit === '' ? name : `${name} (${unit})`, String(i)),
        ),
        new Option('one colour a strand', 'strand'),
      );
      this.colour(scene.channels.length > 0 ? '0' : 'strand');
    }
    for (const { name, high } of scene.channels)
      this.most.set(name, Math.max(high ?? 0, this.most.get(name) ?? 0));
    const [pane] = this.picture.panes;
    const same = String(pane.scene.strand_points) === String(scene.strand_points);
    this.picture.scenes = [scene];
    pane.scene = scene;
    pane.usual_force = 0;
    if (same) pane.curves.scene = scene;
    else {
      pane.positions = new Float64Array(3 * scene.points);
      pane.show_strands(false);
    }
  }

  colour(value) {
    this.picture.colour = this.scene.channels[value] ?? value;
    at('colour').value = value;
    this.changed();
  }

  show_bar() {
    const { colour } = this.picture;
    const bar = at('bar');
    bar.hidden = typeof colour === 'string';
    if (bar.hidden) return;
    const part = (name) => bar.querySelector(`.bar-${name}`);
    part('name').textContent =
      colour.unit === '' ? colour.name : `${colour.name} (${colour.unit})`;
    part('low').textContent = '0';
    part('high').textContent = format_number(this.picture.range().high);
  }

  show_readings({ series: { columns, rows }, times_s }) {
    const value = (name) => rows[0][columns.indexOf(name)];
    const energies = columns.filter((name) => name.endsWith('_j'));
    const wall = this.state.wall_per_s;
    const readings = [
      ['time', `${times_s[0].toFixed(4)} s`],
      ['steps', String(this.state.steps)],
      ['wall time per simulated second', wall === null ? '-' : `${format_number(wall)} s`],
      ...energies.map((name) => [
        `${name.replace(/_j$/, '').replaceAll('_', ' ')} energy`,
        value(name) === null ? '-' : `${format_number(value(name))} J`,
      ]),
      ...columns.flatMap((name) => {
        const [, what, body, unit] = /^(angle|speed)_(body\w*?)_(rad|rad_per_s)$/.exec(name) ?? [];
        if (what === undefined) return [];
        const text = `${format_number(value(name))} ${unit.replace('_per_', '/')}`;
        return [[`${what} of ${body.replaceAll('_', ' ')}`, text]];
      }),
    ];
    at('readings').replaceChildren(
      ...readings.map(([name, text]) => {
        const [box, term, detail] = ['div', 'dt', 'dd'].map((tag) =>
          document.createElement(tag),
        );
        term.textContent = name;
        detail.textContent = text;
        box.append(term, detail);
        return box;
      }),
    );
    at('time').textContent = `${times_s[0].toFixed(3)} s`;
  }

  tell(text, bad) {
    at('status').textContent = text;
    at('status').classList.toggle('failed', bad);
  }

  show_status() {
    const { failed, playing } = this.state ?? {};
    if (this.refused) this.tell(`refused: ${this.refused}`, true);
    else if (failed) this.tell(`the run failed: ${failed}`, true);
    else this.tell(playing ? 'running' : 'paused', false);
  }

  changed() {
    if (this.#drawing || this.picture === undefined) return;
    this.#drawing = true;
    requestAnimationFrame(() => {
      this.#drawing = false;
      this.draw();
    });
  }

  draw() {
    const theme = this.picture.draw(0);
    at('bar').querySelector('.bar-ramp').style.background = theme.channel_bar;
    this.show_bar();
    this.pull.draw(theme);
  }

  positions() {
    return positions_at(this.scene, 0, new Float64Array(3 * this.scene.points));
  }
}

new Live();
