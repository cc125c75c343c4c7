// Sentences that the tables must bear out: each is printed only while its condition holds.
import { validation_cells } from '../../figures/validation.mjs';
import { judged, not_compared, survives } from '../../src/hard.mjs';
import { by_tolerance } from '../../src/pace.mjs';
import { succeeded } from '../../src/tables.mjs';
import { must, number, ok_rows, percent, rows_of, time } from '../markdown.mjs';

// The sentence, once its condition holds.
const asserted = (condition, sentence) => (tables) => {
  must(condition(tables), sentence);
  return sentence;
};

const outcome = (tables, test, name) =>
  validation_cells(tables).find((cell) => cell.test === test && cell.name === name)?.outcome;

export const transport_hangs = asserted(
  (tables) =>
    outcome(tables, 'cantilever', 'force transport') === 'within' &&
    outcome(tables, 'beam modes', 'force transport') === 'outside',
  '`force_transport` has the right equilibrium and wrong frequencies',
);

export const equal_elements = asserted(
  (tables) =>
    validation_cells(tables).filter(
      (cell) => cell.test === 'cantilever uniform' && cell.outcome === 'outside',
    ).length > 1,
  'Equal elements do not resolve a heavy hair, which bends close to the clamp: `cantilever` grades its ' +
    'elements there, `cantilever_uniform` does not',
);

// Of backward Euler at its longest step, over all models: how much of what is stable and has
// a reference is accurate.
export function stable_not_accurate(tables) {
  const rows = judged(tables).filter(
    (row) => row.integrator === 'backward_euler' && !by_tolerance(row) && survives(row),
  );
  const longest = Math.max(...rows.map((row) => row.dt_s));
  const compared = rows.filter((row) => row.dt_s === longest && row.outcome !== not_compared);
  const accurate = compared.filter((row) => row.outcome === 'stable and accurate').length;
  return (
    `At ${time(longest)}, ${accurate} of the ${compared.length} stable runs of backward Euler that have a reference are accurate ` +
    `(${percent(accurate / compared.length)})` +
    (accurate < compared.length / 2 ? ': the method damps what it cannot follow' : '')
  );
}

const nodal = (tables, integrator, tangent) =>
  rows_of(tables, 'stability_limit', { study: 'nodal', integrator, tangent, start: 'space' })
    .reduce((a, b) => (b.elements > a.elements ? b : a));

export function nodal_verdict(tables) {
  const [newton, explicit] = [
    nodal(tables, 'backward_euler', 'exact'),
    nodal(tables, 'velocity_verlet', 'exact'),
  ].map((row) => row.dt_max_s);
  must(
    nodal(tables, 'linearly_implicit_midpoint', 'stiff').at_claim !== 'nothing' &&
      nodal(tables, 'semi_implicit_euler', 'stiff').at_claim === 'nothing' &&
      newton > explicit,
    'the claim is true for the undamped splitting of second order only',
  );
  return (
    'The claim is true for the undamped splitting of second order. The splitting of first order is stable there. Full Newton ' +
    `allows steps that are ${number(newton / explicit)} times longer than those of \`velocity_verlet\``
  );
}

// The springs of the swinging strand at the sweeps of a step that the study judges.
const springs = (tables, integrator, block, sweeps) =>
  rows_of(tables, 'block_descent', {
    part: 'sweeps',
    model: 'mass_spring',
    integrator,
    block,
    sweeps,
  }).filter((row) => !(row.chebyshev > 0))[0].direct_distance_rel;

export const descent_locks = asserted(
  (tables) =>
    springs(tables, 'vbd', 1, 20) >= 0.1 &&
    springs(tables, 'vbd', 16, 20) >= 0.1 &&
    springs(tables, 'vbd', 0, 5) <= 1e-5,
  'Descent node by node locks: springs of a hair are so stiff that bending cannot pass through held neighbours. ' +
    'Blocks of several nodes lock as well. With the whole strand as a block, a step converges in a small number of sweeps',
);

// Distances of the rows about penalties, by the penalty times the square of the step.
const penalties = (tables, dt_s) =>
  rows_of(tables, 'block_descent', { part: 'penalty', dt_s, primal_sweeps: 1 }).map((row) => ({
    scaled: row.penalty_1_s2 * row.dt_s ** 2,
    distance: succeeded(row) ? row.direct_distance_rel : Infinity,
  }));

export const multipliers_free = asserted(
  (tables) =>
    springs(tables, 'vbd_augmented', 1, 20) <= 0.01 &&
    [1 / 300, 1e-3].every((dt_s) => {
      const rows = penalties(tables, dt_s);
      return rows.every(({ scaled, distance }) => distance <= 0.01 === (scaled > 3 && scaled < 15));
    }) &&
    penalties(tables, 1 / 60).every(({ distance }) => distance > 0.01),
  'Multipliers that carry the stress from step to step remove the locking, if the penalty is within its window. Below it ' +
    'multipliers converge too slowly, above it nodes lock again. The window follows the square of the step, and closes at ' +
    'the longest step tried',
);

export const map_unreached = asserted(
  (tables) => {
    const rows = rows_of(tables, 'block_descent', { part: 'rods', scene: 'swing' });
    return rows.length >= 40 && rows.every((row) => succeeded(row) && row.error_rel > 0.01);
  },
  'On the hair no point of the map reaches the target error. With its real stiffness the hair locks at every tested number of ' +
    'sweeps; softened until sweeps converge it is another rod. All tested points are stable',
);

export const transport_wrong = asserted((tables) => {
  const ratios = rows_of(tables, 'force_transport', {
    comparison: 'modes',
    scene: 'weightless',
    model: 'force_transport',
  })
    .sort((a, b) => a.elements - b.elements)
    .map((row) => row.slowest_ratio);
  return ratios.every((ratio, i) => ratio > 1 && (i === 0 || ratio > ratios[i - 1]));
}, 'Its slowest oscillation is too fast, and refinement makes it faster: the model does not converge to the rod');

export const midpoint_keeps = asserted(
  (tables) => {
    const rows = ok_rows(tables, 'validation', {
      test: 'free_flight',
      integrator: 'implicit_midpoint',
    });
    const worst = (model) =>
      Math.max(...rows.filter((row) => row.model === model).map((row) => row.angular_error_rel));
    return worst('mass_spring') < 1e-9 && worst('der') < 1e-5 && worst('super_helix') > 1e-9;
  },
  'The midpoint rule keeps the angular momentum of particles to rounding, because it is bilinear in q and v; in the ' +
    'curvatures of a super-helix it keeps it to second order. Models whose sections turn by an angle of their own ' +
    '(`der`, `dynamic_spline`) drift by the spin that their kinetic energy leaves out, whatever the step',
);

export const small_load = asserted(
  (tables) =>
    rows_of(tables, 'effect_audit').some(
      (row) => row.load_over_weight < 0.1 && row.error_without_rel > 0.05,
    ),
  'A small load can have a large effect, because it acts all the time',
);

// Lengths at the longer step: springs alone, a correction alone, both.
export function springs_and_correction(tables) {
  const strands = rows_of(tables, 'constraint_drift', { study: 'strands' });
  const longest = Math.max(...strands.map((row) => row.dt_s));
  const at = (wanted) =>
    strands.find((row) =>
      Object.entries({ dt_s: longest, ...wanted }).every(([key, value]) => row[key] === value),
    );
  const springs = at({ system: 'mass_spring', integrator: 'semi_implicit_euler' });
  const corrected = { system: 'inextensible_strand', integrator: 'predictor_corrector' };
  const alone = at({ ...corrected, variant: '' });
  const both = at({ ...corrected, variant: 'stretch_springs=linear' });
  must(
    springs.length_error_rel > 0.01 && !succeeded(alone) && both.length_error_rel < 1e-6,
    'springs and a correction together hold lengths where neither does alone',
  );
  return (
    `At ${time(longest)}, springs inside an implicit solve with a correction of lengths after it ` +
    `(\`inextensible_strand\` with stretch springs, \`predictor_corrector\`) hold lengths to ` +
    `${number(both.length_error_rel)}; springs alone stretch by ${percent(springs.length_error_rel)}, and ` +
    'the correction alone finds no solution'
  );
}

export function springs_ring(tables) {
  const error = (integrator) =>
    ok_rows(tables, 'cost_of_accuracy', {
      kind: 'method',
      scene: 'release',
      model: 'mass_spring',
      integrator,
    })[0]?.length_error_rel;
  const [midpoint, damped] = ['implicit_midpoint', 'generalized_alpha'].map(error);
  must(midpoint > 10 * damped, 'stretch springs ring on under the midpoint rule');
  return (
    'With the midpoint rule stretch springs oscillate undamped, which the tip does not show: lengths of the falling ' +
    `\`mass_spring\` are off by ${number(midpoint)}. With \`generalized_alpha\`, which damps, they are off by ${number(damped)}`
  );
}
