// Published tests of slender rods.
import { validation_cells } from '../../figures/validation.mjs';
import { validation_orders } from '../../figures/validation_orders.mjs';
import { distinct, group_by } from '../../src/tables.mjs';
import { number, table } from '../markdown.mjs';

// Nobody cares how much less, unless less is accepted.
const least_pct = 1e-3;

const shown = ({ outcome, error_pct, tolerance_pct, lost, partly }) => {
  if (outcome === 'does not apply') return '';
  if (outcome === 'no answer') return '**no answer**';
  const text = `${error_pct < least_pct && tolerance_pct >= 10 * least_pct ? `< ${least_pct}` : number(error_pct)}${
    partly ? ' (in part)' : ''
  }`;
  if (lost) return `**${text}, a run lost**`;
  return outcome === 'outside' ? `**${text}**` : text;
};

export const tests = (tables) =>
  String(distinct(validation_cells(tables).map((cell) => cell.test)).length);

// Tests down, models across: largest error of the judged rows in per cent.
export function matrix(tables) {
  const cells = validation_cells(tables);
  const names = distinct(cells.map((cell) => cell.name));
  const rows = [...group_by(cells, (cell) => cell.test)].map(([test, members]) => {
    const tolerance = members.find((cell) => cell.tolerance_pct !== undefined);
    const by_name = new Map(members.map((cell) => [cell.name, cell]));
    return [
      test,
      number(tolerance?.tolerance_pct),
      ...names.map((name) => (by_name.has(name) ? shown(by_name.get(name)) : '')),
    ];
  });
  return table(['test', 'accepted', ...names], rows);
}

// The tests that each model can run, and how many of these it meets.
function scored(tables) {
  const judged = validation_cells(tables).filter(
    (cell) => !['does not apply', 'not judged'].includes(cell.outcome),
  );
  return [...group_by(judged, (cell) => cell.name)]
    .map(([name, members]) => {
      const met = members.filter((cell) => cell.outcome === 'within');
      return {
        name,
        all: members.length,
        met: met.length,
        partly: met.filter((cell) => cell.partly).map((cell) => cell.test),
      };
    })
    .sort((a, b) => b.met / b.all - a.met / a.all);
}

export const scores_table = (tables) =>
  table(
    ['model', 'tests that it can run', 'met', 'of these, with some parameters refused'],
    scored(tables).map(({ name, all, met, partly }) => [name, all, met, partly.join(', ')]),
  );

// The best and the last of all models, "super clothoid meets 37 of 37 tests ...".
export function scores(tables) {
  const all = scored(tables);
  const [best, last] = [all[0], all.at(-1)];
  return (
    `The best model, ${best.name}, meets ${best.met} of the ${best.all} tests that it can run; the last, ${last.name}, ` +
    `${last.met} of ${last.all}. All ${all.length} models and variants`
  );
}

// How many curves of error against elements can tell an order.
export const order_points = (tables) => {
  const curves = [
    ...group_by(validation_orders.rows(tables), (row) => `${row.test}|${row.name}`).values(),
  ];
  const of = (points) => curves.filter(([row]) => row.points === points).length;
  const few = 2;
  const two = of(few);
  return (
    `Curves with more than ${few} numbers of elements: ${curves.length - two} of ${curves.length}. ` +
    `The other ${two} are dashed, and their slope is no evidence of an order`
  );
};
