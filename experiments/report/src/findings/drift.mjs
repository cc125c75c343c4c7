// What constraint_drift.csv says, as sentences computed from its rows.
import {
  distinct,
  group_by,
  is_number,
  is_positive,
  is_set,
  minimum_by,
  study_rows,
  succeeded,
} from '../tables.mjs';
import { format_number, format_ratio } from '../format.mjs';
import { code, spaced } from '../strand.mjs';
import { damping_ratio } from '../../figures/drift_recovery.mjs';

const metres = (value) => (value === 0 ? 'exactly zero' : `${format_number(value)} m`);
const is_given = (value) => value !== null && value !== undefined && value !== '';

// How near the measured boundary must be to the predicted one.
const boundary_within = 0.05;

// Relative difference below which two drifts count as equal.
const indifferent = 0.05;

// Acceleration level against the best feedback pair for one system, integrator and step.
export function feedback_gains(rows) {
  const runs = rows.filter(
    (row) =>
      row.study !== 'recovery' &&
      succeeded(row) &&
      is_number(row.g_max) &&
      !is_positive(row.violation),
  );
  return [
    ...group_by(runs, (r) =>
      [r.system, r.integrator, r.dt_s, r.rtol, r.t_end_s].join('|'),
    ).values(),
  ].flatMap((members) => {
    const without = members.find((row) => row.formulation === 'acceleration');
    const best = minimum_by(
      members.filter((row) => row.formulation === 'baumgarte'),
      (row) => row.g_max,
    );
    if (!without || !best || !is_positive(without.g_max) || !is_positive(best.g_max))
      return [];
    return [
      {
        system: without.system,
        integrator: without.integrator,
        without,
        best,
        gain: without.g_max / best.g_max,
        cost: best.wall_s / without.wall_s,
      },
    ];
  });
}

// "<system>, <integrator>: of the gains tried, ... drift least" with the direction read off
// the ratio, and how little such gains damp.
function feedback_sentence({ system, integrator, without, best, gain, cost }) {
  const pair = `alpha = ${format_number(best.alpha)} and beta = ${format_number(best.beta)}`;
  const same = Math.abs(gain - 1) < indifferent;
  const change = same
    ? 'about the same as'
    : gain > 1
      ? `${format_ratio(gain)} smaller than`
      : `${format_ratio(1 / gain)} larger than`;
  return (
    `${spaced(system)}, ${code(integrator)}: of the Baumgarte gains tried, ${pair} leave the smallest drift, ` +
    `${metres(best.g_max)}. That is ${change} at acceleration level (${metres(without.g_max)}), for ` +
    `${format_ratio(cost)} the time${gain < 1 && !same ? ': feedback hurts here' : ''}. ` +
    `Their damping ratio beta / (2 sqrt(alpha)) is ${format_number(damping_ratio(best), 2)}.`
  );
}

function exact_sentences(rows) {
  return ['projection', 'rattle', 'parametric'].flatMap((formulation) => {
    const runs = rows.filter(
      (row) =>
        row.study === 'formulation' &&
        succeeded(row) &&
        row.formulation === formulation &&
        is_number(row.g_max),
    );
    if (runs.length === 0) return [];
    const worst = Math.max(...runs.map((row) => row.g_max));
    return [
      `${formulation}: ${worst === 0 ? 'exactly zero' : `at most ${metres(worst)}`} ` +
        `over ${runs.length} run${runs.length === 1 ? '' : 's'}.`,
    ];
  });
}

function index2_sentences(rows) {
  const runs = rows.filter(
    (row) => row.formulation === 'index2_ggl' && succeeded(row) && is_positive(row.steps),
  );
  return [
    ...group_by(runs, (row) => [row.system, row.integrator, row.rtol].join('|')).values(),
  ].flatMap((members) => {
    const out = members.find((row) => is_set(row.suppress_algebraic));
    const kept = members.find(
      (row) => is_given(row.suppress_algebraic) && !is_set(row.suppress_algebraic),
    );
    if (!out || !kept) return [];
    return [
      `${spaced(out.system)}, ${code(out.integrator)} on the stabilised index 2 form: without the algebraic ` +
        `variables in the error test, the drift is ${metres(out.g_max)} in ${out.steps} steps. With them, the run ` +
        `takes ${kept.steps} steps (${format_ratio(kept.steps / out.steps)}).`,
    ];
  });
}

export function boundary_sentences(tables) {
  return [
    ...group_by(
      study_rows(tables, 'constraint_drift', 'limit').filter((row) => is_number(row.rel_gap)),
      (row) => row.integrator,
    ),
  ].map(([integrator, members]) => {
    const worst = Math.max(...members.map((row) => Math.abs(row.rel_gap)));
    return (
      `${code(integrator)}: the measured stability boundary is within ` +
      `${format_number(100 * worst, 2)} % of the predicted one at ${members.length} damping ` +
      `ratio${members.length === 1 ? '' : 's'}${worst > boundary_within ? `, outside the target of ${format_number(100 * boundary_within)} %` : ''}.`
    );
  });
}

export function recovery_sentences(rows) {
  const runs = rows.filter(
    (row) =>
      row.study === 'recovery' &&
      succeeded(row) &&
      is_positive(row.recovery_time_s) &&
      is_positive(row.alpha),
  );
  return [
    ...group_by(runs, (r) =>
      [r.system, r.integrator, r.alpha, r.dt_s].join('|'),
    ).values(),
  ]
    .map((members) => minimum_by(members, (row) => row.recovery_time_s))
    .map(
      (best) =>
        `${spaced(best.system)}, ${code(best.integrator)}, ` +
        `alpha = ${format_number(best.alpha)} 1/s²: fastest recovery at ` +
        `beta / (2 sqrt(alpha)) = ${format_number(damping_ratio(best))}, in ` +
        `${format_number(best.recovery_time_s)} s.`,
    );
}

export function failure_sentence(rows) {
  const failed = rows.filter((row) => !succeeded(row));
  if (failed.length === 0) return [];
  const kinds = [...group_by(failed, (row) => row.status)]
    .map(([status, members]) => `${members.length} ${status || 'without status'}`)
    .join(', ');
  return [
    `${failed.length} of ${rows.length} runs did not finish (${kinds}); each is a row of ` +
      'the table, with its reason.',
  ];
}

export function drift_findings({ constraint_drift: rows = [] }) {
  const gains = feedback_gains(rows).sort((a, b) => b.gain - a.gain);
  const helped = gains.filter(({ gain }) => gain >= 1);
  const hurt = gains.filter(({ gain }) => gain < 1).reverse();
  return [...helped.slice(0, 2), ...hurt.slice(0, 1)]
    .map(feedback_sentence)
    .concat(
      exact_sentences(rows),
      index2_sentences(rows).slice(0, 1),
      // A limit is a search of many runs, not one.
      failure_sentence(rows.filter((row) => row.study !== 'limit')),
      [...helped.slice(2), ...hurt.slice(1)].map(feedback_sentence),
      index2_sentences(rows).slice(1),
    );
}

// The one-sentence answer to "how far, and at what cost".
export function drift_answer({ constraint_drift: rows = [] }) {
  const gains = feedback_gains(rows);
  if (gains.length === 0) return undefined;
  const worst = minimum_by(gains, (g) => -g.without.g_max);
  const helped = gains.filter((g) => g.gain > 1).length;
  const rival = minimum_by(
    rows.filter(
      (row) =>
        row.study === 'formulation' &&
        succeeded(row) &&
        row.system === worst.system &&
        row.formulation === 'projection' &&
        row.integrator === worst.integrator &&
        is_number(row.g_max),
    ),
    (row) => row.g_max,
  );
  const projected = rival
    ? ` Projection leaves ${metres(rival.g_max)} for ` +
      `${format_ratio(rival.wall_s / worst.without.wall_s)} the time.`
    : '';
  return (
    `Left alone at acceleration level, constraints drift by up to ` +
    `${metres(worst.without.g_max)} (${spaced(worst.system)}, ${code(worst.integrator)}). Of the gains tried, the ` +
    `one that drifts least brings that run to ${metres(worst.best.g_max)} for ${format_ratio(worst.cost)} ` +
    `the time.${projected} Feedback helps in ${helped} of the ${gains.length} combinations of ` +
    `${distinct(gains.map((g) => g.system)).length} systems and ` +
    `${distinct(gains.map((g) => g.integrator)).length} integrators.`
  );
}
