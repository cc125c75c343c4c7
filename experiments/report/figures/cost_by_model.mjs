// The cost of every strand model at the same error, and its change of angular momentum.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
import { code, spaced, variant_name } from '../src/strand.mjs';
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
import { series_style } from './palette.mjs';

const rows_of = (tables) =>
  (tables.cost_of_accuracy ?? [])
    .filter(
      (row) =>
        row.kind === 'method' && succeeded(row) && is_positive(row.wall_s_per_sim_s),
    )
    .map((row) => ({
      ...row,
      name: variant_name({ ...row, variant: row.options }),
      wall_ms: 1e3 * row.wall_s_per_sim_s,
      dt_ms: 1e3 * row.dt_s,
      error_pct: 100 * row.error_rel,
    }));

const cheapest = (members) =>
  members.reduce((best, row) => (row.wall_ms < best.wall_ms ? row : best));

// Of every model its cheapest run, the cheapest first.
const ranked = (rows) =>
  [...group_by(rows, (row) => row.name).values()]
    .map(cheapest)
    .sort((a, b) => a.wall_ms - b.wall_ms);

export function cost_by_model_findings(tables) {
  return [...group_by(rows_of(tables), (row) => row.scene)].map(
    ([scene, members]) =>
      `${spaced(scene)}, wall time per simulated second for 1 %, each model with its cheapest ` +
      'method: ' +
      ranked(members)
        .map(
          (row) =>
            `${code(row.model)} ${format_time(row.wall_s_per_sim_s)} (${code(row.integrator)}, ` +
            `${row.elements} elements, steps of ${format_time(row.dt_s)}, lengths off by ` +
            `${format_number(row.length_error_rel)})`,
        )
        .join('; ') +
      '.',
  );
}

function panel(rows, title, names, field, axis, { panel_width, legend, style }) {
  const drawn = rows.filter((row) => is_positive(row[field]));
  const x = log_channel(field, axis, log_extent(drawn.map((row) => row[field]), 6));
  const y = {
    field: 'name',
    type: 'nominal',
    title: null,
    scale: { domain: names },
    axis: { labelLimit: 0, grid: true },
  };
  return {
    title,
    width: panel_width,
    height: { step: 24 },
    layer: [
      {
        data: { values: drawn },
        mark: { type: 'point', filled: true, size: 75 },
        encoding: {
          x,
          y,
          ...series_channels('integrator', 'integrator', style, legend),
          strokeDash: undefined,
          opacity: dimmed_unless(['pick_integrator']),
          tooltip: tooltips(
            [
              ['name', 'model'],
              ['integrator', 'integrator'],
              ['formulation', 'constraints'],
              ['elements', 'elements'],
              ['dt_ms', 'step (ms)', '.3g'],
              ['error_pct', 'tip error (%)', '.3g'],
              ['wall_ms', 'time per simulated second (ms)', '.3g'],
              ['length_error_rel', 'length error', '.2g'],
              ['angular_error_rel', 'angular momentum error', '.2g'],
              ['energy_error_rel', 'energy error', '.2g'],
            ].filter(([known]) => drawn.some((row) => row[known] != null)),
          ),
        },
      },
    ],
  };
}

export const cost_by_model = {
  id: 'cost_by_model',
  title: 'The cost of 1 %, model by model',
  table: 'cost_of_accuracy',
  headline(tables) {
    const rows = rows_of(tables);
    const best = [...group_by(rows, (row) => `${row.scene}|${row.name}`).values()].map(cheapest);
    const [[first, { length }]] = [...group_by(best, (row) => row.integrator)].sort(
      (a, b) => b[1].length - a[1].length,
    );
    const said = [...group_by(rows, (row) => row.scene)].map(([scene, members]) => {
      const [row] = ranked(members);
      return `${row.name} is the cheapest model of “${spaced(scene)}” (${format_time(row.wall_s_per_sim_s)})`;
    });
    return `${said.join(', ')}; ${first} is the cheapest integrator for ${length} of ${best.length} models`;
  },
  reading: `The cheapest run of each model and integrator with a tip error of 1 % of the length or less; left is better. The
    cheapest model is on top.`,
  caption: `For every strand model and integrator the cheapest number of elements and step
    with a tip error of 1 % of the length or less, against the continuous rod. First
    a clamped hair that is released horizontally, then a curved one in free flight, spinning; last
    the change of the angular momentum of the flying hair in those runs. Models or integrators
    without a mark found no such run. Made from cost_of_accuracy.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    const style = series_style(rows.map((row) => row.integrator));
    const scenes = [...group_by(rows, (row) => row.scene)];
    const { columns, panel_width, legend } = layout(width, scenes.length + 1, {
      columns_max: 1,
      labels: style.domain,
      above: true,
    });
    const shared = { panel_width: Math.max(160, panel_width - 120), legend, style };
    const names = (members) => ranked(members).map((row) => row.name);
    const list = scenes.map(([scene, members]) =>
      panel(
        members,
        `${spaced(scene)}: cost`,
        names(members),
        'wall_ms',
        'wall time per simulated second (ms)',
        shared,
      ),
    );
    const thrown = rows.filter((row) => is_positive(row.angular_error_rel));
    if (thrown.length > 0) {
      list.push(
        panel(
          thrown,
          `${spaced(thrown[0].scene)}: angular momentum`,
          names(thrown),
          'angular_error_rel',
          'largest change / value',
          shared,
        ),
      );
    }
    return panels(
      with_parameters(list, [legend_selection('pick_integrator', 'integrator')]),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Time per simulated second, log scale, of the cheapest run within 1 % by
      ${distinct(rows.map((row) => row.name)).length} models and
      ${distinct(rows.map((row) => row.integrator)).length} integrators, and the change of
      angular momentum in those runs.`;
  },
};
