// What a groom costs when processes divide it: measured points, and the model's lines.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
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

const rows_of = ({ divided_heads = [] }) =>
  divided_heads
    .filter((row) => succeeded(row) && (row.kind === 'predicted' || row.beside === 1))
    .map((row) => ({
      ...row,
      measured: row.kind === 'measured',
      hairs: `${row.strands}`,
      model_ms: 1e3 * row.model_cost_per_step_s,
      cost_ms: 1e3 * (row.kind === 'measured' ? row.cost_per_step_s : row.model_cost_per_step_s),
    }))
    .filter((row) => is_positive(row.cost_ms));

export const divided_heads = {
  id: 'divided_heads',
  title: 'A groom that processes divide',
  table: 'divided_heads',
  caption: `Time of a step against the number of processes. Points are measured. Lines are a model of cost: solid
    through the measured numbers of hairs, dashed where it extrapolates to more hairs and more processes, and no run
    stands behind it. A panel for hairs that do not touch, and for hairs that do. Made from divided_heads.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const by_number = (a, b) => a - b;
    const style = series_style(distinct(rows.map((row) => row.strands)).sort(by_number).map(String));
    const groups = [...group_by(rows, (row) => row.effects)];
    const { columns, panel_width, legend } = layout(width, groups.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const x = log_channel('ranks', 'processes', log_extent(rows.map((row) => row.ranks)));
    const y = (field) =>
      log_channel(field, 'a step (ms)', log_extent(rows.map((row) => row.cost_ms)));
    const series = series_channels('hairs', 'hairs', style, legend);
    const opacity = dimmed_unless(['pick_hairs']);
    const tooltip = tooltips([
      ['hairs', 'hairs'],
      ['ranks', 'processes'],
      ['cost_ms', 'a step (ms)', '.3g'],
      ['model_ms', 'by the model (ms)', '.3g'],
      ['efficiency', 'efficiency of the model', '.2g'],
    ]);
    const line = (members, strokeDash) => ({
      data: { values: members.filter((row) => is_positive(row.model_ms)) },
      mark: { type: 'line', strokeWidth: 1.4, strokeDash },
      encoding: { x, y: y('model_ms'), color: series.color, opacity },
    });
    const label = (members, more) => ({
      data: { values: members },
      mark: { type: 'text', fontSize: 10, color: theme.muted, align: 'left', ...more },
      encoding: { x, y: y('cost_ms'), text: { field: 'hairs' } },
    });
    const last = Math.max(...rows.filter((row) => row.measured).map((row) => row.ranks));
    const first_beyond = Math.min(
      ...rows.filter((row) => !row.measured && row.ranks > last).map((row) => row.ranks),
    );
    return panels(
      with_parameters(
        groups.map(([title, members]) => ({
          title,
          width: panel_width,
          height: 240,
          layer: [
            line(members.filter((row) => !row.measured), [5, 3]),
            line(members.filter((row) => row.measured), [1, 0]),
            {
              data: { values: members.filter((row) => row.measured) },
              mark: { type: 'point', filled: true, size: 60 },
              encoding: { x, y: y('cost_ms'), ...series, strokeDash: undefined, opacity, tooltip },
            },
            label(members.filter((row) => row.measured && row.ranks === last), { dx: 8 }),
            label(members.filter((row) => !row.measured && row.ranks === first_beyond), { dx: 4, dy: -6 }),
          ],
        })),
        [legend_selection('pick_hairs', 'hairs')],
      ),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    const measured = rows.filter((row) => row.measured);
    return `Time of a step in milliseconds against the number of processes, both log scale:
      ${measured.length} measured points of at most
      ${Math.max(...measured.map((row) => row.strands))} hairs and
      ${Math.max(...measured.map((row) => row.ranks))} processes; beyond that lines of a model only.`;
  },
};
