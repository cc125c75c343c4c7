// Figure 3: how long a violated start takes to recover, against the damping of the
// feedback.
import { distinct, group_by, is_positive, minimum_by, succeeded } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
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

export const damping_ratio = (row) => row.beta / (2 * Math.sqrt(row.alpha));

export const drift_recovery = {
  id: 'drift_recovery',
  title: 'Recovery from a violated start',
  table: 'constraint_drift',
  headline(tables) {
    const rows = this.rows(tables);
    const recovered = rows.filter((row) => row.recovered);
    const best = minimum_by(recovered, (row) => row.recovery_time_s);
    return best === undefined
      ? `None of ${rows.length} runs recovers`
      : `Recovery is fastest at ${format_number(best.ratio, 2)} times critical damping: ` +
          `${format_time(best.recovery_time_s)}; ${recovered.length} of ${rows.length} runs recover`;
  },
  reading: `Runs that start off the constraint. Left of critical damping the violation oscillates, right of it it decays
    slowly. Crosses at the top edge did not recover within the run.`,
  caption: `Runs that start off the constraint on purpose: time until the violation has
    decayed, against beta / (2 sqrt(alpha)). The vertical line at 1 is critical damping; left of
    it the violation oscillates, right of it it decays slowly. Crosses at the top edge did
    not recover within the run. Made from the rows of constraint_drift.csv whose study is
    "recovery".`,

  rows: (tables) =>
    (tables.constraint_drift ?? [])
      .filter(
        (row) =>
          row.study === 'recovery' && is_positive(row.alpha) && is_positive(row.beta),
      )
      .map((row) => ({
        ...row,
        ratio: damping_ratio(row),
        recovered: succeeded(row) && is_positive(row.recovery_time_s),
      })),

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const key = (row) => [row.system, row.alpha, row.dt_s, row.violation].join('|');
    const varied = ['system', 'alpha', 'dt_s', 'violation'].filter(
      (name) => distinct(rows.map((row) => row[name])).length > 1,
    );
    const unit = { alpha: ' 1/s²', dt_s: ' s', violation: ' m' };
    const groups = [...group_by(rows, key).values()];
    const style = series_style(rows.map((row) => row.integrator));
    const { columns, panel_width, legend } = layout(width, groups.length, {
      columns_max: 2,
      labels: style.domain,
    });
    const shown_legend = style.domain.length > 1 ? legend : null;
    const y_extent = log_extent(
      rows.filter((r) => r.recovered).map((r) => r.recovery_time_s),
      5,
    );
    const y = log_channel('recovery_time_s', 'recovery time (s)', y_extent);
    const list = groups.map((members) => {
      const x = log_channel(
        'ratio',
        'beta / (2 sqrt(alpha))',
        log_extent([...members.map((row) => row.ratio), 1]),
      );
      const recovered = members.filter((row) => row.recovered);
      const rule = [{ ratio: 1, text: 'critical damping' }];
      const tooltip = tooltips([
        ['integrator', 'integrator'],
        ['ratio', 'beta / (2 sqrt(alpha))', '.3f'],
        ['recovery_time_s', 'recovery time (s)', '.3e'],
        ['overshoot', 'overshoot', '.3e'],
        ['alpha', 'alpha (1/s²)'],
        ['beta', 'beta (1/s)'],
        ['dt_s', 'dt (s)'],
        ['status', 'status'],
        ['reason', 'reason'],
      ]);
      return {
        title: varied
          .map((name) =>
            name === 'system'
              ? members[0].system.replaceAll('_', ' ')
              : `${name.replace('_s', '')} = ${format_number(members[0][name])}${unit[name]}`,
          )
          .join(', '),
        width: panel_width,
        height: 290,
        layer: [
          {
            data: { values: recovered },
            mark: { type: 'line', strokeWidth: 1.8 },
            encoding: {
              x,
              y,
              ...series_channels('integrator', 'integrator', style, shown_legend),
              shape: undefined,
              opacity: dimmed_unless(['pick_integrator']),
            },
          },
          {
            data: { values: recovered },
            mark: { type: 'point', size: 60, strokeWidth: 1.6, filled: true },
            encoding: {
              x,
              y,
              ...series_channels('integrator', 'integrator', style, shown_legend),
              strokeDash: undefined,
              tooltip,
              opacity: dimmed_unless(['pick_integrator']),
            },
          },
          {
            data: { values: members.filter((row) => !row.recovered) },
            mark: {
              type: 'point',
              shape: 'M-0.7,-0.7L0.7,0.7M-0.7,0.7L0.7,-0.7',
              size: 60,
              y: 6,
              strokeWidth: 1.8,
            },
            encoding: {
              x,
              color: series_channels('integrator', 'integrator', style, shown_legend).color,
              tooltip,
              opacity: dimmed_unless(['pick_integrator']),
            },
          },
          {
            data: { values: rule },
            mark: { type: 'rule', strokeDash: [4, 4], color: theme.text },
            encoding: { x: { ...x, field: 'ratio' } },
          },
          {
            data: { values: rule },
            mark: {
              type: 'text',
              align: 'left',
              dx: 6,
              y: 'height',
              dy: -8,
              fontSize: 11,
              color: theme.muted,
            },
            encoding: { x, text: { field: 'text' } },
          },
        ],
      };
    });
    return panels(
      with_parameters(list, [legend_selection('pick_integrator', 'integrator')]),
      columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Recovery time in seconds against beta squared over four alpha, log-log, one
      line per integrator, critical damping marked at one: ${rows.length} runs,
      ${rows.filter((row) => !row.recovered).length} did not recover.`;
  },
};
