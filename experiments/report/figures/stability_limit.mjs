// Largest stable time step of each method, one panel for each scene and damping.
import { distinct, group_by, is_positive, minimum_by, study_rows } from '../src/tables.mjs';
import {
  damping_name,
  damping_rank,
  frame_s,
  has_limit,
  is_capped,
  is_reduced,
  principal_runs,
  run_name,
  scan_end_s,
  spaced,
} from '../src/strand.mjs';
import {
  dimmed_unless,
  legend_selection,
  lines_of,
  log_extent,
  panels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { blue, green, orange } from './palette.mjs';
import { row_channel, time_channel } from './rows.mjs';

const elements_end = 40;
const shown_elements = 20; // drawn large
const frame_ms = 1e3 * frame_s;
const gap = 14;

const kinds = [
  { name: 'measured limit', colour: blue, shape: 'circle' },
  { name: 'stable up to the longest step tried', colour: green, shape: 'triangle-right' },
  {
    name: 'no stable step found',
    colour: orange,
    shape: 'M-0.7,-0.7L0.7,0.7M-0.7,0.7L0.7,-0.7Z',
  },
];
const kind_of = (row) => kinds[is_capped(row) ? 1 : has_limit(row) ? 0 : 2].name;

// What a limit can be drawn from: the search found one, or found none.
export const is_drawn = (row) =>
  is_positive(row.elements) &&
  row.elements <= elements_end &&
  (has_limit(row) ||
    (row.status === 'unstable' && is_positive(row.dt_first_unstable_s)));

// Methods with the number of cases, of scene and damping, in which nothing unstable was met at
// the shown number of elements.
const free_methods = (rows) =>
  [...group_by(rows.filter((row) => row.elements === shown_elements), (row) => row.method)].map(
    ([method, members]) => ({
      method,
      cases: members.length,
      free: members.filter(is_capped).length,
    }),
  );

// "At 20 elements, A is stable up to the longest step tried in 8 of 9 cases, B in 1 of 9"
export function limit_headline(rows) {
  const methods = free_methods(rows);
  if (methods.length === 0) return 'Largest stable time step';
  const most = Math.max(...methods.map(({ cases }) => cases));
  const common = methods.filter(({ cases }) => cases >= most / 2);
  const best = minimum_by(common, ({ free, cases }) => -free - free / cases);
  const worst = minimum_by(common, ({ free, cases }) => free / cases);
  const part = ({ free, cases }) => `${free} of ${cases}`;
  return (
    `With ${shown_elements} elements, “${best.method}” is stable up to the longest step tried in ` +
    `${part(best)} cases` +
    (worst.method === best.method ? '' : `, “${worst.method}” in ${part(worst)}`)
  );
}

export const limit_reading = `Large marks: ${shown_elements} elements; small ones: other numbers of elements. A triangle is a lower
  bound: the scan ends at ${1e3 * scan_end_s} ms, or where longer steps miss what drives the scene (curl drop 33 ms, whip 5 ms). Dashed:
  33 ms, one frame at 30 frames per second.`;

function panel(members, { x, y, theme, panel_width, step, labels }) {
  const used = kinds.filter(({ name }) => members.some((row) => row.kind === name));
  const of = (key) => ({ domain: kinds.map(({ name }) => name), range: kinds.map((k) => k[key]) });
  const legend = { orient: 'top', direction: 'horizontal', columns: labels.columns, symbolType: 'circle' };
  const kind = { field: 'kind', type: 'nominal', title: null, legend };
  return {
    title: {
      text: spaced(members[0].scene),
      subtitle: damping_name(members[0]),
      subtitleColor: theme.muted,
      subtitleFontSize: 12,
      offset: 6,
    },
    width: panel_width,
    height: { step },
    layer: [
      ...used.map(({ name }) => ({
        data: { values: members.filter((row) => row.kind === name) },
        mark: { type: 'point', filled: name !== kinds[2].name, strokeWidth: 1.8 },
        encoding: {
          x,
          y,
          color: { ...kind, scale: of('colour') },
          shape: { ...kind, scale: of('shape') },
          size: {
            condition: { test: `datum.elements === ${shown_elements}`, value: 85 },
            value: 20,
          },
          opacity: dimmed_unless(['pick_kind']),
          tooltip: tooltips([
            ['method', 'method'],
            ['integrator', 'integrator'],
            ['elements', 'elements'],
            ['dt_max_s', 'largest stable dt (s)', '.3e'],
            ['dt_first_unstable_s', 'first unstable dt (s)', '.3e'],
            ['limited_by', 'limited by'],
            ['cost_per_step_s', 'cost per step (s)', '.3e'],
            ['realtime_factor', 'simulated s per s', '.3g'],
          ]),
        },
      })),
      {
        data: { values: [{ dt_ms: frame_ms }] },
        mark: { type: 'rule', strokeDash: [5, 4], color: theme.text },
        encoding: { x },
      },
    ],
  };
}

// Rows with a `method` each: one panel per scene and damping, one row per method, in
// `columns_wanted` columns or more where there are enough panels.
export function limit_spec(rows, { width, theme }, columns_wanted = 3) {
  const smallest = Math.min(
    ...rows.filter(has_limit).map((row) => 1e3 * row.dt_max_s),
    frame_ms / 10,
  );
  const placed = rows.map((row) => ({
    ...row,
    kind: kind_of(row),
    dt_ms: has_limit(row) ? 1e3 * row.dt_max_s : smallest,
  }));
  const groups = [
    ...group_by(
      [...placed].sort((a, b) => damping_rank(a) - damping_rank(b)),
      (row) => `${row.scene}|${row.damping}`,
    ).values(),
  ];
  // Columns are dampings where they fit: scenes that have all of them come first, and
  // only the first column carries the names of the rows.
  const scenes = distinct(rows.map((row) => row.scene));
  const panels_of = (group) => groups.filter(([row]) => row.scene === group[0].scene);
  const wanted = Math.max(
    Math.min(columns_wanted, groups.length),
    ...groups.map((group) => panels_of(group).length),
  );
  const place = (group) =>
    (panels_of(group).length === wanted ? 0 : scenes.length) +
    scenes.indexOf(group[0].scene);
  groups.sort((a, b) => place(a) - place(b));
  const methods = distinct(rows.map((row) => row.method));
  const label_width = width < 600 ? 130 : 200;
  const labels = methods.map((name) => lines_of(name, label_width, 6.4));
  const lines = Math.max(...labels.map(({ length }) => length));
  const room = Math.min(label_width, 6.4 * Math.max(...labels.flat().map((t) => t.length))) + 24;
  const columns = width >= 180 * wanted + room ? wanted : 1;
  const panel_width = Math.floor((width - room - (columns - 1) * (gap + 12)) / columns - 12);
  const extent = log_extent(placed.map((row) => row.dt_ms), panel_width < 300 ? 4 : 7);
  const list = groups.map((members, i) => {
    const first = i % columns === 0;
    return panel(members, {
      x: time_channel(
        'dt_ms',
        columns === 1 || i + columns >= groups.length ? 'largest stable step' : null,
        extent,
      ),
      y: row_channel('method', methods, {
        labels: first,
        labelExpr: `split((${JSON.stringify(
          Object.fromEntries(methods.map((name, k) => [name, labels[k].join('|')])),
        )})[datum.value], '|')`,
        labelLineHeight: 11,
        labelFontSize: 10.5,
      }),
      theme,
      panel_width,
      step: Math.max(15, 11 * lines + 5),
      labels: { columns: width < 600 ? 1 : 3 },
    });
  });
  return {
    ...panels(with_parameters(list, [legend_selection('pick_kind', 'kind')]), columns),
    spacing: { row: 16, column: gap },
  };
}

export const stability_limit = {
  id: 'stability_limit',
  title: 'The largest stable time step',
  table: 'stability_limit',
  headline(tables) {
    return limit_headline(this.rows(tables));
  },
  reading: limit_reading,
  caption: `Largest stable time step, one panel per scene and damping. Composite and recursive solve the same equations.
    The step is the linearly implicit one of the papers unless the name states another. Made from stability_limit.csv, up to
    ${elements_end} elements; other solvers, integrators and modes, and searches that ran out of time, are in the tables only.`,

  rows: (tables) =>
    principal_runs(
      study_rows(tables, 'stability_limit', 'grid').filter(
        (row) => is_reduced(row) && is_drawn(row),
      ),
    ).map((row) => ({ ...row, method: run_name(row) })),

  spec(tables, options) {
    return limit_spec(this.rows(tables), options);
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Largest stable time step in milliseconds, log scale: ${distinct(rows.map((r) => `${r.scene} ${r.damping}`)).length} panels of scene and damping,
      ${distinct(rows.map((r) => r.method)).length} methods, 33 ms marked,
      ${rows.filter(is_capped).length} runs stable up to the end of the scan.`;
  },
};
