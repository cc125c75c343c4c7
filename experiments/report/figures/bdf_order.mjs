// Figure 5: what the maximum order of a BDF method does on a nearly undamped rod.
import { distinct, group_by, is_positive, minimum_by, order_rows, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { bdf_comparison } from '../src/findings/work.mjs';
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
import { name_style, palette } from './palette.mjs';

const measures = [
  ['steps', 'steps'],
  ['wall_s', 'wall time (s)'],
];

const is_bdf = (row) => row.integrator === 'cvode_bdf' && is_positive(row.max_order);
const most_series = palette.length;

// BDF by maximum order first, then the other integrators that reach the least errors.
function drawn_rows(tables) {
  const rows = order_rows(tables)
    .filter((row) => succeeded(row) && is_positive(row.error_rel))
    .map((row) => ({ dt_s: null, ...row, tightness: row.rtol ?? row.dt_s }));
  const orders = distinct(
    rows
      .filter(is_bdf)
      .sort((a, b) => a.max_order - b.max_order)
      .map((row) => row.label),
  );
  const best = rows.filter((row) => !is_bdf(row)).sort((a, b) => a.error_rel - b.error_rel);
  const kept = [...orders, ...distinct(best.map((row) => row.label))].slice(0, most_series);
  return kept.flatMap((label) => rows.filter((row) => row.label === label));
}

// "Orders above 2 lose: at rtol 0.001, order 5 takes 16800 steps, order 2 takes 231"
function headline(tables) {
  const rows = order_rows(tables);
  const highest = Math.max(...rows.filter(is_bdf).map((row) => row.max_order));
  const pairs = bdf_comparison(rows, 2, highest);
  const worst = minimum_by(pairs, ({ low, high }) => -high / low);
  return worst === undefined
    ? 'Steps and time of BDF by maximum order'
    : `At rtol ${format_number(worst.rtol)}, BDF takes ${worst.high} steps with orders up to ${highest}, and ` +
        `${worst.low} steps with orders up to 2`;
}

export const bdf_order = {
  id: 'bdf_order',
  title: 'BDF order on a rod',
  table: 'work_precision',
  headline,
  reading: `cvode_bdf with its order limited to 1 to 5, and other integrators; lower left is better. BDF of order 3 and more is
    not A-stable near the imaginary axis, where the undamped bending waves of a rod lie.`,
  caption: `Steps and wall time against the error reached. A line runs from loose to tight, and turns back where tighter
    tolerances give larger errors. Integrators beyond ${most_series} series, and failed runs, are in the table only. Made from work_precision.csv.`,

  rows: drawn_rows,

  spec(tables, { width }) {
    const rows = this.rows(tables);
    const style = name_style(rows.map((row) => row.label));
    const scenes = [...group_by(rows, (row) => row.scene)];
    const { columns, panel_width, legend } = layout(
      width,
      scenes.length * measures.length,
      { columns_max: 2, labels: style.domain, above: true },
    );
    const list = scenes.flatMap(([scene, members]) =>
      measures.map(([field, title]) => {
        const drawn = members.filter((row) => is_positive(row[field]));
        const x = log_channel(
          'error_rel',
          'relative error',
          log_extent(
            members.map((r) => r.error_rel),
            6,
          ),
        );
        const y = log_channel(
          field,
          title,
          log_extent(
            drawn.map((r) => r[field]),
            6,
          ),
        );
        const series = series_channels('label', 'integrator (<= n: order at most n)', style, legend);
        const opacity = dimmed_unless(['pick_label']);
        return {
          title: `${scene.replaceAll('_', ' ')}: ${title.replace(' (s)', '')}`,
          width: panel_width,
          height: 320,
          layer: [
            {
              data: { values: drawn },
              mark: { type: 'line', strokeWidth: 1.8 },
              encoding: {
                x,
                y,
                ...series,
                shape: undefined,
                opacity,
                order: { field: 'tightness', type: 'quantitative' },
              },
            },
            {
              data: { values: drawn },
              mark: { type: 'point', filled: true, size: 65 },
              encoding: {
                x,
                y,
                ...series,
                strokeDash: undefined,
                opacity,
                tooltip: tooltips([
                  ['label', 'run'],
                  ['integrator', 'integrator'],
                  ['max_order', 'max order'],
                  ['rtol', 'rtol'],
                  ['dt_s', 'dt (s)'],
                  ['error_rel', 'relative error', '.3e'],
                  ['scd', 'correct digits'],
                  ['steps', 'steps'],
                  ['wall_s', 'wall time (s)', '.3e'],
                ]),
              },
            },
          ],
        };
      }),
    );
    return panels(
      with_parameters(list, [legend_selection('pick_label', 'label')]),
      columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Two log-log charts, steps and wall time against relative error, for
      ${distinct(rows.map((r) => r.label)).length} methods: cvode_bdf by maximum order, and
      others to compare with.`;
  },
};
