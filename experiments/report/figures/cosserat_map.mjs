// Where stable Cosserat rods are accurate: over stiffness, steps per second and sweeps.
import { distinct, group_by, is_number, minimum_by, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { descent_rows, power } from './block_descent.mjs';
import { layout, panels, tooltips } from './common.mjs';
import { cell_fills } from './palette.mjs';

const bands = [
  { most: 0.01, name: 'at most 1 %', ...cell_fills.dark },
  { most: 0.05, name: 'at most 5 %', ...cell_fills.light },
  { most: 0.2, name: 'at most 20 %', ...cell_fills.middle },
  { most: Infinity, name: 'above 20 %, or unstable', ...cell_fills.strong },
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
        `${rod}: smallest error ${format_number(100 * best.error_rel)} %, with ` +
        `${best.rate} steps per second and ${best.sweeps} sweeps. A direct solution of the same step has an ` +
        `error of ${format_number(100 * best.direct_error_rel)} %.`
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
    title: 'steps per second',
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
            ['rate', 'steps per second'],
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
  headline(tables) {
    const all = cells(tables);
    const reached = all.filter((row) => row.band === bands[0].name);
    const rods = distinct(reached.map((row) => row.rod));
    const fewest = minimum_by(reached, (row) => row.sweeps * row.rate);
    return (
      `${reached.length} of ${all.length} settings of stable_cosserat_rods are within 1 % of the rod` +
      (rods.length === 1 ? `, all for “${rods[0]}”` : '') +
      (fewest ? `; the cheapest has ${fewest.rate} steps per second and ${fewest.sweeps} sweeps` : '')
    );
  },
  reading: `A number is the error of the tip in per cent of the length; × is an unstable run. Columns: rods, from stiff to soft in
    stretch over bending. Rows: steps per second. Panels: sweeps per step.`,
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
        map_panel(rows, sweeps, {
          panel_width,
          legend,
          order,
          rates: rates.filter((rate) => rows.some((row) => row.rate === rate)),
        }),
      ),
      columns,
    );
  },

  describe(tables) {
    const all = cells(tables);
    return `Errors in per cent over the stretch stiffness and steps per second: ${all.length}
      points, ${all.filter((row) => row.band === bands[0].name).length} of them within 1 %.`;
  },
};
