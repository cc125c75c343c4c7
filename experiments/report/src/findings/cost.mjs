// The cheapest runs for a target error, and the effect of each choice, as sentences.
import { distinct, group_by, is_positive, succeeded } from '../tables.mjs';
import {
  format_elements,
  format_number,
  format_ratio,
  format_steps,
  format_time,
} from '../format.mjs';
import { code, spaced } from '../strand.mjs';

export const cost_rows = (tables) =>
  (tables.cost_of_accuracy ?? [])
    .filter(
      (row) =>
        succeeded(row) && is_positive(row.wall_s_per_sim_s) && is_positive(row.error_rel),
    )
    .map((row) => ({
      ...row,
      name: spaced(row.model),
      method: spaced(row.integrator),
      wall_ms: 1e3 * row.wall_s_per_sim_s,
      error_pct: 100 * row.error_rel,
      steps: format_steps(row),
      how: [row.modes, row.jacobian, row.solver, row.options].filter(Boolean).join(', '),
    }));

export const percent = (value) => `${format_number(100 * value)} %`;

export const run_text = (row, named = spaced) =>
  `${named(row.model)}, ${named(row.integrator)}, ${format_elements(row)} elements, ` +
  format_steps(row, (dt) => `steps of ${format_time(dt)}`);

export const of_kind = (rows, kind) => rows.filter((row) => row.kind === kind);

export const wanted_of = (targets) => (targets.includes(0.01) ? 0.01 : targets[0]);

// One sentence per scene at `target`, the winner and the runner-up.
function winner_sentences(rows, target) {
  return [...group_by(rows, (row) => row.scene)].flatMap(([scene, members]) => {
    const winner = of_kind(members, 'winner').find(
      (row) => row.target_error_rel === target,
    );
    if (!winner) return [];
    const second = of_kind(members, 'runner_up').find(
      (row) => row.target_error_rel === target,
    );
    return [
      `${spaced(scene)}, ${percent(target)}: ${run_text(winner, code)}, ` +
        `${format_time(winner.wall_s_per_sim_s)} per simulated second` +
        (second
          ? `. Next: ${run_text(second, code)}, ` +
            `${format_ratio(second.wall_ms / winner.wall_ms)} the time.`
          : '.'),
    ];
  });
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const half = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

// The median, over scenes and targets, of what replacing one choice costs.
export const choice_medians = (rows) =>
  [
    ...group_by(
      of_kind(rows, 'without').filter((row) => is_positive(row.cost_factor)),
      (row) => row.choice,
    ),
  ]
    .map(([choice, members]) => ({
      choice,
      factor: median(members.map((row) => row.cost_factor)),
    }))
    .sort((a, b) => b.factor - a.factor);

const choice_words = {
  elements: 'number of elements',
  dt_s: 'time step',
  tolerance: 'step control',
  extrapolated: 'extrapolation',
  cuts: 'adaptive mesh',
  refresh: 'refresh of the matrix',
};
export const choice_name = (choice) => choice_words[choice] ?? spaced(choice);

export function cost_findings(tables) {
  const rows = cost_rows(tables);
  const targets = distinct(of_kind(rows, 'winner').map((row) => row.target_error_rel));
  const wanted = wanted_of(targets);
  const medians = choice_medians(rows);
  const said = winner_sentences(rows, wanted);
  if (medians.length > 0)
    said.push(
      `Effect of a choice, as the time with the next best choice over the winner's, median over ` +
        `scenes and targets: ${medians
          .map(({ choice, factor }) => `${choice_name(choice)} ${format_ratio(factor)}`)
          .join(', ')}.`,
    );
  return [
    ...said,
    ...targets
      .filter((target) => target !== wanted)
      .flatMap((target) => winner_sentences(rows, target)),
  ];
}
