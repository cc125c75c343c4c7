// Figure 9: largest stable time step against the number of elements, model by model.
import { distinct, group_by, study_rows } from '../src/tables.mjs';
import { format_time } from '../src/format.mjs';
import { code, has_limit, is_capped, is_reduced, spaced } from '../src/strand.mjs';
import { is_drawn, limit_reading, limit_spec } from './stability_limit.mjs';

// One linear solve a step, and Newton's iteration to its end.
const integrators = ['linearly_implicit_euler', 'backward_euler'];

// Of the reduced models the papers' step and the whole Newton step in linear time.
const usual = (row) =>
  !is_reduced(row) ||
  (row.solver === 'recursive' &&
    row.modes === 'bend_twist' &&
    row.jacobian === (row.integrator === 'backward_euler' ? 'exact' : 'elastic'));

// Scenes that all models were run on.
function shared(rows) {
  const models = distinct(rows.map((row) => row.model)).length;
  const complete = [...group_by(rows, (row) => row.scene).values()].filter(
    (members) => distinct(members.map((row) => row.model)).length === models,
  );
  return complete.flat();
}

const rows_of = (tables) =>
  shared(
    study_rows(tables, 'stability_limit', 'grid').filter(
      (row) =>
        row.damping === 'none' &&
        integrators.includes(row.integrator) &&
        usual(row) &&
        is_drawn(row),
    ),
  );

const limit = (row) =>
  !has_limit(row)
    ? 'none found'
    : `${is_capped(row) ? 'at least ' : ''}${format_time(row.dt_max_s)}`;

// One sentence per scene and integrator, models from the largest step down.
export function model_step_findings(tables) {
  const at_20 = rows_of(tables).filter((row) => row.elements === 20);
  return [...group_by(at_20, (row) => `${row.scene}|${row.integrator}`).values()].map(
    (members) =>
      `${spaced(members[0].scene)}, 20 elements, ${code(members[0].integrator)}: ` +
      [...members]
        .sort((a, b) => (b.dt_max_s ?? 0) - (a.dt_max_s ?? 0))
        .map((row) => `${code(row.model)} ${limit(row)}`)
        .join(', ') +
      '.',
  );
}

export const model_steps = {
  id: 'model_steps',
  title: 'The largest stable time step of every model',
  table: 'stability_limit',
  headline(tables) {
    const newton = this.rows(tables).filter((row) => row.integrator === integrators[1]);
    const free = (rows) => rows.filter(is_capped).length;
    const single = this.rows(tables).filter((row) => row.integrator === integrators[0]);
    return (
      `Stable up to the longest step tried: ${free(newton)} of ${newton.length} searches with ` +
      `${integrators[1]}, ${free(single)} of ${single.length} with ${integrators[0]}`
    );
  },
  reading: limit_reading,
  caption: `Largest stable time step without damping, one row per model, with one linear solve per step
    (${integrators[0]}) and with backward Euler, where a step is too long once Newton's iteration
    finds no solution. super_helix and articulated_chain: recursion, with the papers' Jacobian for the first and the
    exact one for the second, as for force_transport; others: their default solver and Jacobian. Made from
    stability_limit.csv, scenes that every model was run on.`,

  rows: (tables) =>
    rows_of(tables).map((row) => ({
      ...row,
      method: spaced(row.model),
      damping: row.integrator,
    })),

  spec(tables, options) {
    return limit_spec(this.rows(tables), options, 2);
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Largest stable time step in milliseconds, log scale: ${distinct(rows.map((r) => r.model)).length} models, two integrators, 33 ms
      marked, ${rows.filter(is_capped).length} runs stable up to the end of the scan.`;
  },
};
