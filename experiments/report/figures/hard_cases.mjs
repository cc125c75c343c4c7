// Which model and integrator survives which hard case, at which step.
import { distinct, group_by, is_number } from '../src/tables.mjs';
import { format_time } from '../src/format.mjs';
import { by_pace, by_tolerance, pace } from '../src/pace.mjs';
import { spaced } from '../src/strand.mjs';
import { tooltips } from './common.mjs';
import { cell_fills } from './palette.mjs';

// From best to worst: name, letter in the cell, look.
export const outcomes = [
  ['stable and accurate', 'A', cell_fills.dark],
  ['stable', 'S', cell_fills.light],
  ['not finished', 'T', cell_fills.middle],
  ['unstable', 'U', cell_fills.strong],
  ['refused', '\u2013', undefined],
];
const rank = (outcome) => outcomes.findIndex(([name]) => name === outcome);
const letter = (outcome) => outcomes[rank(outcome)][1];

const rows_of = (tables) =>
  (tables.hard_cases ?? [])
    .filter((row) => rank(row.outcome) >= 0 && is_number(row.dt_s))
    .map((row) => ({
      ...row,
      name: spaced(row.model),
      situation: spaced(row.case),
      letter: letter(row.outcome),
      step: pace(row),
      error_pct: is_number(row.error_rel) ? 100 * row.error_rel : null,
    }));

// Variants of a model (tangents, ways to keep lengths) share its cell: the best of them.
const best_variants = (rows) =>
  [
    ...group_by(rows, (row) =>
      [row.case, row.model, row.integrator, row.step].join('|'),
    ).values(),
  ].map((members) =>
    members.reduce((a, b) => (rank(b.outcome) < rank(a.outcome) ? b : a)),
  );

const survives = (row) => row.outcome.startsWith('stable');

// What an asked error survives, over all models.
const tolerance_findings = (rows, admitted) =>
  [...group_by(rows, (row) => `${spaced(row.integrator)}, ${row.step}`)].map(
    ([name, members]) => {
      const all = admitted(members);
      const of = (outcome) => all.filter((row) => row.outcome === outcome).length;
      return (
        `${name}: of the ${all.length} pairs of case and model that it can be put to, ` +
        `${of('stable and accurate')} stable and accurate, ${of('stable')} stable, ` +
        `${of('unstable')} unstable, ${of('not finished')} not finished.`
      );
    },
  );

export function hard_findings(tables) {
  const rows = best_variants(rows_of(tables));
  if (rows.length === 0) return [];
  const fixed = rows.filter((row) => !by_tolerance(row));
  const longest = Math.max(...fixed.map((row) => row.dt_s));
  const at = fixed.filter((row) => row.dt_s === longest);
  const admitted = (members) => members.filter((row) => row.outcome !== 'refused');
  const scores = [...group_by(at, (row) => `${row.name}, ${spaced(row.integrator)}`)]
    .map(([name, members]) => ({
      name,
      all: admitted(members).length,
      stable: members.filter(survives).length,
      accurate: members.filter((row) => row.outcome === 'stable and accurate').length,
    }))
    .filter(({ all }) => all > 0)
    .sort((a, b) => b.stable - a.stable || b.accurate - a.accurate || a.all - b.all);
  const said = scores.slice(0, 6).map(
    ({ name, all, stable, accurate }) =>
      `${name}, steps of ${format_time(longest)}: survives ${stable} of the ${all} cases it can ` +
      `be put to, ${accurate} of them accurately.`,
  );
  const nobody = [...group_by(at, (row) => row.situation)]
    .filter(([, members]) => admitted(members).length > 0 && !members.some(survives))
    .map(([situation]) => situation);
  if (nobody.length > 0)
    said.push(`Nothing tried survives at ${format_time(longest)}: ${nobody.join(', ')}.`);
  return [...said, ...tolerance_findings(rows.filter(by_tolerance), admitted)];
}

export const hard_cases = {
  id: 'hard_cases',
  title: 'Case by case, at each step',
  table: 'hard_cases',
  caption: `One chart per integrator: hard cases downwards, models across. Each cell is split by time
    step, the shortest at the left, or by tolerance (the error that was asked for, over the length), the tightest at the left. A, dark green: stable and within the accepted error; S, light green: every
    bound of physics was kept, but the answer is further off; U, orange: a bound broke, or the step's equations
    found no solution; T, yellow: did not finish in the time a run was given; a dash, grey: the model or the
    integrator does not take this case, and says why. Variants of a model (its tangents, its ways to keep lengths) count as their best. Made from
    hard_cases.csv.`,

  rows: (tables) => best_variants(rows_of(tables)),

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const models = distinct(rows.map((row) => row.name));
    const steps = distinct(rows.toSorted(by_pace).map((row) => row.step));
    const known = outcomes.filter(([name]) => rows.some((row) => row.outcome === name));
    const room = Math.max(28, Math.min(58, Math.floor((width - 250) / models.length)));
    const chart = ([integrator, members]) => ({
      title: spaced(integrator),
      width: { step: room, for: 'position' },
      height: { step: 19 },
      data: { values: members },
      encoding: {
        x: {
          field: 'name',
          type: 'nominal',
          title: null,
          scale: { domain: models, paddingInner: 0.12 },
          axis: {
            orient: 'top',
            labelAngle: -45,
            labelLimit: 0,
            domain: false,
            ticks: false,
          },
        },
        xOffset: { field: 'step', scale: { domain: steps, paddingInner: 0 } },
        y: {
          field: 'situation',
          type: 'nominal',
          title: null,
          sort: distinct(rows.map((row) => row.situation)),
          axis: { labelLimit: 0, domain: false, ticks: false },
        },
      },
      layer: [
        {
          mark: { type: 'rect', stroke: theme.background, strokeWidth: 1 },
          encoding: {
            color: {
              field: 'outcome',
              type: 'nominal',
              title: null,
              scale: {
                domain: known.map(([name]) => name),
                range: known.map(([, , look]) => look?.fill ?? theme.grid),
              },
              legend: {
                orient: 'top',
                direction: 'horizontal',
                columns: width > 640 ? 5 : 2,
                symbolType: 'square',
                symbolSize: 220,
                symbolStrokeWidth: 0,
                labelExpr: `{${known
                  .map(([name, mark]) => `'${name}': '${mark}: ${name}'`)
                  .join(', ')}}[datum.value]`,
              },
            },
            tooltip: tooltips([
              ['situation', 'case'],
              ['name', 'model'],
              ['variant', 'variant'],
              ['integrator', 'integrator'],
              ['step', 'step'],
              ['outcome', 'outcome'],
              ['measure_name', 'what is looked at'],
              ['measure', 'its value', '.3g'],
              ['limit', 'must not exceed', '.3g'],
              ['error_pct', 'tip error (%)', '.3g'],
              ['why', 'why no better'],
            ]),
          },
        },
        ...known.map(([name, , look]) => ({
          transform: [{ filter: { field: 'outcome', equal: name } }],
          mark: {
            type: 'text',
            fontSize: 9,
            fontWeight: 600,
            color: look?.text ?? theme.muted,
            tooltip: null,
          },
          encoding: { text: { field: 'letter' } },
        })),
      ],
    });
    return {
      concat: [...group_by(rows, (row) => row.integrator)].map(chart),
      columns: 1,
      spacing: 26,
      resolve: { scale: { color: 'shared' }, legend: { color: 'shared' } },
    };
  },

  describe(tables) {
    const rows = this.rows(tables);
    const told = outcomes
      .map(([name]) => [name, rows.filter((row) => row.outcome === name).length])
      .filter(([, count]) => count > 0)
      .map(([name, count]) => `${count} ${name}`);
    return `${distinct(rows.map((row) => row.case)).length} hard cases,
      ${distinct(rows.map((row) => row.model)).length} models,
      ${distinct(rows.map((row) => row.integrator)).length} integrators, steps or tolerances:
      ${distinct(rows.toSorted(by_pace).map((row) => row.step)).join(', ')}:
      ${told.join(', ')}.`;
  },
};
