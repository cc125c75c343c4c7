// Figures 13 and 14: how many sweeps of block descent make a step, and where stable
// Cosserat rods are right.
import { distinct, group_by, is_number, is_positive, succeeded } from '../src/tables.mjs';
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
import { cell_fills, model_style } from './palette.mjs';

const least = 1e-10; // distances below it are rounding

// 1e8, 25
const power = (x) =>
  x >= 1e4 ? Number(x.toPrecision(2)).toExponential().replace('e+', 'e') : format_number(x);

export const descent_rows = (tables, part) =>
  (tables.block_descent ?? []).filter((row) => row.part === part);

// "vbd, blocks of 4"
export function way_of(row) {
  if (row.integrator === 'xpbd' || row.integrator === 'stable_cosserat_rods') return row.integrator;
  const block =
    row.block === 0 ? ', whole' : row.block === 1 ? '' : `, blocks of ${row.block}`;
  return row.integrator + block + (row.chebyshev > 0 ? ', Chebyshev' : '');
}

const drawn = (rows) =>
  rows
    .filter((row) => succeeded(row) && is_positive(row.direct_distance_rel))
    .map((row) => ({
      ...row,
      distance: Math.max(row.direct_distance_rel, least),
    }));

const of_sweeps = (tables) =>
  drawn(descent_rows(tables, 'sweeps')).map((row) => ({ ...row, way: way_of(row) }));

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
      .map((row) => row.penalty_1_s2);
    const tried = descent_rows(tables, 'penalty').filter((row) => row.dt_s === dt_s).length;
    return { dt_s, tried, good };
  });
}

// How far ways are from the direct step at `sweeps` of the springs.
export const distances_at = (tables, sweeps) =>
  of_sweeps(tables).filter((row) => row.model === 'mass_spring' && row.sweeps === sweeps);

// A node at a time and the whole, each by the time of a sweep.
function cost_finding(rows) {
  const of = (block) =>
    rows.find((row) => row.integrator === 'vbd' && row.block === block && !(row.chebyshev > 0));
  const [nodes, whole] = [of(1), of(0)];
  if (!is_positive(nodes?.wall_s_per_sim_s) || !is_positive(whole?.wall_s_per_sim_s)) return [];
  const time = (row) => format_time((row.wall_s_per_sim_s * row.dt_s) / row.sweeps);
  return [`A sweep of vbd takes ${time(nodes)} node by node, ${time(whole)} over the whole strand.`];
}

export function descent_findings(tables) {
  const sweeps = 20;
  const rows = distances_at(tables, sweeps);
  if (rows.length === 0) return [];
  const listed = rows
    .map((row) => `${row.way} ${format_number(row.direct_distance_rel)}`)
    .join('; ');
  return [
    `Distance of the tip from the direct step's at ${sweeps} sweeps of ` +
      `${format_time(rows[0].dt_s)}, over the length: ${listed}.`,
    ...cost_finding(rows),
    ...penalty_windows(tables).map(({ dt_s, tried, good }) =>
      good.length === 0
        ? `Steps of ${format_time(dt_s)}: no penalty of ${tried} comes within 1 %.`
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
        ['penalty_1_s2', 'penalty (1/s²)'],
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
  caption: `Distance of the tip of the swinging strand of 20 elements from that of the direct
    solution of the same steps, root mean square over the run and over the length; down is
    better, what is below 1e-10 is drawn there. Left: against the sweeps of a step of
    1/300 s, for blocks of one node to the whole strand. Right: 20 sweeps of vbd_augmented
    against its penalty. Made from block_descent.csv; runs that come apart are in the table
    only.`,

  rows: (tables) => [...of_sweeps(tables), ...of_penalties(tables)],

  spec(tables, { width }) {
    const sweeps = [...group_by(of_sweeps(tables), (row) => row.model)];
    const penalties = of_penalties(tables);
    const style = model_style(this.rows(tables).map((row) => row.way));
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
        'penalty_1_s2',
        'penalty (1/s²)',
        log_extent(penalties.map((row) => row.penalty_1_s2)),
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

// ---- the map of stable Cosserat rods

const bands = [
  { most: 0.01, name: 'at most 1 %', ...cell_fills.dark },
  { most: 0.05, name: 'at most 5 %', ...cell_fills.light },
  { most: 0.2, name: 'at most 20 %', ...cell_fills.middle },
  { most: Infinity, name: 'above 20 %, or apart', ...cell_fills.strong },
];

const rod_of = (row) =>
  `${row.scene === 'swing' ? 'hair' : row.scene}, ${power(row.stretch_over_bending)}`;

const measured = (row) => succeeded(row) && is_number(row.error_rel);

const cells = (tables) =>
  descent_rows(tables, 'rods').map((row) => {
    const error = measured(row) ? row.error_rel : Infinity;
    const band = bands.find(({ most }) => error <= most);
    return {
      ...row,
      rod: rod_of(row),
      rate: Math.round(1 / row.dt_s),
      band: band.name,
      ink: band.text,
      shown: Number.isFinite(error) ? format_number(100 * error) : '×',
    };
  });

export function map_findings(tables) {
  const all = cells(tables);
  if (all.length === 0) return [];
  const reached = all.filter((row) => row.band === bands[0].name);
  return [
    `${reached.length} of ${all.length} points of the map are within 1 % of the rod.`,
    ...[...group_by(all.filter(measured), (row) => row.rod)].map(([rod, rows]) => {
      const best = rows.reduce((a, b) => (b.error_rel < a.error_rel ? b : a));
      return (
        `${rod}: least error ${format_number(100 * best.error_rel)} %, at ` +
        `${best.rate} steps a second and ${best.sweeps} sweeps; the same step solved ` +
        `whole ${format_number(100 * best.direct_error_rel)} %.`
      );
    }),
  ];
}

function map_panel(rows, sweeps, { panel_width, legend, order, rates }) {
  const x = {
    field: 'rod',
    type: 'nominal',
    title: 'rod, EA L² / E I',
    sort: order,
    scale: { domain: order },
    axis: { labelAngle: -30, grid: false },
  };
  const y = {
    field: 'rate',
    type: 'nominal',
    title: 'steps a second',
    sort: rates,
    scale: { domain: rates },
    axis: { grid: false },
  };
  return {
    title: `${sweeps} sweeps`,
    width: panel_width,
    height: { step: 34 },
    layer: [
      {
        data: { values: rows },
        mark: { type: 'rect' },
        encoding: {
          x,
          y,
          color: {
            field: 'band',
            type: 'nominal',
            title: 'off the rod',
            scale: {
              domain: bands.map(({ name }) => name),
              range: bands.map(({ fill }) => fill),
            },
            legend,
          },
          tooltip: tooltips([
            ['rod', 'rod, EA L² / E I'],
            ['rate', 'steps a second'],
            ['sweeps', 'sweeps'],
            ['error_rel', 'off the rod, over the length', '.3g'],
            ['direct_distance_rel', 'off the direct step, over the length', '.3g'],
            ['wall_s_per_sim_s', 'wall time per simulated second (s)', '.3g'],
            ['status', 'status'],
          ]),
        },
      },
      ...bands.map(({ name, text }) => ({
        data: { values: rows.filter((row) => row.band === name) },
        mark: { type: 'text', fontSize: 11, color: text },
        encoding: { x, y, text: { field: 'shown' } },
      })),
    ],
  };
}

export const cosserat_map = {
  id: 'cosserat_map',
  title: 'Where stable Cosserat rods are right',
  table: 'block_descent',
  caption: `Error of the tip in per cent of the length, root mean square over two seconds, of
    stable_cosserat_rods. Columns: the swinging hair with the stretch of a hair (left) and
    softened, against the continuous rod that does not stretch, and the cantilever of the
    authors' code against its own edges without error of time. A cross: the run came apart.
    Made from block_descent.csv.`,

  rows: cells,

  spec(tables, { width }) {
    const all = cells(tables);
    const stiff_first = [...all].sort(
      (a, b) =>
        b.scene.localeCompare(a.scene) || b.stretch_over_bending - a.stretch_over_bending,
    );
    const order = distinct(stiff_first.map((row) => row.rod));
    const rates = distinct(all.map((row) => row.rate)).sort((a, b) => b - a);
    const groups = [...group_by(all, (row) => row.sweeps)].sort(([a], [b]) => a - b);
    const { columns, panel_width, legend } = layout(width, groups.length, {
      columns_max: 3,
      labels: bands.map(({ name }) => name),
      above: true,
    });
    return panels(
      groups.map(([sweeps, rows]) =>
        map_panel(rows, sweeps, { panel_width, legend, order, rates }),
      ),
      columns,
    );
  },

  describe(tables) {
    const all = cells(tables);
    return `Errors in per cent over the stretch stiffness and steps a second: ${all.length}
      points, ${all.filter((row) => row.band === bands[0].name).length} of them within 1 %.`;
  },
};
