// The cheapest way to a wanted error.
import { distinct, group_by, is_number, is_positive } from '../../src/tables.mjs';
import { format_elements, format_steps } from '../../src/format.mjs';
import { spaced } from '../../src/strand.mjs';
import { median, number, percent, range, rows_of, table, time } from '../markdown.mjs';

const target = 0.01;

const way = (row) => {
  const options = [row.modes, row.tangent].filter(Boolean).join(', ');
  return `${row.model}${options ? ` (${options})` : ''}, ${row.integrator}`;
};

const of_kind = (tables, kind) =>
  rows_of(tables, 'cost_of_accuracy', { kind, target_error_rel: target });

export const scenes = (tables) =>
  String(
    distinct(
      rows_of(tables, 'cost_of_accuracy', { kind: 'winner' }).map((row) => row.scene),
    ).length,
  );

const cheapest = (rows) => rows.filter((row) => is_positive(row.wall_s_per_sim_s));

export function winners_table(tables) {
  const given = rows_of(tables, 'cost_of_accuracy', { kind: 'as_given' });
  const rows = cheapest(of_kind(tables, 'winner')).map((winner) => {
    const next = of_kind(tables, 'runner_up').find((row) => row.scene === winner.scene);
    const shipped = given.find((row) => row.scene === winner.scene);
    const factor = shipped?.wall_s_per_sim_s / winner.wall_s_per_sim_s;
    return [
      spaced(winner.scene),
      way(winner),
      `${format_elements(winner)}, ${format_steps(winner, time)}`,
      time(winner.wall_s_per_sim_s),
      next ? way(next) : '',
      next ? number(next.cost_factor) : '',
      shipped ? `${percent(shipped.error_rel)}, ${number(factor)}` : '',
    ];
  });
  return table(
    [
      'scene',
      'cheapest within 1 %',
      'elements, step',
      'time per simulated second',
      'next',
      'times as long',
      'file as shipped: error, times as long',
    ],
    rows,
  );
}

// The cheapest run for every wanted error, scene by scene.
export function winners_by_target(tables) {
  const winners = cheapest(rows_of(tables, 'cost_of_accuracy', { kind: 'winner' }));
  const targets = distinct(winners.map((row) => row.target_error_rel)).sort((a, b) => b - a);
  const cell = (row) =>
    row && row.status === 'ok'
      ? `${way(row)}, ${format_elements(row)}, ${format_steps(row, time)}: ` +
        time(row.wall_s_per_sim_s)
      : 'none found';
  return table(
    ['scene', ...targets.map((target) => percent(target))],
    distinct(winners.map((row) => row.scene)).map((scene) => [
      spaced(scene),
      ...targets.map((target) =>
        cell(winners.find((row) => row.scene === scene && row.target_error_rel === target)),
      ),
    ]),
  );
}

// "linearly_implicit_midpoint 7 of 7": how often each integrator wins.
export function winning_integrators(tables) {
  const rows = cheapest(of_kind(tables, 'winner'));
  return [...group_by(rows, (row) => row.integrator)]
    .sort((a, b) => b[1].length - a[1].length)
    .map(([name, members]) => `\`${name}\` on ${members.length} of ${rows.length} scenes`)
    .join(', ');
}

export function winning_models(tables) {
  const rows = cheapest(of_kind(tables, 'winner'));
  return [...group_by(rows, (row) => row.model)]
    .sort((a, b) => b[1].length - a[1].length)
    .map(([name, members]) => `\`${name}\` on ${members.length}`)
    .join(', ');
}

const words = {
  elements: 'number of elements',
  dt_s: 'time step',
  tolerance: 'step control',
  extrapolated: 'extrapolation',
  cuts: 'cuts of elements',
  refresh: 'refresh of the matrix',
};

// What replacing one choice by the next best costs: the median over scenes and errors.
export function choices(tables) {
  const rows = rows_of(tables, 'cost_of_accuracy', { kind: 'without' }).filter((row) =>
    is_positive(row.cost_factor),
  );
  return [...group_by(rows, (row) => row.choice)]
    .map(([choice, members]) => ({
      choice: words[choice] ?? spaced(choice),
      factor: median(members.map((row) => row.cost_factor)),
    }))
    .sort((a, b) => b.factor - a.factor)
    .map(({ choice, factor }) => `${choice} ${number(factor)}`)
    .join(', ');
}

// Largest error of a winner's neighbours (more elements, shorter steps, changed data)
// over the wanted error: what tells a robust winner from a lucky one.
export const margins = (tables) => {
  const known = of_kind(tables, 'winner').filter((row) => is_number(row.margin));
  if (known.length === 0) return 'not known for this table';
  return range(known.map((row) => row.margin));
};

// How far two references of the continuous rod are apart at most.
export const gap = (tables) =>
  number(
    Math.max(
      ...rows_of(tables, 'cost_of_accuracy', { kind: 'winner' }).map((row) => row.reference_gap),
    ),
  );
