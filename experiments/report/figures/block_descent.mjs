// How many sweeps of block descent solve a step.
import { distinct, group_by, is_positive, minimum_by, succeeded } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
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
import { name_style } from './palette.mjs';

const least = 1e-10; // distances below it are rounding

// 1e8, 25
export const power = (x) =>
  x >= 1e4 ? Number(x.toPrecision(2)).toExponential().replace('e+', 'e') : format_number(x);

export const descent_rows = (tables, part) =>
  (tables.block_descent ?? []).filter((row) => row.part === part);

// "vbd, blocks of 4"
export function way_of(row) {
  const acceleration =
    row.chebyshev > 0 ? ', Chebyshev' : row.anderson > 0 ? ', Anderson' : '';
  if (row.integrator === 'xpbd' || row.integrator === 'stable_cosserat_rods')
    return row.integrator + acceleration;
  const block =
    row.block === 0 ? ', whole' : row.block === 1 ? '' : `, blocks of ${row.block}`;
  return row.integrator + block + acceleration;
}

const drawn = (rows) =>
  rows
    .filter((row) => succeeded(row) && is_positive(row.direct_distance_rel))
    .map((row) => ({
      ...row,
      distance: Math.max(row.direct_distance_rel, least),
    }));

const all_sweeps = (tables) =>
  drawn(descent_rows(tables, 'sweeps'))
    .filter((row) => !(row.anderson > 0)) // in the table of the page
    .map((row) => ({ ...row, way: way_of(row) }));

const coincide = 2; // lines that differ by less than this factor everywhere are drawn as one
const label = ([leader, ...rest]) =>
  rest.length > 0
    ? `${leader} (also: ${rest.map((way) => way.replace(`${leader}, `, '')).join('; ')})`
    : leader;

// Ways whose lines lie on each other in every model are drawn as one.
function of_sweeps(tables) {
  const rows = all_sweeps(tables);
  const at = (way) => rows.filter((row) => row.way === way);
  const same = (a, b) => {
    const pairs = at(a).flatMap((row) =>
      at(b)
        .filter((other) => other.model === row.model && other.sweeps === row.sweeps)
        .map((other) => Math.abs(Math.log(row.distance / other.distance))),
    );
    return pairs.length > 1 && Math.max(...pairs) < Math.log(coincide);
  };
  const groups = [];
  for (const way of distinct(rows.map((row) => row.way))) {
    const group = groups.find(([leader]) => same(leader, way));
    if (group) group.push(way);
    else groups.push([way]);
  }
  return groups.flatMap((ways) => at(ways[0]).map((row) => ({ ...row, way: label(ways) })));
}

// Of the rows that ask for sweeps.
const usual_step = (tables) => descent_rows(tables, 'sweeps')[0]?.dt_s;

// One sweep before multipliers are improved: the others are in the table.
const of_penalties = (tables) =>
  drawn(descent_rows(tables, 'penalty').filter((row) => row.primal_sweeps === 1)).map(
    (row) => ({
      ...row,
      way: way_of(row) + (row.dt_s === usual_step(tables) ? '' : `, steps of ${format_time(row.dt_s)}`),
    }),
  );

// The penalties within one per cent of the direct step, by step.
export function penalty_windows(tables) {
  return [...group_by(of_penalties(tables), (row) => row.dt_s)].map(([dt_s, rows]) => {
    const good = rows
      .filter((row) => row.direct_distance_rel <= 0.01)
      .map((row) => row.penalty_per_s2);
    const tried = descent_rows(tables, 'penalty').filter((row) => row.dt_s === dt_s).length;
    return { dt_s, tried, good };
  });
}

// How far ways are from the direct step at `sweeps` of the springs.
export const distances_at = (tables, sweeps) =>
  all_sweeps(tables).filter((row) => row.model === 'mass_spring' && row.sweeps === sweeps);

// A node at a time and the whole, each by the time of a sweep.
function cost_finding(rows) {
  const of = (block) =>
    rows.find(
      (row) =>
        row.integrator === 'vbd' && row.block === block && !(row.chebyshev > 0 || row.anderson > 0),
    );
  const [nodes, whole] = [of(1), of(0)];
  if (!is_positive(nodes?.wall_s_per_sim_s) || !is_positive(whole?.wall_s_per_sim_s)) return [];
  const time = (row) => format_time((row.wall_s_per_sim_s * row.dt_s) / row.sweeps);
  return [`A sweep of \`vbd\` takes ${time(nodes)} node by node, ${time(whole)} over the whole strand.`];
}

export function descent_findings(tables) {
  const sweeps = 20;
  const rows = distances_at(tables, sweeps);
  if (rows.length === 0) return [];
  const listed = rows
    .map((row) => `${row.way} ${format_number(row.direct_distance_rel)}`)
    .join('; ');
  return [
    `Distance of the tip from that of the direct step over the length, after ${sweeps} sweeps per step of ` +
      `${format_time(rows[0].dt_s)}: ${listed}.`,
    ...cost_finding(rows),
    ...penalty_windows(tables).map(({ dt_s, tried, good }) =>
      good.length === 0
        ? `Steps of ${format_time(dt_s)}: none of the ${tried} tried penalties comes within 1 %.`
        : `Steps of ${format_time(dt_s)}: penalties within 1 % of the direct step from ` +
          `${power(Math.min(...good))} to ${power(Math.max(...good))} 1/s².`,
    ),
  ];
}

function curve(rows, title, x, { panel_width, legend, style, y }) {
  return {
    title,
    width: panel_width,
    height: 320,
    layer: marked_line(rows, {
      x,
      y,
      series: series_channels('way', 'method', style, legend),
      opacity: dimmed_unless(['pick_way']),
      tooltip: tooltips([
        ['way', 'method'],
        ['model', 'model'],
        ['sweeps', 'sweeps'],
        ['dt_s', 'dt (s)'],
        ['penalty_per_s2', 'penalty (1/s²)'],
        ['direct_distance_rel', 'off the direct step, over the length', '.3g'],
        ['error_rel', 'off the rod, over the length', '.3g'],
        ['energy_distance_rel', 'energy off the direct step’s, over m g L', '.3g'],
        ['wall_s_per_sim_s', 'wall time per simulated second (s)', '.3g'],
      ]),
    }),
  };
}

export const block_descent = {
  id: 'block_descent',
  title: 'Sweeps of block descent, and the size of blocks',
  table: 'block_descent',
  headline(tables) {
    const sweeps = 20;
    const rows = distances_at(tables, sweeps);
    const best = minimum_by(rows, (row) => row.distance);
    const nodes = rows.find((row) => row.way === 'vbd');
    const text = (row) => `“${row.way}” is ${format_number(100 * row.distance, 2)} % of the length`;
    return best === undefined
      ? 'Distance from the direct step'
      : `After ${sweeps} sweeps per step, ${distinct([nodes, best].filter(Boolean)).map(text).join(', ')} away from the direct step`;
  },
  reading: `Distance of the tip of the swinging strand from the direct solution of the same steps; lower is better. Left: blocks
    from one node to the whole strand. Right: 20 sweeps of vbd_augmented by its penalty.`,
  caption: `Distance of the tip of the swinging strand of 20 elements from that of the direct
    solution of the same steps, root mean square over the run and over the length; down is
    better, distances below 1e-10 are drawn there. Left: against the sweeps of a step of
    1/300 s, for blocks of one node to the whole strand. Right: 20 sweeps of vbd_augmented
    against its penalty. Made from block_descent.csv; methods that differ by less than a factor of ${coincide} everywhere are drawn as one line; failed runs are in the table
    only.`,

  rows: (tables) => [...of_sweeps(tables), ...of_penalties(tables)],

  spec(tables, { width }) {
    const sweeps = [...group_by(of_sweeps(tables), (row) => row.model)];
    const penalties = of_penalties(tables);
    const style = name_style(this.rows(tables).map((row) => row.way));
    const count = sweeps.length + (penalties.length > 0 ? 1 : 0);
    const { columns, panel_width, legend } = layout(width, count, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const y = log_channel(
      'distance',
      'off the direct step / length',
      log_extent(this.rows(tables).map((row) => row.distance)),
    );
    const shared = { panel_width, legend, style, y };
    const list = sweeps.map(([model, rows]) =>
      curve(
        rows,
        model.replaceAll('_', ' '),
        log_channel('sweeps', 'sweeps per step', log_extent(rows.map((row) => row.sweeps))),
        shared,
      ),
    );
    if (penalties.length > 0) {
      const x = log_channel(
        'penalty_per_s2',
        'penalty (1/s²)',
        log_extent(penalties.map((row) => row.penalty_per_s2)),
      );
      list.push(curve(penalties, 'the window of the penalty', x, shared));
    }
    return panels(with_parameters(list, [legend_selection('pick_way', 'way')]), columns);
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Distance of the tip from the direct step's over the length, log scale, against
      sweeps and against the penalty, for ${distinct(rows.map((row) => row.way)).length}
      methods and sizes of blocks.`;
  },
};
