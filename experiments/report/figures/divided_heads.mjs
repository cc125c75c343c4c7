// What a head costs when processes divide it: measured, and by the model.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
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

const rows_of = ({ divided_heads = [] }) =>
  divided_heads
    .filter(succeeded)
    .filter((row) => row.kind === 'predicted' && is_positive(row.model_cost_per_step_s))
    .map((row) => ({
      ...row,
      cost_ms: 1e3 * row.model_cost_per_step_s,
      hairs: `${row.strands}`,
    }));

export const divided_heads = {
  id: 'divided_heads',
  title: 'A head that processes divide',
  table: 'divided_heads',
  caption: `Time of a step against the number of processes, by the model that one and two processes were measured for, from 10 000 to 10
    million hairs on one scalp. A panel for hairs that do not touch, and for hairs that do. Made from divided_heads.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    const effects = [...group_by(rows, (row) => row.effects)];
    const style = series_style(rows.map((row) => row.hairs));
    const { columns, panel_width, legend } = layout(width, effects.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const x = log_channel('ranks', 'processes', log_extent(rows.map((row) => row.ranks)));
    const y = log_channel(
      'cost_ms',
      'a step (ms)',
      log_extent(rows.map((row) => row.cost_ms)),
    );
    const series = series_channels('hairs', 'hairs', style, legend);
    const opacity = dimmed_unless(['pick_divided_heads']);
    const tooltip = tooltips([
      ['hairs', 'hairs'],
      ['ranks', 'processes'],
      ['cost_ms', 'a step (ms)', '.3g'],
      ['efficiency', 'efficiency', '.2g'],
    ]);
    return panels(
      with_parameters(
        effects.map(([title, members]) => ({
          title,
          width: panel_width,
          height: 240,
          layer: marked_line(members, { x, y, series, opacity, tooltip }),
        })),
        [legend_selection('pick_divided_heads', 'hairs')],
      ),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Time of a step in milliseconds against the number of processes, both log scale, for
      ${distinct(rows.map((row) => row.hairs)).length} numbers of hairs.`;
  },
};
