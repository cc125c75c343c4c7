// What a groom costs when processes divide it: measured points, and the model's lines.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
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
import { name_style } from './palette.mjs';

// "1000", "10 k", "1 M"
const hairs_name = (count) =>
  count >= 1e6 ? `${count / 1e6} M` : count >= 1e4 ? `${count / 1e3} k` : `${count}`;

const rows_of = ({ divided_heads = [] }) =>
  divided_heads
    .filter((row) => succeeded(row) && (row.kind === 'predicted' || row.beside === 1))
    .map((row) => ({
      ...row,
      measured: row.kind === 'measured',
      hairs: hairs_name(row.strands),
      model_ms: 1e3 * row.model_cost_per_step_s,
      cost_ms: 1e3 * (row.kind === 'measured' ? row.cost_per_step_s : row.model_cost_per_step_s),
    }))
    .filter((row) => is_positive(row.cost_ms));

const effects_words = {
  drag: 'hairs that do not touch',
  interaction: 'hairs that touch',
};

// The largest measured numbers, and how much the most processes gain there, by effects.
function headline(tables) {
  const measured = rows_of(tables).filter((row) => row.measured);
  const most = Math.max(...measured.map((row) => row.strands));
  const ranks = Math.max(...measured.map((row) => row.ranks));
  const gains = [...group_by(measured.filter((row) => row.strands === most), (row) => row.effects)]
    .map(([effects, members]) => {
      const of = (count) => members.find((row) => row.ranks === count)?.cost_ms;
      return [effects, of(1) / of(ranks)];
    })
    .filter(([, gain]) => Number.isFinite(gain))
    .map(([effects, gain]) => `${format_number(gain, 2)} times as fast as one (${effects_words[effects] ?? effects})`);
  const said = gains.length > 0 ? `: ${ranks} processes are ${gains.join(', ')}` : '';
  return `Measured up to ${hairs_name(most)} hairs and ${ranks} processes${said}; everything beyond is a cost model`;
}

export const divided_heads = {
  id: 'divided_heads',
  title: 'A groom that processes divide',
  table: 'divided_heads',
  headline,
  reading: `Points are measured. Lines are the cost model: solid through measured numbers of hairs, dashed beyond. No run
    supports the shaded part.`,
  caption: `Time of a step against the number of processes, for hairs that do not touch and for hairs that do. The efficiency
    of the model is in the tooltips. Made from divided_heads.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const by_number = (a, b) => a - b;
    const style = name_style(distinct(rows.map((row) => row.strands)).sort(by_number).map(hairs_name));
    const groups = [...group_by(rows, (row) => row.effects)];
    const { columns, panel_width, legend } = layout(width, groups.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const x = log_channel('ranks', 'processes', log_extent(rows.map((row) => row.ranks)));
    const y = (field) =>
      log_channel(field, 'time of a step (ms)', log_extent(rows.map((row) => row.cost_ms)));
    const series = series_channels('hairs', 'hairs', style, legend);
    const opacity = dimmed_unless(['pick_hairs']);
    const tooltip = tooltips([
      ['hairs', 'hairs'],
      ['ranks', 'processes'],
      ['cost_ms', 'time of a step (ms)', '.3g'],
      ['model_ms', 'cost model (ms)', '.3g'],
      ['efficiency', 'efficiency of the model', '.2g'],
    ]);
    const line = (members, strokeDash) => ({
      data: { values: members.filter((row) => is_positive(row.model_ms)) },
      mark: { type: 'line', strokeWidth: 1.6, strokeDash },
      encoding: { x, y: y('model_ms'), color: series.color, opacity },
    });
    const label = (members, more) => ({
      data: { values: members.map((row) => ({ ...row, text: `${row.hairs} hairs` })) },
      mark: { type: 'text', fontSize: 10.5, color: theme.text, align: 'left', ...more },
      encoding: { x, y: y('cost_ms'), text: { field: 'text' } },
    });
    const last = Math.max(...rows.filter((row) => row.measured).map((row) => row.ranks));
    const first_beyond = Math.min(
      ...rows.filter((row) => !row.measured && row.ranks > last).map((row) => row.ranks),
    );
    return panels(
      with_parameters(
        groups.map(([title, members]) => ({
          title: effects_words[title] ?? title,
          width: panel_width,
          height: 300,
          layer: [
            line(members.filter((row) => !row.measured), [5, 3]),
            line(members.filter((row) => row.measured), [1, 0]),
            {
              data: { values: [{ ranks: last * 1.5, end: x.scale.domain[1] }] },
              mark: { type: 'rect', color: theme.axis, opacity: 0.16 },
              encoding: { x, x2: { field: 'end' } },
            },
            {
              data: { values: members.filter((row) => row.measured) },
              mark: { type: 'point', filled: true, size: 75 },
              encoding: { x, y: y('cost_ms'), ...series, strokeDash: undefined, opacity, tooltip },
            },
            {
              data: { values: [{ ranks: last * 1.5 }] },
              mark: { type: 'text', text: 'extrapolated', align: 'left', dx: 6, y: 10, color: theme.muted },
              encoding: { x },
            },
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
