// Draws the figures and opens the tables of the page.
import embed from 'vega-embed';
import { expressionInterpreter } from 'vega-interpreter';
import { figures, figure_spec } from '../../figures/all.mjs';
import { page_theme, vega_config } from '../../figures/common.mjs';
import { all_objects } from '../objects.mjs';
import { describe_picture } from './described.mjs';
import { Player } from './scenes/player.mjs';
import { fill_table } from './table.mjs';
import { start_tabs } from './tabs.mjs';
import { unpacked_json } from './unpack.mjs';

const tables = Object.fromEntries(
  Object.entries(unpacked_json(document.getElementById('data').textContent)).map(
    ([name, { values, ...table }]) => [
      name,
      { ...table, rows: (values[0] ?? []).map((_, r) => values.map((column) => column[r])) },
    ],
  ),
);
const objects = all_objects(tables);

// Only what the row has: an adaptive run has no dt, a fixed-step run no rtol.
const tooltip_html = (fields, escape) =>
  `<table>${Object.entries(fields)
    .filter(([, value]) => !['', 'null', 'undefined', 'NaN'].includes(String(value)))
    .map(
      ([key, value]) =>
        `<tr><td class="key">${escape(key)}</td><td class="value">${escape(value)}</td></tr>`,
    )
    .join('')}</table>`;

const views = new Map();
const drawn_width = new Map();

async function draw(place) {
  const width = Math.floor(place.clientWidth);
  if (width === 0 || drawn_width.get(place) === width) return;
  drawn_width.set(place, width);
  try {
    await draw_at(place, width);
  } catch (error) {
    place.textContent = `This figure cannot be drawn from its table: ${error.message}`;
  }
}

async function draw_at(place, width) {
  const figure = figures.find(({ id }) => id === place.dataset.figure);
  const spec = figure_spec(figure, objects, { width, theme: page_theme });
  views.get(place)?.finalize();
  views.set(
    place,
    await embed(place, spec, {
      mode: 'vega-lite',
      renderer: 'svg',
      actions: false,
      ast: true,
      expr: expressionInterpreter,
      config: vega_config(page_theme),
      tooltip: { theme: 'custom', formatTooltip: tooltip_html },
    }),
  );
  describe_picture(place, spec.description);
}

// The drawn figure as a file: the page's colour variables become the colours now shown.
async function save(place) {
  const style = getComputedStyle(document.documentElement);
  const svg = (await views.get(place).view.toSVG()).replace(
    /var\((--[\w-]+)\)/g,
    (_, name) => style.getPropertyValue(name).trim(),
  );
  const link = document.createElement('a');
  link.href = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  link.download = `${place.dataset.figure}.svg`;
  link.click();
}

function add_tools(place) {
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = 'Save as SVG';
  button.addEventListener('click', () => save(place));
  document.querySelector(`[data-tools="${place.dataset.figure}"]`).append(button);
}

const places = [...document.querySelectorAll('[data-figure]')];
places.forEach(add_tools);

// Figures of a hidden tab have no width: they are drawn when it is shown.
let drawn = Promise.resolve();
const draw_all = () => (drawn = Promise.all([drawn, ...places.map(draw)]));

let pending = 0;
new ResizeObserver(() => {
  clearTimeout(pending);
  pending = setTimeout(draw_all, 120);
}).observe(document.body);

for (const details of document.querySelectorAll('[data-table]')) {
  details.addEventListener(
    'toggle',
    () => {
      if (details.open) fill_table(details, tables[details.dataset.table]);
    },
    { once: true },
  );
}

// Scenes: read when their tab is opened for the first time, or an address names one.
const scene_texts = new Map(
  [...document.querySelectorAll('[data-scene]')].map((element) => [
    element.dataset.scene,
    element.textContent,
  ]),
);
const player = scene_texts.size > 0 ? new Player(scene_texts) : undefined;
let scenes_drawn;

start_tabs((scenes_shown) => {
  draw_all();
  if (player === undefined) return;
  player.shown = scenes_shown;
  if (!scenes_shown) {
    if (player.playing) player.play(false);
  } else if (player.scene === undefined || location.hash.startsWith('#scene')) {
    scenes_drawn = player.read_address(location.hash);
  }
});

Promise.all([draw_all(), scenes_drawn]).then(() => {
  document.documentElement.dataset.ready = 'yes';
});
