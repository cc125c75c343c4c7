// What methods take from a hair that swings without friction.
import { distinct, succeeded } from '../../src/tables.mjs';
import { format_time } from '../../src/format.mjs';
import { must, percent, range, rows_of, table } from '../markdown.mjs';

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

// Methods that take less at a longer step than at a shorter one, and where they break.
export const not_monotone = (tables) => {
  const all = rows_of(tables, 'damping');
  const rows = all.filter(succeeded);
  const breaks = (run) => {
    const failed = all.filter((row) => `${row.model} ${row.integrator}` === run && !succeeded(row));
    return failed.length === 0
      ? ''
      : `, and is ${failed.map((row) => `${row.status} at ${format_time(row.dt_s)}`).join(', ')}`;
  };
  const found = distinct(rows.map((row) => `${row.model} ${row.integrator}`)).flatMap((run) => {
    const own = rows
      .filter((row) => `${row.model} ${row.integrator}` === run && row.energy_lost_rel > 0.01)
      .sort((a, b) => a.dt_s - b.dt_s);
    return own.slice(1).flatMap((longer, i) =>
      longer.energy_lost_rel < own[i].energy_lost_rel
        ? [
            `\`${longer.model}\` with \`${longer.integrator}\` loses ${percent(longer.energy_lost_rel)} at ` +
              `${format_time(longer.dt_s)} and ${percent(own[i].energy_lost_rel)} at ${format_time(own[i].dt_s)}${breaks(run)}`,
          ]
        : [],
    );
  });
  return found.length === 0
    ? 'No run that loses more than 1 % loses less at a longer step'
    : `A smaller loss at a longer step is no merit: ${found.join('; ')}`;
};

// What the Euler methods take over all their steps.
export const euler_loss = (tables) => {
  const rows = rows_of(tables, 'damping').filter(
    (row) => succeeded(row) && row.integrator.endsWith('_euler'),
  );
  must(rows.every((row) => row.energy_lost_rel > 0), 'Euler methods lose energy');
  return range(rows.map((row) => row.energy_lost_rel), percent);
};
