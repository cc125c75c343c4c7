// What one per cent costs every strand model.
import { variant_name } from '../../src/strand.mjs';
import { group_by, is_positive, minimum_by } from '../../src/tables.mjs';
import { number, ok_rows, table, time } from '../markdown.mjs';

function scene_table(scene) {
  return (tables) => {
    const rows = ok_rows(tables, 'cost_of_accuracy', { kind: 'method', scene })
      .filter((row) => is_positive(row.wall_s_per_sim_s))
      .map((row) => ({ ...row, variant: row.options }));
    const best = [...group_by(rows, variant_name).values()]
      .map((members) => minimum_by(members, (row) => row.wall_s_per_sim_s))
      .sort((a, b) => a.wall_s_per_sim_s - b.wall_s_per_sim_s);
    return table(
      [
        'model',
        'time a simulated second',
        'integrator',
        'elements, step',
        'unknowns',
        'length error',
        'energy error',
        'linear, angular momentum error',
      ],
      best.map((row) => [
        variant_name(row),
        time(row.wall_s_per_sim_s),
        `\`${row.integrator}\``,
        `${row.elements}, ${time(row.dt_s)}`,
        row.unknowns,
        number(row.length_error_rel),
        number(row.energy_error_rel),
        [row.linear_error_rel, row.angular_error_rel].map((x) => number(x)).filter(Boolean).join(', '),
      ]),
    );
  };
}

export const release = scene_table('release');
export const flight = scene_table('flight');
