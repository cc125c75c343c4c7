// Error against time on the swinging strand: tress, other simulators, position-based methods.
import { distinct, group_by, is_positive, minimum_by, succeeded, swing_rows } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
import { code, spaced, swing_levels, swing_runs } from '../src/strand.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  log_channel,
  log_extent,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { blue, family_name, name_style, orange, purple, sky } from './palette.mjs';
import { percent_axis, time_channel } from './rows.mjs';
import { front_of } from './swing.mjs';

// Position-based dynamics and block descent, each on its own; other methods by their family.
export const newest = ['xpbd', 'xpbd_bdf2', 'vbd', 'vbd_augmented', 'stable_cosserat_rods'];

const method_family = (integrator) =>
  newest.includes(integrator) ? integrator : family_name(integrator);

const other_simulators_run_s = 2; // simulated time of a run of other simulators

const ours = (tables, kind) =>
  swing_runs(swing_rows(tables), kind).map((row) => ({
    family: method_family(row.integrator),
    elements: row.elements,
    how: `${row.model}, ${row.integrator}, ${row.elements} elements`,
    error: row.error_rel,
    wall_s: row.wall_s_per_sim_s,
  }));

function sweeps(tables) {
  const whole = (row) => (row.block === 0 ? ', whole strand' : '');
  return (tables.block_descent ?? [])
    .filter((row) => row.scene === 'swing' && succeeded(row))
    .map((row) => ({
      family: row.integrator + whole(row),
      how:
        `${row.model}, steps of ${format_time(row.dt_s)}, ${row.sweeps} sweeps` +
        (row.block > 1 ? `, blocks of ${row.block}` : ''),
      error: row.error_rel,
      wall_s: row.wall_s_per_sim_s,
    }));
}

// Of ./tress other simulators, where it has been run. What is in single precision has no fine run of its
// own to be compared with.
const measured = (tables, column) =>
  (tables.other_simulators ?? [])
    .filter(succeeded)
    .filter((row) => column === 'total_error_rel' || row.precision !== 'single')
    .map((row) => ({
      family: row.simulator,
      elements: row.elements,
      engine: true,
      how: `${row.method}, steps of ${format_time(row.dt_s)}`,
      error: row[column],
      wall_s: row.wall_s / other_simulators_run_s,
    }));

const published = (tables) =>
  (tables.other_simulators_swing ?? []).flatMap((row) =>
    swing_levels.map(({ error, simulator }) => ({
      family: 'others, published',
      how: row.simulator,
      error,
      wall_s: row[simulator] / other_simulators_run_s,
      loose: true,
    })),
  );

// Runs of the swing by what their error is measured against: 'total', the continuous rod;
// 'time', the same elements at fine steps. Errors over the length, seconds a simulated one.
export function family_runs(tables, kind) {
  const all =
    kind === 'total'
      ? [...ours(tables, kind), ...sweeps(tables), ...measured(tables, 'total_error_rel')]
      : [...ours(tables, kind), ...measured(tables, 'tip_error_rel'), ...published(tables)];
  return all.filter((run) => is_positive(run.error) && is_positive(run.wall_s));
}

// Of each newest method the run with the least total error.
export function newest_findings(tables) {
  const runs = family_runs(tables, 'total');
  return newest.flatMap((name) => {
    const best = runs
      .filter((run) => run.family === name)
      .reduce((a, b) => (a === undefined || b.error < a.error ? b : a), undefined);
    return best === undefined
      ? []
      : [
          `${code(name)}: smallest total error ${format_number(100 * best.error)} %, in ` +
            `${format_time(best.wall_s)} a simulated second (${best.how}).`,
        ];
  });
}

// Larger errors are useless answers, smaller ones are rounding: neither is drawn.
const drawn = ({ error }) => error >= 3e-4 && error <= 0.6;

const position_based_engines = ['jolt'];
const is_position_based = ({ family }) =>
  position_based_engines.includes(family) ||
  newest.some((name) => family === name || family.startsWith(`${name},`));

const ours_name = 'tress';
const rigid_name = 'rigid-body engines';
const position_name = 'position-based methods, block descent';
const group_of = (run) =>
  is_position_based(run) ? position_name : run.engine ? rigid_name : ours_name;

// The elements that every engine was run with, where that is one number.
const links_of = (runs) => {
  const [links, ...more] = distinct(
    runs.filter((run) => group_of(run) === rigid_name).map((run) => run.elements),
  );
  return more.length === 0 ? links : undefined;
};

const target = 0.02;

function groups_of(tables) {
  const runs = family_runs(tables, 'total').map((run) => ({
    ...run,
    group: group_of(run),
    error_rel: run.error,
    error_pct: 100 * run.error,
    wall_ms: 1e3 * run.wall_s,
  }));
  const links = links_of(runs);
  const of = (name) => runs.filter(({ group }) => group === name);
  const same = of(ours_name).filter((run) => run.elements === links);
  return [
    [ours_name, of(ours_name)],
    [`${ours_name}, ${links} elements as in the engines`, same],
    [rigid_name, of(rigid_name)],
    [position_name, of(position_name)],
  ].filter(([, members]) => members.length > 0);
}

const rows_of = (tables) =>
  (tables.block_descent ?? []).length === 0
    ? []
    : groups_of(tables).flatMap(([series, members]) =>
        members.filter(drawn).map((run) => ({ ...run, series })),
      );

const cheapest = (members) =>
  minimum_by(
    members.filter((run) => run.error <= target),
    (run) => run.wall_s,
  );

// "A tip error of 2 % takes 0.9 ms with tress (20 elements: 2.1 ms), 24 ms with ..."
function headline(tables) {
  const groups = new Map(groups_of(tables));
  const best_of = (name) => cheapest(groups.get(name) ?? []);
  const [ours_best, same, rigid, position] = [
    ours_name,
    [...groups.keys()].find((name) => name.startsWith(`${ours_name}, `)),
    rigid_name,
    position_name,
  ].map(best_of);
  const time = (run) => format_time(run.wall_s);
  const said = [
    ours_best &&
      `${time(ours_best)} with tress` + (same ? ` (${same.elements} elements: ${time(same)})` : ''),
    rigid && `${time(rigid)} with the fastest rigid-body engine (${spaced(rigid.family)})`,
    position && `${time(position)} with the fastest position-based method (${spaced(position.family)})`,
  ].filter(Boolean);
  const never = !position && groups.has(position_name) ? '; no position-based method reaches it' : '';
  return `A tip error of ${format_number(100 * target)} % takes ${said.join(', ')}${never}`;
}

export const newest_methods = {
  id: 'newest_methods',
  title: 'Error against time, with other simulators',
  table: 'block_descent',
  headline,
  reading: `A strand swung by its clamp. Wall time of one core for a simulated second; lower left is better.
    A line joins the best runs of a group, dots are its other runs.`,
  caption: `Error of the tip of the swinging strand, over its length and against the continuous rod, against the time for
    a simulated second. The rigid-body engines and Jolt's rods have a fixed number of links, whose error no shorter step
    reduces. Tables are of different machines: between them trust orders of magnitude. Made from work_precision.csv,
    block_descent.csv and, where it exists, other_simulators.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const fronts = [...group_by(rows, (row) => row.series).values()].flatMap(front_of);
    const style = name_style(rows.map((row) => row.series));
    const hues = [blue, sky, orange, purple];
    style.colours = style.domain.map((_, i) => hues[i]);
    const engines = distinct(
      rows.filter((row) => row.series === rigid_name).map((row) => spaced(row.family)),
    );
    const { columns, panel_width, legend } = layout(width, 1, { labels: style.domain, above: true });
    const x = time_channel(
      'wall_ms',
      'wall time per simulated second',
      log_extent(rows.map((row) => row.wall_ms)),
    );
    const y = log_channel(
      'error_pct',
      'tip error / length',
      log_extent([...rows.map((row) => row.error_pct), 100 * target]),
      percent_axis,
    );
    const labels = { labelExpr: `datum.value === '${rigid_name}' ? datum.value + ': ${engines.join(', ')}' : datum.value` };
    const series = series_channels('series', null, style, { ...legend, ...labels, columns: width > 700 ? 2 : 1 });
    const opacity = (value) => dimmed_unless(['pick_series'], value);
    const tooltip = tooltips([
      ['family', 'method'],
      ['how', 'run'],
      ['error_pct', 'tip error (%)', '.3g'],
      ['wall_ms', 'wall time per simulated second (ms)', '.3g'],
    ]);
    const plot = {
      width: panel_width,
      height: 360,
      layer: [
        {
          data: { values: rows },
          mark: { type: 'point', filled: true, size: 18, aria: false },
          encoding: { x, y, ...series, strokeDash: undefined, opacity: opacity(0.35), tooltip },
        },
        {
          data: { values: [{ error_pct: 100 * target }] },
          mark: { type: 'rule', color: theme.muted, strokeDash: [4, 3] },
          encoding: { y },
        },
        {
          data: { values: fronts },
          mark: { type: 'line', strokeWidth: 2.4 },
          encoding: { x, y, ...series, shape: undefined, opacity: opacity(1) },
        },
        {
          data: { values: fronts },
          mark: { type: 'point', filled: true, size: 75 },
          encoding: { x, y, ...series, strokeDash: undefined, opacity: opacity(1), tooltip },
        },
      ],
    };
    return panels(with_parameters([plot], [legend_selection('pick_series', 'series')]), columns);
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Tip error against wall time, log-log, ${rows.length} runs in
      ${distinct(rows.map((row) => row.series)).length} groups.`;
  },
};
