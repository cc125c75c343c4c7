// What integrators do to momentum and energy of a hair thrown in space.
import { group_by } from '../../src/tables.mjs';
import { number, percent, range, rows_of, table, time } from '../markdown.mjs';

const whole = (tables) =>
  rows_of(tables, 'validation', { test: 'free_flight', status: 'ok' }).filter(
    (row) => typeof row.dt_s === 'number',
  );

const duration = (tables) => Math.max(...whole(tables).map((row) => row.t_end_s));

// "0.5 s"; a last step may pass the end by its rounding.
export const seconds = (tables) => `${number(duration(tables), 2)} s`;

const signed = (x) => `${x > 0 ? '+' : ''}${percent(x)}`;

// By integrator and model: change of the size of angular momentum, its largest error as a
// vector, change of energy.
export function change_table(tables) {
  const rows = whole(tables);
  const steps = [...new Set(rows.map((row) => row.dt_s))].sort((a, b) => b - a);
  const integrators = group_by(rows, (row) => row.integrator);
  const cells = (members) => {
    const models = group_by(members, (row) => row.model);
    return [...models].map(
      ([model, [row]]) =>
        `${model} ${signed(row.angular_change_rel)}, ${percent(row.angular_error_rel)}, ` +
        `${signed(row.energy_change_rel)}`,
    );
  };
  return table(
    ['integrator', ...steps.map((dt) => `at ${time(dt)}`)],
    [...integrators].map(([integrator, members]) => [
      `\`${integrator}\``,
      ...steps.map((dt) => cells(members.filter((row) => row.dt_s === dt)).join('; ')),
    ]),
  );
}

// Over all models that finish at the longest step.
export const backward_euler_loss = (tables) => {
  const rows = whole(tables).filter((row) => row.integrator === 'backward_euler');
  const longest = Math.max(...rows.map((row) => row.dt_s));
  return range(
    rows.filter((row) => row.dt_s === longest).map((row) => row.angular_change_rel),
    percent,
  );
};
