// Figure 15: error against time on the swinging strand, every family of methods that the
// tables hold in one picture.
import { distinct, group_by, is_positive, succeeded, swing_rows } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
import { swing_levels, swing_runs } from '../src/strand.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  log_channel,
  log_extent,
  marked_line,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { family_name, model_style } from './palette.mjs';
import { front_of } from './swing.mjs';

// Position-based dynamics and block descent, each on its own; other methods by their family.
export const newest = ['xpbd', 'xpbd_bdf2', 'vbd', 'vbd_augmented', 'stable_cosserat_rods'];

const method_family = (integrator) =>
  newest.includes(integrator) ? integrator : family_name(integrator);

const peers_run_s = 2; // simulated time of a run of other simulators

const ours = (tables, kind) =>
  swing_runs(swing_rows(tables), kind).map((row) => ({
    family: method_family(row.integrator),
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

// Of ./tress peers, where it has been run. What is in single precision has no fine run of its
// own to be compared with.
const measured = (tables, column) =>
  (tables.peers ?? [])
    .filter(succeeded)
    .filter((row) => column === 'total_error_rel' || row.precision !== 'single')
    .map((row) => ({
      family: row.peer,
      how: `${row.method}, steps of ${format_time(row.dt_s)}`,
      error: row[column],
      wall_s: row.wall_s / peers_run_s,
    }));

const published = (tables) =>
  (tables.peers_swing ?? []).flatMap((row) =>
    swing_levels.map(({ error, peer }) => ({
      family: 'others, published',
      how: row.peer,
      error,
      wall_s: row[peer] / peers_run_s,
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
          `${name}: least total error ${format_number(100 * best.error)} %, in ` +
            `${format_time(best.wall_s)} a simulated second (${best.how}).`,
        ];
  });
}

// What is worth drawing: a useless answer and rounding are not.
const drawn = ({ error }) => error >= 1e-6 && error <= 2;

// Runs that no other of their family beats in both error and time.
const fronts = (tables, kind) =>
  [...group_by(family_runs(tables, kind).filter(drawn), (run) => run.family).values()]
    .flatMap((runs) =>
      runs[0].loose
        ? runs
        : front_of(runs.map((run) => ({ ...run, error_rel: run.error }))),
    )
    .map((run) => ({ ...run, error_pct: 100 * run.error, wall_ms: 1e3 * run.wall_s }));

function panel(rows, title, { style, legend, panel_width, y }) {
  const layers = marked_line(rows, {
    x: log_channel('error_pct', `${title} error (%)`, log_extent(rows.map((r) => r.error_pct), 6)),
    y,
    series: series_channels('family', 'method', style, legend),
    opacity: dimmed_unless(['pick_family']),
    tooltip: tooltips([
      ['family', 'method'],
      ['how', 'run'],
      ['error_pct', `${title} error (%)`, '.3g'],
      ['wall_ms', 'wall time per simulated second (ms)', '.3g'],
    ]),
  });
  layers[0].data = { values: rows.filter((row) => !row.loose) };
  layers[0].encoding.order = { field: 'error_pct', type: 'quantitative' };
  return { title: `${title} error`, width: panel_width, height: 340, layer: layers };
}

export const newest_methods = {
  id: 'newest_methods',
  title: 'The newest methods and the others',
  table: 'block_descent',
  caption: `Error of the tip of the swinging strand against the time for a simulated second,
    one core; down and left is better. Left: against the continuous rod. Right: against fine
    steps of the same elements. Lines join the runs of a family that none of its others
    beats. Tables are of different machines: between them trust orders of magnitude. Made
    from work_precision.csv, block_descent.csv, peers_swing.csv and, where it is there,
    peers.csv.`,

  rows: (tables) =>
    (tables.block_descent ?? []).length === 0
      ? []
      : ['total', 'time'].flatMap((kind) => fronts(tables, kind)),

  spec(tables, { width }) {
    const all = this.rows(tables);
    const style = model_style(all.map((row) => row.family));
    const kinds = ['total', 'time'].filter((kind) => fronts(tables, kind).length > 0);
    const { columns, panel_width, legend } = layout(width, kinds.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const y = log_channel(
      'wall_ms',
      'wall time per simulated second (ms)',
      log_extent(all.map((row) => row.wall_ms)),
    );
    const list = kinds.map((kind) =>
      panel(fronts(tables, kind), kind, { style, legend, panel_width, y }),
    );
    return panels(with_parameters(list, [legend_selection('pick_family', 'family')]), columns);
  },

  describe(tables) {
    return `Wall time against error of the tip, log-log, for
      ${distinct(this.rows(tables).map((row) => row.family)).length} families of methods.`;
  },
};
