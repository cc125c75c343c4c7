// Rows of the hard cases as they are counted and drawn.
import { by_tolerance, pace } from './pace.mjs';
import { group_by, is_number, minimum_by } from './tables.mjs';
import { cell_fills } from '../figures/palette.mjs';

// Stable, but without a reference: nobody knows how far off it is.
export const not_compared = 'stable, not compared';

// From best to worst: name, letter in the cell, look.
export const outcomes = [
  ['stable and accurate', 'A', cell_fills.dark],
  ['stable', 'S', cell_fills.light],
  [not_compared, 'N', {}],
  ['not finished', 'T', cell_fills.middle],
  ['unstable', 'U', cell_fills.strong],
  ['refused', '\u2013', undefined],
];
// What figures call them.
export const outcome_words = {
  'stable and accurate': 'stable and accurate',
  stable: 'stable, inaccurate',
  [not_compared]: 'stable, no reference',
  'not finished': 'work limit reached',
  unstable: 'unstable',
  refused: 'not supported',
};
export const rank = ({ outcome }) => outcomes.findIndex(([name]) => name === outcome);
export const survives = ({ outcome }) => outcome.startsWith('stable');

const long_case = 'million_steps';
const whole_steps = 1e6;

const is_long = (row) => row.case === long_case;
const same_run = (a, b) =>
  ['model', 'variant', 'integrator', 'dt_s'].every((column) => a[column] === b[column]) &&
  !by_tolerance(a);

// Every row with the outcome that its error supports. A quick table cuts the million steps
// short: these rows have the number of their steps in `cut`, and those of the whole table come
// after them.
export function hard_rows({ hard_cases = [], hard_cases_million_steps: whole = [] }) {
  const quick = hard_cases.filter(is_long);
  const most = Math.max(0, ...quick.filter((row) => !by_tolerance(row)).map((row) => row.steps ?? 0));
  const is_cut = quick.length > 0 && most < whole_steps;
  const named = (row) => ({
    ...row,
    outcome: row.outcome === 'stable' && !is_number(row.error_rel) ? not_compared : row.outcome,
    cut: is_cut && is_long(row) ? most : 0,
  });
  const added = is_cut ? whole.filter((row) => quick.some((other) => same_run(row, other))) : [];
  return [
    ...hard_cases.map(named),
    ...added.map((row) => ({ ...named(row), cut: 0 })),
  ].filter((row) => rank(row) >= 0);
}

// One row for each case, model, integrator and step or tolerance: the best variant counts.
export const best_variants = (rows) =>
  [
    ...group_by(rows, (row) =>
      [row.case, row.cut, row.model, row.integrator, pace(row)].join('|'),
    ).values(),
  ].map((members) => minimum_by(members, rank));

const run_of = (row) => [row.case, row.model, row.integrator, pace(row)].join('|');

// What counts. A run that was cut short and fails would fail whole as well: it counts, unless
// the same was run whole. One that passes says nothing about the whole run.
export function judged(tables) {
  const best = best_variants(hard_rows(tables));
  const whole = new Set(best.filter((row) => !row.cut).map(run_of));
  return best.filter((row) => !row.cut || (!survives(row) && !whole.has(run_of(row))));
}
