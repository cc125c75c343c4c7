// What the swing's rows of work_precision.csv and other_simulators_swing.csv say, as sentences.
import { is_positive, minimum_by, swing_rows } from '../tables.mjs';
import { format_number, format_ratio, format_time } from '../format.mjs';
import { fastest_at, swing_levels, swing_runs } from '../strand.mjs';
import { failure_sentence } from './drift.mjs';

const step = (row) =>
  is_positive(row.dt_s)
    ? `dt ${format_time(row.dt_s)}`
    : is_positive(row.rtol)
      ? `rtol ${format_number(row.rtol)}`
      : is_positive(row.position_tol_rel)
        ? `tolerance ${format_number(row.position_tol_rel)}`
        : '';

function best_peer(rows, { simulator }) {
  return minimum_by(
    rows.filter((row) => is_positive(row[simulator])),
    (row) => row[simulator],
  );
}

function level_sentence(tables, level, kind) {
  const { other_simulators_swing = [] } = tables;
  const runs = swing_runs(swing_rows(tables), kind);
  const best = fastest_at(runs, level.error);
  const what = `${level.name} ${kind} error`;
  if (best === undefined)
    return runs.length > 0 ? [`No run reaches ${what}.`] : [];
  const setting = [step(best), `${best.elements} elements`].filter(Boolean).join(', ');
  const ours = `${what}: ${best.series} (${setting}) takes ${format_time(best.wall_s)} for 2 simulated seconds`;
  if (kind !== 'time') return [`${ours}.`];
  const met = best.wall_s <= level.target_s;
  const target = `, ${met ? 'within' : 'not within'} the target of ${format_time(level.target_s)}`;
  const simulator = best_peer(other_simulators_swing, level);
  const other = simulator
    ? `; the fastest published simulator (${simulator.simulator}) ${format_time(simulator[level.simulator])}, ` +
      `${format_ratio(simulator[level.simulator] / best.wall_s)} ours`
    : '';
  return [`${ours}${target}${other}.`];
}

export const swing_finding = (tables) =>
  swing_levels.flatMap((level) => level_sentence(tables, level, 'time')).join(' ');

export function swing_findings(tables) {
  return [
    ...swing_levels.flatMap((level) => level_sentence(tables, level, 'total')),
    ...failure_sentence(swing_rows(tables)),
  ];
}

export function swing_answer(tables) {
  const finding = swing_finding(tables);
  return finding === '' ? undefined : finding;
}
