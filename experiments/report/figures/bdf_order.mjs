// Figure 5: what the maximum order of a BDF method does on a nearly undamped rod.
import { distinct, group_by, is_positive, order_rows, succeeded } from '../src/tables.mjs';
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
import { order_colours, series_style, shapes } from './palette.mjs';

const measures = [
  ['steps', 'steps'],
  ['wall_s', 'wall time (s)'],
];

// BDF orders share one ramp and go first; everything else keeps its family colour.
function label_style(rows) {
  const bdf = rows.filter(
    (row) => row.integrator === 'cvode_bdf' && is_positive(row.max_order),
  );
  const orders = new Map(bdf.map((row) => [row.label, row.max_order]));
  const first = [...orders].sort((a, b) => a[1] - b[1]);
  const others = [
    ...new Map(
      rows
        .filter((row) => !orders.has(row.label))
        .map((row) => [row.label, row.integrator]),
    ),
  ];
  const base = series_style(others.map(([, integrator]) => integrator));
  const of = (integrator) => base.domain.indexOf(integrator);
  others.sort((a, b) => of(a[1]) - of(b[1]) || a[0].localeCompare(b[0]));
  return {
    domain: [...first.map(([label]) => label), ...others.map(([label]) => label)],
    colours: [
      ...first.map(([, order]) => order_colours[(order - 1) % order_colours.length]),
      ...others.map(([, integrator]) => base.colours[of(integrator)]),
    ],
    dashes: [...first.map(() => [1, 0]), ...others.map(() => [6, 3])],
    shapes: [...first, ...others].map((_, i) => shapes[i % shapes.length]),
  };
}

export const bdf_order = {
  id: 'bdf_order',
  title: 'BDF order on a rod',
  table: 'work_precision',
  caption: `Steps and wall time against the error reached, cvode_bdf held to maximum order
    1 to 5 (solid) against other integrators (dashed); down and left is better. BDF of
    order 3 and more is not A-stable near the imaginary axis, where a rod's undamped
    bending waves lie; how much that costs is what to read here. Click a legend entry to
    keep it and dim the others. Made from work_precision.csv; failed runs are in the table
    only.`,

  rows: (tables) =>
    order_rows(tables)
      .filter((row) => succeeded(row) && is_positive(row.error_rel))
      .map((row) => ({ dt_s: null, ...row, tightness: row.rtol ?? row.dt_s })),

  spec(tables, { width }) {
    const rows = this.rows(tables);
    const style = label_style(rows);
    const scenes = [...group_by(rows, (row) => row.scene)];
    const { columns, panel_width, legend } = layout(
      width,
      scenes.length * measures.length,
      { columns_max: 2, labels: style.domain },
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
        const series = series_channels('label', 'integrator', style, legend);
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
