// Which model and integrator survives which hard case, at which step.
import { distinct, group_by, is_number } from '../src/tables.mjs';
import { format_time } from '../src/format.mjs';
import { by_pace, by_tolerance, pace } from '../src/pace.mjs';
import { spaced } from '../src/strand.mjs';
import { tooltips } from './common.mjs';
import { best_variants, hard_rows, not_compared, outcomes, rank, survives } from '../src/hard.mjs';

const rows_of = (tables) =>
  best_variants(hard_rows(tables).filter((row) => is_number(row.dt_s))).map((row) => ({
    ...row,
    name: spaced(row.model),
    situation: spaced(row.case) + (row.cut > 0 ? `, cut to ${row.cut}` : ''),
    letter: outcomes[rank(row)][1],
    step: pace(row),
    error_pct: is_number(row.error_rel) ? 100 * row.error_rel : null,
  }));

// What a tolerance survives, over all models.
const tolerance_findings = (rows, admitted) =>
  [...group_by(rows, (row) => `${spaced(row.integrator)}, ${row.step}`)].map(
    ([name, members]) => {
      const all = admitted(members);
      const of = (outcome) => all.filter((row) => row.outcome === outcome).length;
      return (
        `${name}: of the ${all.length} pairs of case and model that it can run, ` +
        `${of('stable and accurate')} are stable and accurate, ${of('stable')} stable and inaccurate, ` +
        `${of(not_compared)} stable without a reference, ${of('unstable')} unstable and ` +
        `${of('not finished')} not finished.`
      );
    },
  );

export function hard_findings(tables) {
  const rows = rows_of(tables).filter((row) => row.cut === 0);
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
      compared: members.filter((row) => survives(row) && row.outcome !== not_compared).length,
    }))
    .filter(({ all }) => all > 0)
    .sort((a, b) => b.stable - a.stable || b.accurate - a.accurate || a.all - b.all);
  const said = scores.slice(0, 6).map(
    ({ name, all, stable, accurate, compared }) =>
      `${name}, steps of ${format_time(longest)}: survives ${stable} of the ${all} cases that it can ` +
      `run, and is accurate in ${accurate} of the ${compared} of these that have a reference.`,
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
    step or tolerance, in the order that stands above the chart. A, dark green: stable and within the accepted error. S, light
    green: every bound of physics was kept, but the error is larger. N, white: every bound was kept, but there is no
    reference to compare with. U, orange: a bound broke, or the step's equations found no solution. T, yellow: did not finish
    within its work. A dash, grey: the model or the integrator does not support the case, and the table gives the reason. The best
    variant of a model counts (its tangents, its ways to keep lengths). Made from hard_cases.csv and, for the million steps,
    hard_cases_million_steps.csv.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const models = distinct(rows.map((row) => row.name));
    const known = outcomes.filter(([name]) => rows.some((row) => row.outcome === name));
    const room = Math.max(28, Math.min(58, Math.floor((width - 250) / models.length)));
    const chart = ([integrator, members]) => {
      const steps = distinct(members.toSorted(by_pace).map((row) => row.step));
      return {
      title: {
        text: spaced(integrator),
        subtitle: `from left to right in each cell: ${steps.join(', ')}`,
        subtitleColor: theme.muted,
      },
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
                orient: 'top',
                direction: 'horizontal',
                columns: width > 640 ? 6 : 2,
                symbolType: 'square',
                symbolSize: 220,
                symbolStrokeWidth: 0.5,
                symbolStrokeColor: theme.axis,
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
      };
    };
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
