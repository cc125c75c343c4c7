// Which model and integrator survives which hard case, at which step.
import { distinct, group_by, is_number } from '../src/tables.mjs';
import { format_time } from '../src/format.mjs';
import { by_pace, by_tolerance, pace } from '../src/pace.mjs';
import { code, spaced } from '../src/strand.mjs';
import { tooltips } from './common.mjs';
import { best_at_longest } from './hard_cases_summary.mjs';
import { row_channel } from './rows.mjs';
import {
  best_variants,
  hard_rows,
  judged,
  not_compared,
  outcome_words,
  outcomes,
  rank,
  survives,
} from '../src/hard.mjs';

const drawn = (rows) =>
  rows
    .filter((row) => is_number(row.dt_s))
    .map((row) => ({
      ...row,
      name: spaced(row.model),
      situation: spaced(row.case) + (row.cut > 0 ? `, cut to ${row.cut}` : ''),
      letter: outcomes[rank(row)][1],
      step: pace(row),
      error_pct: is_number(row.error_rel) ? 100 * row.error_rel : null,
    }));
const rows_of = (tables) => drawn(best_variants(hard_rows(tables)));

// What a tolerance survives, over all models.
const tolerance_findings = (rows, admitted) =>
  [...group_by(rows, (row) => `With ${code(row.integrator)} and ${row.step}`)].map(
    ([name, members]) => {
      const all = admitted(members);
      const of = (outcome) => all.filter((row) => row.outcome === outcome).length;
      return (
        `${name}, ${of('stable and accurate')} of the ${all.length} pairs of case and model are stable and accurate. ` +
        `${of('stable')} are stable and inaccurate, ${of(not_compared)} stable without a reference, ` +
        `${of('unstable')} unstable and ${of('not finished')} not finished.`
      );
    },
  );

export function hard_findings(tables) {
  const rows = drawn(judged(tables));
  if (rows.length === 0) return [];
  const fixed = rows.filter((row) => !by_tolerance(row));
  const longest = Math.max(...fixed.map((row) => row.dt_s));
  const at = fixed.filter((row) => row.dt_s === longest);
  const admitted = (members) => members.filter((row) => row.outcome !== 'refused');
  const scores = [...group_by(at, (row) => `${code(row.model)} with ${code(row.integrator)}`)]
    .map(([name, members]) => ({
      name,
      all: admitted(members).length,
      stable: members.filter(survives).length,
      accurate: members.filter((row) => row.outcome === 'stable and accurate').length,
      compared: members.filter((row) => survives(row) && row.outcome !== not_compared).length,
    }))
    .filter(({ all }) => all > 0)
    .sort((a, b) => b.stable - a.stable || b.accurate - a.accurate || a.all - b.all);
  const said = scores.slice(0, 6).map(
    ({ name, all, stable, accurate, compared }) =>
      `${name} survives ${stable} of the ${all} cases that it can run at steps of ${format_time(longest)}. ` +
      `Of the ${compared} survivors with a reference, ${accurate} are accurate.`,
  );
  const nobody = [...group_by(at, (row) => row.case)]
    .filter(([, members]) => admitted(members).length > 0 && !members.some(survives))
    .map(([name, [{ cut }]]) => code(name) + (cut > 0 ? ` (its first ${cut} steps)` : ''));
  if (nobody.length > 0)
    said.push(`No model and method survive at steps of ${format_time(longest)}: ${nobody.join(', ')}.`);
  return [...said, ...tolerance_findings(rows.filter(by_tolerance), admitted)];
}

// Of the one integrator that is drawn; of all where none has a fixed step.
const shown = (rows, integrator) =>
  rows.filter((row) => integrator === undefined || row.integrator === integrator);

const steps_of = (rows) => distinct([...rows].sort(by_pace).map((row) => row.step));

// Values of a field, those with the most survivors first.
const by_survival = (rows, field) =>
  [...group_by(rows, (row) => row[field])]
    .map(([name, members]) => [name, members.filter(survives).length])
    .sort(([, a], [, b]) => b - a)
    .map(([name]) => name);

function headline(tables) {
  const { integrator, members, stable, dt_s } = best_at_longest(tables) ?? {};
  if (integrator === undefined) return 'No fixed step was run';
  const survivors = [...group_by(members, (row) => row.model)]
    .map(([model, of]) => ({ model, all: of.length, kept: of.filter(survives).length }))
    .sort((a, b) => b.kept / b.all - a.kept / a.all || b.all - a.all);
  const most = Math.max(...survivors.map(({ all }) => all));
  const tried = survivors.filter(({ all }) => all >= most / 2);
  const [first] = tried;
  const last = tried.at(-1);
  return (
    `${integrator} at ${format_time(dt_s)}: ${spaced(first.model)} survives ${first.kept} of ` +
    `${first.all} cases, ${spaced(last.model)} ${last.kept} of ${last.all}; ` +
    `all models together ${Math.round(100 * stable)} %`
  );
}

export const hard_cases = {
  id: 'hard_cases',
  title: 'Case by case',
  table: 'hard_cases',
  headline,
  reading(tables) {
    const rows = shown(rows_of(tables), best_at_longest(tables)?.integrator);
    return (
      `In each cell, from left to right: ${steps_of(rows).join(', ')}. Rows are hard cases, columns are models, both ` +
      'with the most survivors first. A, S and N survive: every bound of physics was kept.'
    );
  },
  caption: `The integrator that survives most cases at the longest step; the table has all integrators. Each cell is
    split by step. A: stable and within the accepted error. S: stable, with a larger error. N: stable, without a reference.
    U: a bound broke, or the equations of a step found no solution. T: not finished within the work limit. A dash: the model
    or the integrator does not support the case, and the table gives the reason. The best variant of a model counts. Made from
    hard_cases.csv and, for the million steps, hard_cases_million_steps.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const best = best_at_longest(tables)?.integrator;
    const rows = shown(rows_of(tables), best);
    const [models, cases] = ['name', 'situation'].map((field) => by_survival(rows, field));
    const steps = steps_of(rows);
    const known = outcomes.filter(([name]) => rows.some((row) => row.outcome === name));
    const room = Math.max(12 * steps.length, Math.min(52, Math.floor((width - 210) / models.length)));
    const cell = {
      x: {
        field: 'name',
        type: 'nominal',
        title: null,
        scale: { domain: models, paddingInner: 0.1 },
        axis: { orient: 'top', labelAngle: -40, labelLimit: 0, domain: false, ticks: false },
      },
      xOffset: { field: 'step', scale: { domain: steps, paddingInner: 0 } },
      y: row_channel('situation', cases, { grid: false }),
    };
    return {
      width: { step: room, for: 'position' },
      height: { step: 18 },
      // The slanted name of the last model reaches beyond its column.
      padding: { left: 4, top: 4, right: 44, bottom: 4 },
      data: { values: rows },
      encoding: cell,
      layer: [
        {
          mark: { type: 'rect', stroke: theme.axis, strokeWidth: 0.3 },
          encoding: {
            color: {
              field: 'outcome',
              type: 'nominal',
              title: null,
              scale: {
                domain: known.map(([name]) => name),
                range: known.map(([, , look]) => (look ? look.fill ?? theme.background : theme.grid)),
              },
              legend: {
                orient: 'bottom',
                direction: 'horizontal',
                columns: width > 640 ? 3 : 1,
                symbolType: 'square',
                symbolSize: 220,
                symbolStrokeWidth: 0.5,
                symbolStrokeColor: theme.axis,
                labelExpr: `{${known
                  .map(([name, mark]) => `'${name}': '${mark}: ${outcome_words[name]}'`)
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
              ['measure_name', 'measure'],
              ['measure', 'value', '.3g'],
              ['limit', 'limit', '.3g'],
              ['error_pct', 'tip error (%)', '.3g'],
              ['why', 'reason'],
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
      ${distinct([...rows].sort(by_pace).map((row) => row.step)).join(', ')}:
      ${told.join(', ')}.`;
  },
};
