// What holds for one hair, hair by hair.
import { distinct, is_positive, is_set, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { layout, lines_of, log_channel, log_extent, panels, tooltips } from './common.mjs';

// What the panels call the values, and beyond which value the statement holds.
const statements = {
  exact_step_100ms: ['Largest stable step, backward Euler, exact', 'step (s)', 0.1],
  exact_step_100ms_bend: ['The same without twist', 'step (s)', 0.1],
  super_helix_step_longer: ['Largest step: super helix over der', 'ratio', 1],
  twist_straight_negligible: ['Leaving twist out, straight hair', 'change of the tip / L', 0.01],
  twist_curly_matters: ['Leaving twist out, the hair with its curl', 'change of the tip / L', 0.01],
  'bdf_order2_at_1e-2': ['BDF at 1e-2: order 5 over order 2', 'ratio of work', 1],
  'bdf_order2_at_1e-3': ['BDF at 1e-3: order 5 over order 2', 'ratio of work', 1],
  'bdf_order2_at_1e-4': ['BDF at 1e-4: order 5 over order 2', 'ratio of work', 1],
  'esdirk_steps_at_1e-3': ['Steps at 1e-3: BDF over ESDIRK', 'ratio of steps', 1],
  'esdirk_work_at_1e-3': ['Work at 1e-3: BDF over ESDIRK', 'ratio of work', 1],
  reduced_cheaper: ['Time at 1 %: der over super helix', 'ratio of times', 1],
};

const verdicts = ['true', 'not true'];
const least_drawn = 1e-5; // below it nothing is left of a change

const rows_of = (tables) =>
  (tables.family ?? [])
    .filter((row) => row.family === 'hair')
    .filter((row) => succeeded(row) && row.claim in statements && is_positive(row.value))
    .map((row) => ({
      ...row,
      shown: Math.max(row.value, least_drawn),
      verdict: verdicts[is_set(row.holds) ? 0 : 1],
    }));

// Runs by tolerance of the whole family, where there are those, stand for those of --quick.
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
        `${row.no_answer > 0 ? `; ${row.no_answer} gave no answer` : ''}.`,
    );
}

function panel(rows, claim, { panel_width, legend, theme, x }) {
  const [title, axis, bar] = statements[claim];
  const y = log_channel('shown', axis, log_extent([...rows.map((row) => row.shown), bar], 6));
  const scale = (range) => ({ domain: verdicts, range });
  const verdict = { field: 'verdict', type: 'nominal', title: 'the statement' };
  return {
    width: panel_width,
    height: 170,
    title: lines_of(title, panel_width),
    layer: [
      {
        data: { values: [{ shown: bar }] },
        mark: { type: 'rule', color: theme.muted, strokeDash: [4, 3] },
        encoding: { y },
      },
      {
        data: { values: rows },
        mark: { type: 'point', filled: true, size: 60, opacity: 0.85 },
        encoding: {
          x,
          y,
          color: { ...verdict, scale: scale(['#00805c', '#D55E00']), legend },
          shape: { ...verdict, scale: scale(['circle', 'triangle-up']), legend },
          tooltip: tooltips([
            ['hair', 'hair'],
            ['value', axis, '.3g'],
            ['gravito_bending', 'gravito-bending number', '.3g'],
            ['kind', 'group'],
            ['state', 'dry or wet'],
            ['drive', 'drive'],
            ['length_m', 'length (m)', '.3g'],
            ['natural_curvature_1_m', 'natural curvature (1/m)', '.3g'],
            ['internal_friction_kg_m3_s', 'friction (kg m³/s)', '.2g'],
          ]),
        },
      },
    ],
  };
}

export const family = {
  id: 'family',
  title: 'Statements on a family of hairs',
  table: 'family',
  caption: `What each statement is about, for every hair that gave an answer, against the hair's
    gravito-bending number. The dashed line is the value from which on, or up to which, the
    statement is true. Hairs are drawn from measured distributions of human hair. Made from
    family.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const claims = Object.keys(statements).filter((claim) =>
      rows.some((row) => row.claim === claim),
    );
    const { columns, panel_width, legend } = layout(width, claims.length, {
      labels: verdicts,
      above: true,
    });
    const x = log_channel(
      'gravito_bending',
      'gravito-bending number',
      log_extent(rows.map((row) => row.gravito_bending), 6),
    );
    return panels(
      claims.map((claim) =>
        panel(
          rows.filter((row) => row.claim === claim),
          claim,
          { panel_width, legend, theme, x },
        ),
      ),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `One panel for each of ${distinct(rows.map((row) => row.claim)).length} statements: its
      value for up to ${distinct(rows.map((row) => row.hair)).length} hairs, log scale, against
      the gravito-bending number; the mark says whether the statement is true.`;
  },
};
