// Sentences that the tables must bear out: each is printed only while its condition holds.
import { validation_cells } from '../../figures/validation.mjs';
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
  '`force_transport` hangs as it should and swings at wrong frequencies',
);

export const equal_elements = asserted(
  (tables) =>
    validation_cells(tables).filter(
      (cell) => cell.test === 'cantilever uniform' && cell.outcome === 'outside',
    ).length > 1,
  'Equal elements miss a heavy hair, whose bending sits close to the clamp: `cantilever` grades its ' +
    'elements there, `cantilever_uniform` does not',
);

export const stable_not_accurate = asserted((tables) => {
  const rows = rows_of(tables, 'hard_cases', { integrator: 'backward_euler' });
  const longest = Math.max(...rows.map((row) => row.dt_s));
  const at = (wanted) =>
    rows.filter((row) => row.dt_s === longest && row.outcome === wanted).length;
  return at('stable and accurate') < at('stable') / 2;
}, 'Stable is not accurate: at the longer step backward Euler survives far more cases than it is accurate in');

const nodal = (tables, integrator, tangent) =>
  rows_of(tables, 'stability_limit', { study: 'nodal', integrator, tangent, start: 'space' })
    .reduce((a, b) => (b.elements > a.elements ? b : a));

export const nodal_verdict = asserted(
  (tables) =>
    nodal(tables, 'linearly_implicit_midpoint', 'stiff').at_claim !== 'nothing' &&
    nodal(tables, 'semi_implicit_euler', 'stiff').at_claim === 'nothing' &&
    nodal(tables, 'backward_euler', 'exact').dt_max_s >
      1000 * nodal(tables, 'velocity_verlet', 'exact').dt_max_s,
  'The claim holds for the undamped splitting of second order; the splitting of first order is stable there, and ' +
    'whole Newton steps take steps that are orders of magnitude longer than explicit ones',
);

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
  'Node by node descent locks: springs of a hair are so stiff that bending cannot pass through held neighbours. ' +
    'Blocks of several nodes lock as well, down to one that is nearly the strand; the whole strand is solved in a few sweeps',
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
  'Multipliers that carry the stress from step to step free it, as long as the penalty is within its window: below it ' +
    'multipliers take too long, above it nodes lock again. The window follows the square of the step, and closes at ' +
    'the longest of the three',
);

export const map_unreached = asserted(
  (tables) => {
    const rows = rows_of(tables, 'block_descent', { part: 'rods', scene: 'swing' });
    return rows.length >= 40 && rows.every((row) => succeeded(row) && row.error_rel > 0.01);
  },
  'On the hair no point of the map is within the wanted error: as stiff as it is, it locks at any tried number of ' +
    'sweeps, and softened until sweeps converge it is another rod. Stable it is everywhere',
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
}, 'Its slowest oscillation is too fast, and the more so the finer it is discretised: it does not tend to the rod');

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
  'A small load is not a small effect: it acts all the time',
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
    `At ${time(longest)}, springs inside an implicit solve and a correction of lengths after it ` +
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
    'Stretch springs ring on, undamped, under the midpoint rule, invisible at the tip: lengths of the falling ' +
    `\`mass_spring\` are off by ${number(midpoint)}, by \`generalized_alpha\`, which damps, by ${number(damped)}`
  );
}
