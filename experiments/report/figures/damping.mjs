// Energy that methods take from a hair that swings without friction.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
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
import { series_style } from './palette.mjs';

const rows_of = ({ damping = [] }) =>
  damping
    .filter(succeeded)
    .map((row) => ({
      ...row,
      dt_ms: 1e3 * row.dt_s,
      lost_pct: 100 * row.energy_lost_rel,
      change_pct: 100 * Math.abs(row.energy_lost_rel),
    }))
    .filter((row) => is_positive(row.change_pct));

export const damping = {
  id: 'damping',
  title: 'Energy that a method takes',
  table: 'damping',
  caption: `What a hair that was let go has less of its energy after a second without friction, against the step: lost or gained, over
    what a fall to rest would free. A panel per model. Made from damping.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    const models = [...group_by(rows, (row) => row.model)];
    const style = series_style(rows.map((row) => row.integrator));
    const { columns, panel_width, legend } = layout(width, models.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const x = log_channel('dt_ms', 'step (ms)', log_extent(rows.map((row) => row.dt_ms)));
    const y = log_channel(
      'change_pct',
      'energy lost or gained (%)',
      log_extent(rows.map((row) => row.change_pct)),
    );
    const series = series_channels('integrator', 'method', style, legend);
    const opacity = dimmed_unless(['pick_damping']);
    const tooltip = tooltips([
      ['integrator', 'method'],
      ['elements', 'elements'],
      ['dt_ms', 'step (ms)', '.3g'],
      ['lost_pct', 'lost (%)', '.3g'],
    ]);
    return panels(
      with_parameters(
        models.map(([model, members]) => ({
          title: spaced(model),
          width: panel_width,
          height: 240,
          layer: marked_line(members, { x, y, series, opacity, tooltip }),
        })),
        [legend_selection('pick_damping', 'integrator')],
      ),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Energy lost or gained in percent against the step, both log scale, for
      ${distinct(rows.map((row) => row.integrator)).length} methods and
      ${distinct(rows.map((row) => row.model)).length} models.`;
  },
};
