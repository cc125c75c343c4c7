// Test by test: the error of every model over the accepted one.
import { distinct, group_by, is_positive, minimum_by } from '../src/tables.mjs';
import { log_channel, log_extent, tooltips } from './common.mjs';
import { blue, gold, orange } from './palette.mjs';
import { row_channel, row_text, row_width } from './rows.mjs';
import { drawn_cells } from './validation.mjs';

const least = 1e-4; // smaller ratios are drawn here

const verdicts = [
  ['within', 'within the accepted error', blue, 'circle'],
  ['outside', 'outside', orange, 'triangle-up'],
  ['no solution', 'no solution, or a run that failed', gold, 'diamond'],
];

const judged = (tables) =>
  drawn_cells(tables).filter(({ outcome }) => verdicts.some(([name]) => name === outcome));

const rows_of = (tables) =>
  judged(tables)
    .filter((row) => is_positive(row.tolerance_pct) && row.error_pct >= 0)
    .map((row) => ({
      ...row,
      ratio: Math.max(row.error_pct / row.tolerance_pct, least),
      verdict: verdicts.find(([name]) => name === row.outcome)[1],
    }));

// "outside: der, corde; no solution: xpbd cosserat" of each test.
const exceptions = (tables) =>
  [...group_by(judged(tables), (row) => row.test)].map(([test, members]) => ({
    test,
    text: [
      ['outside', ''],
      ['no solution', 'no solution: '],
    ]
      .map(([outcome, word]) => [
        word,
        members.filter((row) => row.outcome === outcome).map((row) => row.name),
      ])
      .filter(([, names]) => names.length > 0)
      .map(
        ([word, names]) =>
          word + (names.length > 2 ? `${names.length} models` : names.join(', ')),
      )
      .join('; '),
  }));

function headline(tables) {
  const tests = [...group_by(judged(tables), (row) => row.test)].map(([test, members]) => ({
    test,
    models: members.length,
    missed: members.filter(({ outcome }) => outcome !== 'within').length,
  }));
  const met = tests.filter(({ missed }) => missed === 0).length;
  const worst = minimum_by(tests, ({ missed }) => -missed);
  return (
    `${met} of ${tests.length} tests are met by every model that supports them` +
    (worst.missed > 0
      ? `; ${worst.test} is missed by most: ${worst.missed} of ${worst.models}`
      : '')
  );
}

export const validation_tests = {
  id: 'validation_tests',
  title: 'Error over accepted error, test by test',
  table: 'validation',
  headline,
  reading: `A row for each published test, a mark for each model: its largest error over the accepted one. Left of 1 is
    within; names on the right are those that are not.`,
  caption: `The error is the largest over the parameters of a test, at the numbers of elements at which the test is judged.
    Ratios below 1e-4 are drawn there. Made from validation.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const tests = distinct(drawn_cells(tables).map((row) => row.test)).filter((test) =>
      rows.some((row) => row.test === test),
    );
    const narrow = width < 700;
    const x = log_channel(
      'ratio',
      'error / accepted error',
      log_extent([...rows.map((row) => row.ratio), 1]),
    );
    const y = row_channel('test', tests);
    const known = verdicts.filter(([name]) => rows.some((row) => row.outcome === name));
    const of = (range) => ({ domain: known.map(([, name]) => name), range });
    const legend = { orient: 'top', direction: 'horizontal', columns: narrow ? 1 : 3 };
    const verdict = { field: 'verdict', type: 'nominal', title: null, legend };
    return {
      width: row_width(width, tests, narrow ? 0 : 280),
      height: { step: 16 },
      layer: [
        {
          data: { values: [{ ratio: 1 }] },
          mark: { type: 'rule', color: theme.text, strokeWidth: 1.2 },
          encoding: { x },
        },
        {
          data: { values: rows },
          mark: { type: 'point', filled: true, size: 42, opacity: 0.75 },
          encoding: {
            x,
            y,
            color: { ...verdict, scale: of(known.map(([, , colour]) => colour)) },
            shape: { ...verdict, scale: of(known.map(([, , , shape]) => shape)) },
            tooltip: tooltips([
              ['test', 'test'],
              ['name', 'model'],
              ['error_pct', 'largest error (%)', '.3g'],
              ['tolerance_pct', 'accepted (%)', '.3g'],
              ['at', 'at the parameter'],
              ['reason', 'reason'],
            ]),
          },
        },
        ...(narrow
          ? []
          : [
              row_text(
                exceptions(tables).filter(({ test, text }) => text !== '' && tests.includes(test)),
                y,
                'text',
                { baseline: 'middle' },
              ),
            ]),
      ],
    };
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `${distinct(rows.map((row) => row.test)).length} rows, one per test: the error over the accepted error,
      log scale, of ${distinct(rows.map((row) => row.name)).length} models.`;
  },
};
