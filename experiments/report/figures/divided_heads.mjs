// What a head costs when processes divide it: measured, and by the model.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { line_panels } from './common.mjs';

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
    million hairs, as dense as on a scalp. A panel for hairs that do not touch, and for hairs that do. Made from divided_heads.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    return line_panels([...group_by(rows, (row) => row.effects)], {
      id: 'divided_heads',
      width,
      series: ['hairs', 'hairs'],
      x: ['ranks', 'processes'],
      y: ['cost_ms', 'a step (ms)'],
      tooltip: [
        ['hairs', 'hairs'],
        ['ranks', 'processes'],
        ['cost_ms', 'a step (ms)', '.3g'],
        ['efficiency', 'efficiency', '.2g'],
      ],
    });
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Time of a step in milliseconds against the number of processes, both log scale, for
      ${distinct(rows.map((row) => row.hairs)).length} numbers of hairs.`;
  },
};
