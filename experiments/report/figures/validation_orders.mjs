// How the error of a test falls with the number of elements.
import { distinct, group_by, is_number, minimum_by } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
import { linear_channel, tooltips } from './common.mjs';
import { blue, orange } from './palette.mjs';
import { row_channel, row_text, row_width } from './rows.mjs';
import { answered, named } from './validation.mjs';

const order_rows = (tables) => {
  const rows = named(tables).filter((row) => answered(row) && row.error_rel > 0);
  // Of every test and model the parameter at which its error is largest.
  return [...group_by(rows, (row) => `${row.test}|${row.name}`).values()].flatMap((members) => {
    if (distinct(members.map((row) => row.elements)).length < 2) return [];
    const worst = members.reduce((a, b) => (b.error_rel > a.error_rel ? b : a));
    return members
      .filter((row) => row.parameter === worst.parameter)
      .map((row, _, { length }) => ({
        ...row,
        error_pct: 100 * row.error_rel,
        points: length,
      }));
  });
};

const few = 'two numbers of elements';
const several = 'three or more';
const ends = [-1, 6];
const rounding = 1e-9; // errors below it are not those of the elements

// An order for each pair of test and model: the slope of error over elements, log-log, from
// the coarsest to the finest.
export const orders_of = (tables) =>
  [...group_by(order_rows(tables), (row) => `${row.test}|${row.name}`).values()].flatMap(
    (members) => {
      const coarse = minimum_by(members, (row) => row.elements);
      const fine = minimum_by(members, (row) => -row.elements);
      const order =
        Math.log(coarse.error_rel / fine.error_rel) / Math.log(fine.elements / coarse.elements);
      if (!is_number(order) || coarse.error_rel < rounding) return [];
      return [
        {
          test: spaced(coarse.test),
          name: coarse.name,
          order,
          drawn: Math.max(ends[0], Math.min(ends[1], order)),
          from: coarse.error_pct,
          to: fine.error_pct,
          meshes: `${coarse.elements} to ${fine.elements}`,
          fit: distinct(members.map((row) => row.elements)).length > 2 ? several : few,
        },
      ];
    },
  );

const least_order = 1.5;
const slow = ({ order }) => order < 0.5;

function headline(tables) {
  const orders = orders_of(tables);
  const fast = orders.filter(({ order }) => order >= least_order).length;
  return (
    `In ${fast} of ${orders.length} pairs of test and model the error falls with order ` +
    `${least_order} or more; in ${orders.filter(slow).length} it hardly falls`
  );
}

export const validation_orders = {
  id: 'validation_orders',
  title: 'How the error falls with elements',
  table: 'validation',
  headline,
  reading: `A row for each test, a mark for each model: the slope of its error over the number of elements. At 2, elements
    of half the length have a quarter of the error. Names: models below 0.5.`,
  caption: `Observed order from the coarsest to the finest number of elements, at the parameter where the error of the
    model is largest. An order from two numbers of elements is no fit, and may not last. Orders beyond the axis are drawn at
    its ends; errors below ${rounding} are rounding and are left out. Made from validation.csv.`,

  rows: order_rows,

  spec(tables, { width, theme }) {
    const rows = orders_of(tables);
    const tests = distinct(rows.map((row) => row.test));
    const narrow = width < 700;
    const x = linear_channel('drawn', 'observed order', { tickCount: 8 });
    x.scale = { domain: ends, nice: false };
    const y = row_channel('test', tests);
    const fits = [several, few].filter((fit) => rows.some((row) => row.fit === fit));
    const style = { [several]: [blue, 'circle'], [few]: [orange, 'diamond'] };
    const of = (k) => ({ domain: fits, range: fits.map((fit) => style[fit][k]) });
    const legend = fits.length > 1 ? { orient: 'top', direction: 'horizontal' } : null;
    const fit = { field: 'fit', type: 'nominal', title: 'order from', legend };
    const texts = [...group_by(rows.filter(slow), (row) => row.test)].map(([test, members]) => ({
      test,
      text:
        members.length > 3
          ? `${members.length} models`
          : members.map(({ name }) => name).join(', '),
    }));
    return {
      width: row_width(width, tests, narrow ? 0 : 240),
      height: { step: 16 },
      layer: [
        {
          data: { values: [{ drawn: 2 }] },
          mark: { type: 'rule', color: theme.text, strokeWidth: 1.2 },
          encoding: { x },
        },
        {
          data: { values: rows },
          mark: { type: 'point', filled: true, size: 42, opacity: 0.75 },
          encoding: {
            x,
            y,
            color: { ...fit, scale: of(0) },
            shape: { ...fit, scale: of(1) },
            tooltip: tooltips([
              ['test', 'test'],
              ['name', 'model'],
              ['order', 'order', '.2f'],
              ['meshes', 'elements'],
              ['from', 'error at first (%)', '.3g'],
              ['to', 'error at last (%)', '.3g'],
            ]),
          },
        },
        ...(narrow ? [] : [row_text(texts, y, 'text', { baseline: 'middle' })]),
      ],
    };
  },

  describe(tables) {
    const rows = orders_of(tables);
    return `${distinct(rows.map((row) => row.test)).length} rows, one per test: the observed order of
      ${distinct(rows.map((row) => row.name)).length} models.`;
  },
};
