// Wall time against tip error on the swinging strand, compared with other simulators.
import { distinct, group_by, is_positive, minimum_by, swing_rows } from '../src/tables.mjs';
import { format_time } from '../src/format.mjs';
import { fastest_at, swing_levels, swing_runs } from '../src/strand.mjs';
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
import { family_name, family_style } from './palette.mjs';
import { simulator_points, ranking } from './swing_ranking.mjs';

// The runs of one series that no other run of it beats in both error and time.
export const front_of = (runs) =>
  runs.filter(
    (row) =>
      !runs.some(
        (other) =>
          other.error_rel <= row.error_rel &&
          other.wall_s <= row.wall_s &&
          (other.error_rel < row.error_rel || other.wall_s < row.wall_s),
      ),
  );

// Larger errors are useless answers, smaller ones are rounding: neither is drawn.
const error_range = [1e-7, 1];

const fronts = (tables, kind) =>
  [
    ...group_by(
      swing_runs(swing_rows(tables), kind).map((row) => ({
        ...row,
        family: family_name(row.integrator),
      })),
      (row) => row.family,
    ).values(),
  ]
    .flatMap(front_of)
    .filter(
      ({ error_rel }) =>
        error_rel >= error_range[0] && error_rel <= error_range[1],
    )
    .map((row) => ({
      ...row,
      error_pct: 100 * row.error_rel,
      wall_ms: 1e3 * row.wall_s,
    }));

const targets = swing_levels.map(({ error, target_s }) => ({
  error_pct: 100 * error,
  wall_ms: 1e3 * target_s,
  text: `${1e3 * target_s} ms`,
}));

function error_panel(title, rows, extra, { y_extent, x_extent, style, legend, ...look }) {
  const x = log_channel('error_pct', 'tip error (%)', x_extent);
  const y = log_channel('wall_ms', 'wall time (ms)', y_extent);
  const series = series_channels('family', 'family of integrators', style, legend);
  const opacity = dimmed_unless(['pick_family']);
  const halo = { fontSize: 11, align: 'left', dx: 11, baseline: 'middle' };
  const text = (mark) => ({
    data: { values: extra.targets },
    mark: { type: 'text', ...halo, ...mark },
    encoding: { x, y, text: { field: 'text' } },
  });
  return {
    title,
    width: look.panel_width,
    height: 260,
    layer: [
      {
        data: { values: rows },
        mark: { type: 'line', strokeWidth: 1.8 },
        encoding: {
          x,
          y,
          ...series,
          shape: undefined,
          order: { field: 'error_pct', type: 'quantitative' },
          opacity,
        },
      },
      {
        data: { values: extra.other_simulators },
        mark: {
          type: 'tick',
          orient: 'horizontal',
          size: 16,
          thickness: 1.5,
          color: look.theme.axis,
        },
        encoding: {
          x,
          y,
          tooltip: tooltips([
            ['simulator', 'simulator'],
            ['level', 'at an error of'],
            ['wall_ms', 'wall time (ms)', '.3g'],
          ]),
        },
      },
      {
        data: { values: rows },
        mark: { type: 'point', filled: true, size: 45 },
        encoding: {
          x,
          y,
          ...series,
          strokeDash: undefined,
          opacity,
          tooltip: tooltips([
            ['integrator', 'integrator'],
            ['model', 'model'],
            ['solver', 'solver'],
            ['modes', 'modes'],
            ['elements', 'elements'],
            ['dt_s', 'dt (s)'],
            ['rtol', 'rtol'],
            ['error_pct', 'tip error (%)', '.3g'],
            ['wall_ms', 'wall time (ms)', '.3g'],
            ['steps', 'steps'],
          ]),
        },
      },
      {
        data: { values: extra.targets },
        mark: {
          type: 'point',
          shape: 'circle',
          filled: false,
          size: 190,
          strokeWidth: 2,
          color: look.theme.text,
        },
        encoding: { x, y },
      },
      text({ stroke: look.theme.background, strokeWidth: 4, strokeJoin: 'round' }),
      text({ color: look.theme.text, fontWeight: 600 }),
    ],
  };
}

export const swing = {
  id: 'swing',
  title: 'A swinging strand at a stated error, with other simulators',
  table: 'work_precision',
  headline(tables) {
    const [level] = swing_levels;
    const best = fastest_at(swing_runs(swing_rows(tables), 'time'), level.error);
    const simulator = minimum_by(
      (tables.other_simulators_swing ?? []).filter((row) => is_positive(row[level.simulator])),
      (row) => row[level.simulator],
    );
    const ours = best
      ? `A time error of ${level.name} takes ${format_time(best.wall_s)} with ${best.series}`
      : `No run reaches a time error of ${level.name}`;
    return simulator
      ? `${ours}; published for the fastest other simulator (${simulator.simulator}): ${format_time(simulator[level.simulator])}`
      : ours;
  },
  reading: `Wall time of one core for 2 simulated seconds against the tip error; lower left is better. A line joins the runs of
    a family that none of its others beats. Time error: against fine steps of the same elements. Total error: against the rod.`,
  caption: `Tip error: root mean square over the run, over the length. Grey ticks
    at 1 % and 0.1 %, and the rows below, are other simulators as published: time error
    against their own finest run with 20 elements, measured on another machine of the same
    class, so trust ratios. Large rings are the targets, 20 ms and 50 ms. Errors under
    1e-5 % and over 100 % are not drawn. Made from
    work_precision.csv and other_simulators_swing.csv; failed runs are in the tables only.`,

  rows: (tables) => [...fronts(tables, 'time'), ...fronts(tables, 'total')],

  spec(tables, { width, theme }) {
    const style = family_style(this.rows(tables).map((row) => row.family));
    const other_simulators = simulator_points(tables);
    const kinds = [
      ['time', 'Time error', { other_simulators, targets }],
      ['total', 'Total error', { other_simulators: [], targets: [] }],
    ].filter(([kind]) => fronts(tables, kind).length > 0);
    const { columns, panel_width, legend } = layout(width, kinds.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const list = kinds.map(([kind, title, extra]) => {
      const rows = fronts(tables, kind);
      const all = [...rows, ...extra.other_simulators, ...extra.targets];
      return error_panel(title, rows, extra, {
        x_extent: log_extent(
          all.map((r) => r.error_pct),
          6,
        ),
        y_extent: log_extent(all.map((r) => r.wall_ms)),
        panel_width,
        legend,
        style,
        theme,
      });
    });
    const errors = panels(
      with_parameters(list, [legend_selection('pick_family', 'family')]),
      columns,
    );
    if (other_simulators.length === 0) return errors;
    // Two rows of their own, so that neither stretches the other's columns.
    return {
      vconcat: [errors, ranking(tables, { width, style, theme })],
      spacing: 30,
      resolve: errors.resolve,
    };
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Wall time in milliseconds against tip error in percent, log-log, one line for
      each of ${distinct(rows.map((r) => r.family)).length} families of integrators, the
      targets marked, and ${(tables.other_simulators_swing ?? []).length} published configurations of
      other simulators.`;
  },
};
