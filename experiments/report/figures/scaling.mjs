// Cost per step against elements: the solvers of one model, and all models with their fastest.
import { distinct, group_by, is_positive, minimum_by, succeeded } from '../src/tables.mjs';
import { scaling_series, solver_pairs, spaced, variant_name } from '../src/strand.mjs';
import { format_number, format_ratio, format_time } from '../src/format.mjs';
import { layout, log_channel, log_extent, spread, tooltips } from './common.mjs';
import { brown, grey, name_style } from './palette.mjs';
import { row_channel, row_text, row_width, time_channel } from './rows.mjs';

const shown_model = 'super_helix';
const shown_elements = 20;

// All modes of every solver; fewer modes are in the table.
const drawn = ({ members: [row] }) =>
  row.model === shown_model &&
  row.solver !== 'klu' &&
  ['', 'bend_twist'].includes(row.modes ?? '');

const power = (exponent) => (is_positive(exponent) ? `: N^${exponent.toFixed(2)}` : '');
const timed = (row) => succeeded(row) && is_positive(row.cost_per_step_s);

const rows_of = ({ scaling = [] }) =>
  scaling_series(scaling)
    .filter(drawn)
    .flatMap(({ name, exponent, members }) =>
      members.map((row) => ({
        ...row,
        method: name,
        series: name.replace(' Jacobian', '') + power(exponent),
        cost_us: 1e6 * row.cost_per_step_s,
      })),
    );

// Of every model its fastest way at the shown number of elements, the fastest model first.
const fastest = ({ scaling = [] }) =>
  [
    ...group_by(
      scaling_series(scaling)
        .flatMap(({ exponent, members }) => members.map((row) => ({ ...row, exponent })))
        .filter((row) => row.elements === shown_elements && timed(row)),
      (row) => row.model,
    ).values(),
  ]
    .map((members) => minimum_by(members, (row) => row.cost_per_step_s))
    .sort((a, b) => a.cost_per_step_s - b.cost_per_step_s)
    .map((row) => ({
      ...row,
      name: variant_name(row),
      cost_us: 1e6 * row.cost_per_step_s,
      text: [format_time(row.cost_per_step_s), row.solver, row.modes]
        .filter(Boolean)
        .map(spaced)
        .join(', ') + power(row.exponent),
    }));

const panel_height = 300;

// Ratio of the two solvers: ours as a line with the trees next to it, the published one dashed.
function ratio_panel(pairs, { panel_width, theme }) {
  const shown = pairs.flatMap((pair) => [
    ...(pair.ours ? [{ ...pair, whose: 'ours', ratio: pair.ours }] : []),
    ...(pair.source ? [{ ...pair, whose: 'source', ratio: pair.source }] : []),
  ]);
  const x = log_channel('elements', 'elements', log_extent(shown.map((r) => r.elements)));
  const y = log_channel(
    'ratio',
    'composite / recursive',
    log_extent([...shown.map((r) => r.ratio), 1]),
  );
  const tooltip = tooltips([
    ['structure', 'structure'],
    ['elements', 'elements'],
    ['whose', 'whose'],
    ['ratio', 'composite / recursive', '.3g'],
  ]);
  const of = (whose, straight) =>
    shown.filter((r) => r.whose === whose && (r.structure === 'straight') === straight);
  const layer = (values, mark) => ({
    data: { values },
    mark,
    encoding: { x, y, ...(mark.type === 'point' ? { tooltip } : {}) },
  });
  const last = (values) => values.filter((r) => r === values.at(-1));
  const name = (whose, text, color, place) => ({
    data: {
      values: last(of(whose, true).sort((a, b) => a.elements - b.elements)).map((r) => ({
        ...r,
        text,
      })),
    },
    mark: { type: 'text', fontSize: 12, fontWeight: 600, color, ...place },
    encoding: { x, y, text: { field: 'text' } },
  });
  return {
    title: 'Cost of composite over recursive',
    width: panel_width,
    height: panel_height,
    layer: [
      layer(of('ours', true), { type: 'line', color: brown, strokeWidth: 1.8 }),
      layer(of('source', true), {
        type: 'line',
        color: grey,
        strokeWidth: 1.8,
        strokeDash: [6, 3],
      }),
      {
        data: { values: [{ ratio: 1 }] },
        mark: { type: 'rule', color: theme.axis },
        encoding: { y },
      },
      layer(of('ours', true), { type: 'point', filled: true, color: brown, size: 55 }),
      layer(of('ours', false), {
        type: 'point',
        shape: 'diamond',
        filled: false,
        color: brown,
        size: 90,
        strokeWidth: 1.7,
      }),
      layer(of('source', true), {
        type: 'point',
        shape: 'square',
        filled: true,
        color: grey,
        size: 60,
      }),
      name('ours', 'here', brown, { align: 'right', dx: -8, dy: -10 }),
      name('source', 'published, 2008', grey, { align: 'right', dx: -10, dy: -4 }),
    ],
  };
}

// One line per solver, its name at its end.
function cost_panel(rows, { panel_width, style }) {
  const x = log_channel('elements', 'elements', log_extent(rows.map((r) => r.elements)));
  const y = log_channel('cost_us', 'cost per step (µs)', log_extent(rows.map((r) => r.cost_us)));
  const nominal = (range) => ({
    field: 'method',
    type: 'nominal',
    scale: { domain: style.domain, range },
    legend: null,
  });
  const color = nominal(style.colours);
  const tooltip = tooltips([
    ['structure', 'structure'],
    ['method', 'solver'],
    ['elements', 'elements'],
    ['cost_us', 'cost per step (µs)', '.3g'],
    ['exponent', 'slope', '.2f'],
    ['dt_max_s', 'largest stable dt (s)', '.3e'],
    ['fps', 'frames per second', '.3g'],
    ['published_fps', 'published frames per second'],
  ]);
  const names = [...group_by(rows, (row) => row.method).values()].map((members) =>
    members.reduce((last, row) => (row.elements > last.elements ? row : last)),
  );
  const font_size = panel_width < 300 ? 9.5 : 11;
  const longest = Math.max(...names.map((row) => row.series.length));
  const room = 0.56 * font_size * longest + 16;
  const plot_width = Math.floor(Math.max(90, panel_width - room));
  const [bottom, top] = y.scale.domain.map(Math.log10);
  const pixels = panel_height / (top - bottom);
  const places = spread(
    names.map((row) => pixels * (top - Math.log10(row.cost_us))),
    font_size + 3,
    panel_height,
  ).map((place) => 10 ** (top - place / pixels));
  return {
    title: `${spaced(shown_model)}: cost of one step by solver`,
    width: plot_width,
    height: panel_height,
    layer: [
      {
        data: { values: rows },
        mark: { type: 'line', strokeWidth: 1.6 },
        encoding: { x, y, color, strokeDash: nominal(style.dashes) },
      },
      {
        data: { values: rows },
        mark: { type: 'point', filled: true, size: 45 },
        encoding: { x, y, color, shape: nominal(style.shapes), tooltip },
      },
      {
        data: { values: names.map((row, i) => ({ ...row, place: places[i] })) },
        mark: {
          type: 'text',
          align: 'left',
          baseline: 'middle',
          fontSize: font_size,
          x: plot_width + 8,
        },
        encoding: { y: { ...y, field: 'place' }, text: { field: 'series' }, color },
      },
    ],
  };
}

function model_panel(models, { width }) {
  const names = models.map(({ name }) => name);
  const x = time_channel(
    'cost_ms',
    `cost of one step with ${shown_elements} elements`,
    log_extent(models.map((row) => 1e-3 * row.cost_us)),
  );
  const y = row_channel('name', names);
  const narrow = width < 700;
  const values = models.map((row) => ({ ...row, cost_ms: 1e-3 * row.cost_us }));
  return {
    title: 'Models, each with its fastest solver',
    width: row_width(width, names, narrow ? 0 : 280),
    height: { step: 19 },
    layer: [
      {
        data: { values },
        mark: { type: 'point', filled: true, size: 80, color: grey },
        encoding: {
          x,
          y,
          tooltip: tooltips([
            ['name', 'model'],
            ['solver', 'solver'],
            ['jacobian', 'jacobian'],
            ['modes', 'modes'],
            ['cost_us', 'cost per step (µs)', '.3g'],
            ['exponent', 'exponent', '.2f'],
          ]),
        },
      },
      ...(narrow ? [] : [row_text(values, y, 'text', { baseline: 'middle' })]),
    ],
  };
}

// "super helix: recursive N^1.00, composite N^1.95, 3 times as expensive at 100 elements"
function headline(tables) {
  const rows = rows_of(tables);
  const of = (method) => rows.find((row) => row.method === method)?.series;
  const said = ['recursive', 'composite'].map(of).filter(Boolean);
  const pairs = solver_pairs(tables.scaling ?? []).filter(
    ({ structure, ours }) => structure === 'straight' && ours !== undefined,
  );
  const last = minimum_by(pairs, ({ elements }) => -elements);
  const ratio =
    last === undefined
      ? ''
      : `; at ${last.elements} elements composite takes ${format_ratio(last.ours)} as long`;
  return `Cost of a step of ${spaced(shown_model)} with N elements: ${said.join(', ')}${ratio}`;
}

export const scaling = {
  id: 'scaling',
  title: 'Cost against the number of elements',
  table: 'scaling',
  headline,
  reading: `A straight strand, one linear solve per step. N^p: power of the number of elements, fitted from
    ${format_number(shown_elements)} elements on.`,
  caption: `Right: how many times the recursive step the composite one costs; diamonds are trees, squares what the published
    frames per second imply (rounded there, and equal at one and two elements). That hardware was of 2008: its frames per
    second are not comparable with those here, the ratio is. Other solvers and modes, and the trees, are in the table. Made
    from scaling.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const models = fastest(tables);
    const pairs = solver_pairs(tables.scaling).filter((p) => p.ours || p.source);
    // Plots below each other start at the same edge: right of the longest name of a row.
    const names = models.map(({ name }) => 6.6 * name.length);
    const room = models.length > 1 ? Math.max(0, Math.max(...names) - 20) : 0;
    const { columns, panel_width: wanted } = layout(width - room, 1 + (pairs.length > 0), {
      columns_max: 2,
      above: true, // no legend: names stand at the lines
    });
    const panel_width = Math.min(wanted, width - room - 70);
    const style = name_style(distinct(rows.map((row) => row.method)));
    const upper = [
      cost_panel(rows, { panel_width, style }),
      ...(pairs.length > 0 ? [ratio_panel(pairs, { panel_width, theme })] : []),
    ];
    return {
      vconcat: [
        { concat: upper, columns, spacing: 28 },
        ...(models.length > 1 ? [model_panel(models, { width })] : []),
      ],
      spacing: 24,
    };
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Log-log charts against the number of elements: cost per step of
      ${distinct(rows.map((r) => r.method)).length} solvers in microseconds, the ratio
      of composite to recursive, here and published, and the cost of
      ${fastest(tables).length} models with ${shown_elements} elements.`;
  },
};
