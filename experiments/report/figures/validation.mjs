// Every strand model against every published test: a matrix of errors.
import { distinct, group_by, is_number, is_set, minimum_by } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { code, spaced, variant_name } from '../src/strand.mjs';
import { tooltips } from './common.mjs';
import { row_channel } from './rows.mjs';
import { cell_fills } from './palette.mjs';

export const answered = (row) => is_number(row.error_rel);

// --quick leaves out tests that take minutes on some models; alone, a model runs them.
const left_out = (row) => String(row.reason ?? '').startsWith('takes minutes');

// Why a cell has no error, and what it shows.
function without_error(members, missing) {
  if (missing.length > 0) return { outcome: 'no solution', label: '–' };
  if (members.some(left_out)) return { outcome: 'left out', label: '…' };
  return { outcome: 'does not apply', label: '' };
}

// One cell of the matrix: the worst error over the parameters that were judged, or why
// there is none.
function cell(members) {
  const [{ test, name, model, variant }] = members;
  const finest = Math.max(...members.map((row) => row.elements));
  const judged = members.filter((row) => answered(row) && is_set(row.judged));
  const told = members.filter((row) => answered(row) && row.elements === finest);
  const counted = judged.length > 0 ? judged : told;
  const missing = members.filter((row) => !['ok', 'refused'].includes(row.status));
  const reason = (missing[0] ?? members.find((row) => row.reason))?.reason ?? '';
  const shared = {
    test: spaced(test),
    name,
    model,
    variant: variant ? String(variant).split('=').at(-1) : '',
    reason,
  };
  if (counted.length === 0) return { ...shared, ...without_error(members, missing) };
  const worst = counted.reduce((a, b) => (b.error_rel > a.error_rel ? b : a));
  const within = counted.every((row) => is_set(row.passed));
  const failed = missing.some((row) => is_set(row.judged) || row.elements === finest);
  return {
    ...shared,
    outcome: within && !failed ? 'within' : judged.length > 0 ? 'outside' : 'not judged',
    error_pct: 100 * worst.error_rel,
    tolerance_pct: 100 * worst.accepted_error_rel,
    at: `${format_number(worst.parameter)}, ${worst.elements} elements`,
    label:
      worst.error_rel < 1e-4
        ? '<.01'
        : format_number(100 * worst.error_rel, 2).replace(/^0\./, '.'),
    failed: within && failed,
    partly: members.some((row) => row.status === 'refused'),
    reason: failed ? reason : '',
  };
}

// The published tests; free_flight asks nothing of a model.
export const named = (tables) =>
  (tables.validation ?? [])
    .filter((row) => row.test !== 'free_flight')
    .map((row) => ({ ...row, name: variant_name(row) }));

export const validation_cells = (tables) =>
  [...group_by(named(tables), (row) => `${row.test}|${row.name}`).values()].map(cell);

// Name in the legend, fill and colour of the number; what does not apply is left grey.
const outcomes = {
  within: ['within the accepted error', cell_fills.dark],
  outside: ['outside the accepted error', cell_fills.strong],
  'not judged': ['outside, with fewer elements than it is judged at', cell_fills.light],
  'no solution': ['\u2013: no solution, or a run that failed', cell_fills.middle],
  'left out': ['\u2026: left out by --quick, takes minutes', undefined],
  'does not apply': ['empty: does not apply to this model', undefined],
};

// Cells without a judgement: white where a run is missing, grey where none is possible.
const empty_fill = (id, theme) => (id === 'left out' ? theme.background : theme.grid);

// By model: its tests that were judged, those within the accepted error, and the number left out.
const scores_of = (tables) =>
  [...group_by(validation_cells(tables), (row) => row.name)]
    .map(([name, members]) => {
      const told = members.filter(
        (row) => !['does not apply', 'left out', 'not judged'].includes(row.outcome),
      );
      return {
        name,
        told,
        within: told.filter((row) => row.outcome === 'within'),
        left: members.filter((row) => row.outcome === 'left out').length,
      };
    })
    .filter(({ told }) => told.length > 0);

// A test that was left out is not met.
const part = ({ told, within, left }) => within.length / (told.length + left);

const left_out_text = ({ left }) => (left > 0 ? ` (${left} left out)` : '');

// Cells as they are drawn: a failed run among others within the error is no error.
export const drawn_cells = (tables) =>
  validation_cells(tables).map((row) => (row.failed ? { ...row, outcome: 'no solution' } : row));

const coded_name = ({ model, variant }) => code(model) + (variant ? `, ${variant}` : '');

// "456 of 499 pairs of model and test are within the accepted error; best: ..., worst: ..."
function headline(tables) {
  const scores = scores_of(tables);
  if (scores.length === 0) return 'No test has a result';
  const total = (field) => scores.reduce((sum, score) => sum + score[field].length, 0);
  const best = minimum_by(scores, (score) => -part(score));
  const worst = minimum_by(scores, part);
  const text = (score) =>
    `${score.name} meets ${score.within.length} of ${score.told.length}${left_out_text(score)}`;
  return (
    `${total('within')} of ${total('told')} pairs of model and test are within the accepted error; ` +
    `${text(best)}${worst === best ? '' : `, ${text(worst)}`}`
  );
}

export function validation_findings(tables) {
  const by_model = scores_of(tables);
  const sentence = ({ told, within, left }) => {
    const wrong = told.filter((row) => row.outcome !== 'within');
    const list = wrong
      .map((row) =>
        row.outcome === 'no solution' || row.failed
          ? `${row.test} (${row.failed ? 'a run failed' : 'no solution'})`
          : `${row.test} (${format_number(row.error_pct)} %)`,
      )
      .join(', ');
    return (
      `${coded_name(told[0])} meets ${within.length} of ${told.length} tests${left_out_text({ left })}` +
      `${wrong.length > 0 ? `. Not met: ${list}` : ''}.`
    );
  };
  return by_model
    .sort((a, b) => part(b) - part(a))
    .map(sentence);
}

export const validation = {
  id: 'validation',
  title: 'Every model against every test',
  table: 'validation',
  headline,
  reading: `Rows are published tests of slender rods, columns are models. A number is the largest error in per cent of the
    quantity that the test measures, over the parameters of the test.`,
  caption: `Each row is a published test of slender rods, each column a strand model. The number
    is the largest error in per cent of the measured quantity, over the parameters of the test, at
    the numbers of elements at which it is judged. Grey: the model's kinematics do not have the
    degrees of freedom of the test (a planar model has no twist); the table gives the reason.
    White with dots: a test that takes minutes on this model, which --quick leaves out.
    Made from validation.csv.`,

  rows: drawn_cells,

  spec(tables, { width, theme }) {
    const rows = drawn_cells(tables);
    const models = distinct(rows.map((row) => row.name));
    const known = Object.entries(outcomes).filter(([id]) =>
      rows.some((row) => row.outcome === id),
    );
    const step = Math.max(14, Math.min(58, Math.floor((width - 210) / models.length)));
    const x = {
      field: 'name',
      type: 'nominal',
      title: null,
      scale: { domain: models },
      axis: { orient: 'top', labelAngle: -40, labelLimit: 0, domain: false, ticks: false },
    };
    const y = row_channel('test', distinct(rows.map((row) => row.test)), { grid: false });
    return {
      width: { step },
      height: { step: 18 },
      // The slanted name of the last model reaches beyond its column.
      padding: { left: 4, top: 4, right: 44, bottom: 4 },
      data: { values: rows },
      layer: [
        {
          mark: { type: 'rect', stroke: theme.background, strokeWidth: 1.5 },
          encoding: {
            x,
            y,
            color: {
              field: 'outcome',
              type: 'nominal',
              title: null,
              scale: {
                domain: known.map(([id]) => id),
                range: known.map(([id, [, look]]) => look?.fill ?? empty_fill(id, theme)),
              },
              legend: {
                orient: 'bottom',
                direction: 'horizontal',
                columns: width > 600 ? 2 : 1,
                symbolType: 'square',
                symbolSize: 220,
                symbolStrokeWidth: 0,
                labelExpr: `{${known
                  .map(([id, [text]]) => `'${id}': '${text}'`)
                  .join(', ')}}[datum.value]`,
              },
            },
            tooltip: tooltips([
              ['name', 'model'],
              ['test', 'test'],
              ['outcome', 'outcome'],
              ['error_pct', 'largest error (%)', '.3g'],
              ['tolerance_pct', 'accepted (%)', '.3g'],
              ['at', 'at the parameter'],
              ['reason', 'reason'],
            ]),
          },
        },
        ...known.map(([id, [, look]]) => ({
          transform: [{ filter: { field: 'outcome', equal: id } }],
          mark: {
            type: 'text',
            fontSize: step < 26 ? 8 : 10,
            color: look?.text ?? theme.muted,
            fontWeight: 600,
            tooltip: null,
          },
          encoding: { x, y, text: { field: 'label' } },
        })),
      ],
    };
  },

  describe(tables) {
    const rows = drawn_cells(tables);
    const count = (id) => rows.filter((row) => row.outcome === id).length;
    return `Matrix of ${distinct(rows.map((row) => row.name)).length} models and
      ${distinct(rows.map((row) => row.test)).length} tests: ${count('within')} within the accepted
      error, ${count('outside')} outside, ${count('no solution')} without a solution,
      ${count('left out')} left out, ${count('does not apply')} that do not apply.`;
  },
};
