// What share of the hard cases is survived, by integrator and step.
import { group_by } from '../src/tables.mjs';
import { by_pace, by_tolerance, pace } from '../src/pace.mjs';
import { judged, outcome_words, outcomes, survives } from '../src/hard.mjs';
import { tooltips } from './common.mjs';
import { row_channel, row_text, row_width } from './rows.mjs';

const percent = (part) => `${Math.round(100 * part)} %`;

// By integrator and step: pairs of case and model that it can run, and the parts of their
// outcomes. The most stable first.
export function hard_scores(tables) {
  const rows = judged(tables)
    .filter((row) => row.outcome !== 'refused')
    .sort(by_pace);
  return [...group_by(rows, (row) => `${row.integrator}|${pace(row)}`).values()]
    .map((members) => ({
      integrator: members[0].integrator,
      pace: pace(members[0]),
      method: `${members[0].integrator}, ${pace(members[0])}`,
      dt_s: members[0].dt_s,
      position_tol_rel: by_tolerance(members[0]) ? members[0].position_tol_rel : undefined,
      members,
      pairs: members.length,
      stable: members.filter(survives).length / members.length,
      accurate:
        members.filter((row) => row.outcome === 'stable and accurate').length / members.length,
    }))
    .sort((a, b) => b.stable - a.stable || b.accurate - a.accurate);
}

const text_of = ({ stable, accurate, pairs }) =>
  `${percent(stable)} stable, ${percent(accurate)} accurate, of ${pairs}`;

const bars_of = (tables) =>
  hard_scores(tables).flatMap(({ method, members, pairs }) =>
    outcomes.flatMap(([outcome], order) => {
      const count = members.filter((row) => row.outcome === outcome).length;
      return count === 0 ? [] : [{ method, outcome, order, count, pairs, share: count / pairs }];
    }),
  );

// The method that is stable most often at the longest step.
export function best_at_longest(tables) {
  const scores = hard_scores(tables).filter(({ tolerance }) => tolerance === undefined);
  const longest = Math.max(...scores.map(({ dt_s }) => dt_s));
  return scores.find(({ dt_s }) => dt_s === longest);
}

function headline(tables) {
  const [first] = hard_scores(tables);
  const longest = best_at_longest(tables);
  return [first, ...(longest && longest.method !== first.method ? [longest] : [])]
    .map(
      (score, i) =>
        `${score.integrator}${score.position_tol_rel === undefined ? ' at' : ','} ${score.pace} is stable in ` +
        `${percent(score.stable)} of ${score.pairs}${i === 0 ? ' stress tests' : ''} and accurate in ` +
        percent(score.accurate),
    )
    .join('; ');
}

export const hard_cases_summary = {
  id: 'hard_cases_summary',
  title: 'Which methods survive',
  table: 'hard_cases',
  headline,
  reading: `A stress test is a pair of hard case and model that the method can run; the best variant of a model counts.
    Stable: every bound of physics was kept. Accurate: the error is also within the accepted one.`,
  caption: `Outcomes of the hard cases by integrator and step or tolerance. Made from hard_cases.csv and, for the million
    steps, hard_cases_million_steps.csv.`,

  rows: bars_of,

  spec(tables, { width, theme }) {
    const scores = hard_scores(tables);
    const bars = bars_of(tables);
    const known = outcomes.filter(([name]) => bars.some((row) => row.outcome === name));
    const texts = scores.map((score) => ({ method: score.method, text: text_of(score) }));
    const names = scores.map(({ method }) => method);
    const narrow = width < 700;
    const y = row_channel('method', names, { grid: false });
    return {
      width: row_width(width, names, narrow ? 0 : 250),
      height: { step: 30 },
      layer: [
        {
          data: { values: bars },
          mark: { type: 'bar', stroke: theme.axis, strokeWidth: 0.5 },
          encoding: {
            y,
            x: {
              field: 'share',
              type: 'quantitative',
              title: null,
              stack: 'zero',
              scale: { domain: [0, 1] },
              axis: { values: [0, 0.25, 0.5, 0.75, 1], format: '.0%', grid: false },
            },
            order: { field: 'order', type: 'quantitative' },
            color: {
              field: 'outcome',
              type: 'nominal',
              title: null,
              scale: {
                domain: known.map(([name]) => name),
                range: known.map(([, , look]) => look?.fill ?? theme.background),
              },
              legend: {
                orient: 'top',
                direction: 'horizontal',
                columns: narrow ? 1 : 5,
                symbolType: 'square',
                symbolSize: 160,
                symbolStrokeWidth: 0.5,
                symbolStrokeColor: theme.axis,
                labelExpr: `(${JSON.stringify(outcome_words)})[datum.value]`,
              },
            },
            tooltip: tooltips([
              ['method', 'method'],
              ['outcome', 'outcome'],
              ['count', 'stress tests'],
              ['pairs', 'of'],
            ]),
          },
        },
        ...(narrow ? [] : [row_text(texts, y, 'text')]),
      ],
    };
  },

  describe(tables) {
    return `Bars of outcomes. ${hard_scores(tables)
      .map((score) => `${score.method}: ${text_of(score)}`)
      .join('; ')}.`;
  },
};
