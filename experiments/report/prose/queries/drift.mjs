// Lengths of a shaken hair, by how they are held.
import { group_by } from '../../src/tables.mjs';
import { number, rows_of, table, time } from '../markdown.mjs';

const shown = (row) => {
  if (row === undefined) return '';
  return row.status === 'ok' ? number(row.length_error_rel) : `fails (${row.status})`;
};

export function lengths_table(tables) {
  const rows = rows_of(tables, 'constraint_drift', { study: 'strands' });
  const steps = [...new Set(rows.map((row) => row.dt_s))].sort((a, b) => b - a);
  const groups = group_by(rows, (row) =>
    [row.system, row.variant, row.formulation, row.integrator].join('|'),
  );
  return table(
    ['model', 'formulation', 'integrator', ...steps.map((dt) => `at ${time(dt)}`)],
    [...groups.values()].map((members) => [
      `\`${members[0].system}\`${members[0].variant ? ` (${members[0].variant})` : ''}`,
      members[0].formulation,
      `\`${members[0].integrator}\``,
      ...steps.map((dt) => shown(members.find((row) => row.dt_s === dt))),
    ]),
  );
}
