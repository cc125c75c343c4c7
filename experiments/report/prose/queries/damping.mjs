// What methods take from a hair that swings without friction.
import { distinct, succeeded } from '../../src/tables.mjs';
import { format_time } from '../../src/format.mjs';
import { percent, rows_of, table } from '../markdown.mjs';

export const losses = (tables) => {
  const rows = rows_of(tables, 'damping');
  const steps = distinct(rows.map((row) => row.dt_s)).sort((a, b) => b - a);
  const runs = distinct(rows.map((row) => `${row.model} ${row.integrator}`));
  return table(
    ['model', 'method', ...steps.map((step) => format_time(step))],
    runs.map((run) => [
      ...run.split(' '),
      ...steps.map((step) => {
        const row = rows.find(
          (r) => `${r.model} ${r.integrator}` === run && r.dt_s === step,
        );
        return row === undefined
          ? ''
          : succeeded(row)
            ? percent(row.energy_lost_rel)
            : row.status;
      }),
    ]),
  );
};
