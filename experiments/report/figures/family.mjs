// Which statements are true for which hairs.
import { distinct, group_by, is_positive, is_set, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import {
  dimmed_unless,
  legend_selection,
  lines_of,
  log_channel,
  log_extent,
  tooltips,
} from './common.mjs';
import { blue, orange } from './palette.mjs';
import { row_channel, row_text, row_width } from './rows.mjs';

// The statements in words.
const statements = {
  exact_step_100ms: 'backward Euler, exact Jacobian: stable at 100 ms',
  exact_step_100ms_bend: 'backward Euler, exact Jacobian, no twist: stable at 100 ms',
  super_helix_step_longer: 'super_helix: largest step at least that of der',
  twist_straight_negligible: 'straight hair: twist moves the tip by less than 1 %',
  twist_curly_matters: 'hair with its curl: twist moves the tip by 1 % or more',
  'bdf_order2_at_1e-2': 'tip error 1e-2: BDF 2 needs no more work than BDF 5',
  'bdf_order2_at_1e-3': 'tip error 1e-3: BDF 2 needs no more work than BDF 5',
  'bdf_order2_at_1e-4': 'tip error 1e-4: BDF 2 needs no more work than BDF 5',
  'esdirk_steps_at_1e-3': 'tip error 1e-3: ESDIRK takes no more steps than BDF',
  'esdirk_work_at_1e-3': 'tip error 1e-3: ESDIRK needs no more work than BDF',
  reduced_cheaper: 'at 1 %, super_helix needs less time than der',
};

const verdicts = ['true', 'not true'];

const rows_of = (tables) =>
  (tables.family ?? [])
    .filter((row) => row.family === 'hair')
    .filter((row) => succeeded(row) && row.claim in statements && is_positive(row.value))
    .map((row) => ({
      ...row,
      statement: statements[row.claim],
      verdict: verdicts[is_set(row.holds) ? 0 : 1],
    }));

// Adaptive runs of the whole family replace those of --quick where they exist.
export function family_findings({ family_summary = [], family_tolerance_summary = [] }) {
  const whole = family_tolerance_summary.length > 0;
  return [
    ...family_summary.filter((row) => !whole || row.study !== 'tolerance'),
    ...family_tolerance_summary,
  ]
    .filter((row) => row.hairs > 0 && row.range === 'all')
    .map(
      (row) =>
        `${row.statement.charAt(0).toUpperCase()}${row.statement.slice(1)}` +
        `${row.model ? ` (${row.model}, ${row.integrator})` : ''}: for ` +
        `${format_number(100 * row.holds_share, 2)} % of ${row.hairs} ` +
        `${row.family === 'hair' ? 'hairs' : 'rods of other materials'}; ` +
        `median ${format_number(row.median)}, a tenth below ${format_number(row.decile_1)}, ` +
        `a tenth above ${format_number(row.decile_9)}` +
        `${row.no_answer > 0 ? `; ${row.no_answer} inconclusive` : ''}.`,
    );
}

// By statement: how many hairs are conclusive, and for how many it is true.
const shares_of = (rows) =>
  [...group_by(rows, (row) => row.statement)]
    .map(([statement, members]) => {
      const holds = members.filter((row) => row.verdict === verdicts[0]).length;
      return {
        statement,
        share: holds / members.length,
        text: `${Math.round((100 * holds) / members.length)} % of ${members.length}`,
      };
    })
    .sort((a, b) => b.share - a.share);

function headline(tables) {
  const rows = rows_of(tables);
  const shares = shares_of(rows);
  const always = shares.filter(({ share }) => share === 1).length;
  const most = shares.filter(({ share }) => share >= 0.5 && share < 1).length;
  const hairs = distinct(rows.map((row) => row.hair)).length;
  return (
    `Of ${shares.length} statements about ${hairs} hairs, ${always} are true for all of them, ${most} for half or ` +
    `more and ${shares.length - always - most} for less than half`
  );
}

export const family = {
  id: 'family',
  title: 'Statements on a family of hairs',
  table: 'family',
  headline,
  reading: `A mark is a hair, drawn from measured distributions of human hair; left is stiff or short, right is limp or long.
    On the right: the share of hairs for which the statement is true.`,
  caption: `For every conclusive hair, whether a statement is true, against its gravito-bending number. The values
    behind the answers are in the table. Made from family.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    const shares = shares_of(rows);
    const names = shares.map(({ statement }) => statement);
    const label_width = Math.min(330, 0.42 * width);
    const labels = names.map((name) => lines_of(name, label_width, 6.4));
    const x = log_channel(
      'gravito_bending',
      'gravito-bending number',
      log_extent(rows.map((row) => row.gravito_bending), 6),
    );
    const y = row_channel('statement', names, {
      labelExpr: `split((${JSON.stringify(
        Object.fromEntries(names.map((name, i) => [name, labels[i].join('|')])),
      )})[datum.value], '|')`,
      labelLineHeight: 12,
    });
    const scale = (range) => ({ domain: verdicts, range });
    const verdict = {
      field: 'verdict',
      type: 'nominal',
      title: 'the statement is',
      legend: { orient: 'top', direction: 'horizontal' },
    };
    return {
      width: row_width(width, [''], label_width + 90),
      height: { step: Math.max(36, 12 * Math.max(...labels.map((l) => l.length)) + 6), for: 'position' },
      layer: [
        {
          data: { values: rows },
          params: [legend_selection('pick_verdict', 'verdict')],
          mark: { type: 'point', filled: true, size: 45 },
          encoding: {
            x,
            y,
            yOffset: { field: 'verdict', scale: { domain: verdicts } },
            color: { ...verdict, scale: scale([blue, orange]) },
            shape: { ...verdict, scale: scale(['circle', 'triangle-up']) },
            opacity: dimmed_unless(['pick_verdict'], 0.75),
            tooltip: tooltips([
              ['hair', 'hair'],
              ['value', 'value', '.3g'],
              ['gravito_bending', 'gravito-bending number', '.3g'],
              ['kind', 'group'],
              ['state', 'dry or wet'],
              ['drive', 'drive'],
              ['length_m', 'length (m)', '.3g'],
              ['natural_curvature_per_m', 'natural curvature (1/m)', '.3g'],
              ['internal_friction_kg_m3_s', 'friction (kg m³/s)', '.2g'],
            ]),
          },
        },
        row_text(shares, y, 'text', { baseline: 'middle' }),
      ],
    };
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `One row for each of ${distinct(rows.map((row) => row.claim)).length} statements: up to
      ${distinct(rows.map((row) => row.hair)).length} hairs against the gravito-bending number; the mark shows whether the
      statement is true. ${shares_of(rows)
        .map(({ statement, text }) => `${statement}: ${text}`)
        .join('; ')}.`;
  },
};
