// The cheapest run that reaches a target error.
import { distinct, group_by, is_number, is_positive, is_set } from '../../src/tables.mjs';
import { format_elements, format_steps } from '../../src/format.mjs';
import { spaced } from '../../src/strand.mjs';
import { median, must, number, percent, range, rows_of, table, time } from '../markdown.mjs';

const target = 0.01;

const way = (row) => {
  const options = [row.modes, row.tangent].filter(Boolean).join(', ');
  return `${row.model}${options ? ` (${options})` : ''}, ${row.integrator}`;
};

const of_kind = (tables, kind, target_error_rel = target) =>
  rows_of(tables, 'cost_of_accuracy', { kind, target_error_rel });

export const scenes = (tables) =>
  String(
    distinct(
      rows_of(tables, 'cost_of_accuracy', { kind: 'winner' }).map((row) => row.scene),
    ).length,
  );

const cheapest = (rows) => rows.filter((row) => is_positive(row.wall_s_per_sim_s));
const all_winners = (tables) => cheapest(rows_of(tables, 'cost_of_accuracy', { kind: 'winner' }));
const winners = (tables) => cheapest(of_kind(tables, 'winner'));

// The run that no timing tells from the winner; undefined: there is none.
const tied_with = (tables, winner) =>
  of_kind(tables, 'runner_up', winner.target_error_rel).find(
    (row) => row.scene === winner.scene && is_set(row.tied),
  );

// Largest error of a winner's neighbours (more elements, shorter steps, changed data), what
// tells a robust winner from a lucky one.
const neighbours = (row) =>
  is_number(row.error_neighbours_rel) ? percent(row.error_neighbours_rel) : 'not measured';

export function winners_table(tables) {
  const given = rows_of(tables, 'cost_of_accuracy', { kind: 'as_given' });
  const rows = winners(tables).map((winner) => {
    const next = of_kind(tables, 'runner_up').find((row) => row.scene === winner.scene);
    const shipped = given.find((row) => row.scene === winner.scene);
    const factor = shipped?.wall_s_per_sim_s / winner.wall_s_per_sim_s;
    return [
      spaced(winner.scene),
      way(winner),
      `${format_elements(winner)}, ${format_steps(winner, time)}`,
      `${percent(winner.error_rel)}, ${neighbours(winner)}`,
      time(winner.wall_s_per_sim_s),
      next ? way(next) : '',
      next ? `${number(next.cost_factor)}${is_set(next.tied) ? ' (tie)' : ''}` : '',
      shipped ? `${percent(shipped.error_rel)}, ${number(factor)}` : '',
    ];
  });
  return table(
    [
      'scene',
      'cheapest at 1 %',
      'elements, step',
      'error: nominal, largest of the neighbours',
      'time per simulated second',
      'next best',
      "its time over the winner's",
      'scene as shipped: error, time over the winner\'s',
    ],
    rows,
  );
}

// The cheapest run for every target error, scene by scene.
export function winners_by_target(tables) {
  const rows = all_winners(tables);
  const targets = distinct(rows.map((row) => row.target_error_rel)).sort((a, b) => b - a);
  const cell = (row) =>
    row && row.status === 'ok'
      ? `${way(row)}, ${format_elements(row)}, ${format_steps(row, time)}: ` +
        time(row.wall_s_per_sim_s) +
        (tied_with(tables, row) ? ' (tie)' : '')
      : 'none found';
  return table(
    ['scene', ...targets.map((target) => percent(target))],
    distinct(rows.map((row) => row.scene)).map((scene) => [
      spaced(scene),
      ...targets.map((target) =>
        cell(rows.find((row) => row.scene === scene && row.target_error_rel === target)),
      ),
    ]),
  );
}

// "`esdirk43` on 3 of 7 scenes (tied on 1 more)": a tie is no win.
function tally(tables, name_of) {
  const rows = winners(tables);
  return [...group_by(rows, name_of)]
    .map(([name, members]) => ({
      name,
      ties: members.filter((row) => {
        const other = tied_with(tables, row);
        return other !== undefined && name_of(other) !== name;
      }).length,
      all: members.length,
    }))
    .sort((a, b) => b.all - b.ties - (a.all - a.ties))
    .map(
      ({ name, all, ties }) =>
        `\`${name}\` on ${all - ties} of ${rows.length} scenes` +
        (ties > 0 ? ` (and tied on ${ties})` : ''),
    )
    .join(', ');
}
export const winning_integrators = (tables) => tally(tables, (row) => row.integrator);
export const winning_models = (tables) => tally(tables, (row) => row.model);

// How much of the scenes the errors cover.
export const horizon = (tables) => {
  const rows = winners(tables);
  const durations = rows.map((row) => row.duration_s).filter(is_positive);
  const whole = durations.length > 0 ? ` of scenes of ${range(durations, time)}` : ' of each scene';
  return `Errors are compared over the first ${range(rows.map((row) => row.horizon_s), time)}${whole}`;
};

// How near the edge the winners at 1 % are.
export const nominal = (tables) => {
  const known = winners(tables).filter((row) => is_number(row.error_neighbours_rel));
  const over = known.filter((row) => row.error_neighbours_rel > target).length;
  return (
    `These errors are nominal. With elements added, other steps, or length and modulus changed by 2 %, ` +
    `${over} of ${known.length} winners exceed 1 %, by up to ` +
    `${percent(Math.max(...known.map((row) => row.error_neighbours_rel)))}`
  );
};

// What the winners' step control has been asked for.
export const step_rule = (tables) => {
  const rows = winners(tables);
  const adaptive = rows.filter((row) => is_positive(row.tolerance));
  if (adaptive.length === 0) return 'All of these winners take equal steps';
  return (
    `${adaptive.length} of these ${rows.length} winners adapt their steps, at tolerances of ` +
    `${range(adaptive.map((row) => row.tolerance))} of the length. The search varies the tolerance as it varies the ` +
    `number of elements. It is no bound of the error: the column of errors has what it leaves`
  );
};

const words = {
  elements: 'number of elements',
  dt_s: 'time step',
  tolerance: 'step control',
  extrapolated: 'extrapolation',
  cuts: 'cuts of elements',
  refresh: 'refresh of the matrix',
};

// What replacing one choice by the next best costs: the median over scenes and errors, and
// how many replacements it is from.
export function choices(tables) {
  const rows = rows_of(tables, 'cost_of_accuracy', { kind: 'without' }).filter((row) =>
    is_positive(row.cost_factor),
  );
  return [...group_by(rows, (row) => row.choice)]
    .map(([choice, members]) => ({
      choice: words[choice] ?? spaced(choice),
      factor: median(members.map((row) => row.cost_factor)),
      count: members.length,
    }))
    .sort((a, b) => b.factor - a.factor)
    .map(({ choice, factor, count }) => `${choice} ${number(factor)} (${count})`)
    .join(', ');
}

const fewest = 10;

// By how many times an element of a clothoid is more expensive than one of a helix.
export const clothoid_step = (tables) => {
  const rows = rows_of(tables, 'scaling', { structure: 'straight', solver: 'recursive', status: 'ok' });
  const of = (model) => rows.filter((row) => row.model === model && ['', 'bend_twist'].includes(row.modes ?? ''));
  const pairs = of('super_clothoid').flatMap((row) => {
    const helix = of('super_helix').find(
      (other) => other.elements === row.elements && other.tangent === row.tangent,
    );
    return helix && row.elements >= fewest
      ? [{ tangent: row.tangent, ratio: row.cost_per_step_s / helix.cost_per_step_s }]
      : [];
  });
  return [...group_by(pairs, ({ tangent }) => tangent)]
    .map(
      ([tangent, members]) =>
        `${range(members.map(({ ratio }) => ratio))} times that of the same number of helices with ` +
        `\`tangent = "${tangent}"\` (${members.length} numbers of elements from ${fewest} on)`,
    )
    .join(', ');
};

// How many elements of each kind one error needs.
export const clothoid_elements = (tables) => {
  const rows = rows_of(tables, 'cost_of_accuracy', { kind: 'method', scene: 'release' });
  const least = (model) =>
    Math.min(...rows.filter((row) => row.model === model && row.status === 'ok').map((row) => row.elements));
  const [clothoids, helices] = [least('super_clothoid'), least('super_helix')];
  must(clothoids < helices, 'a rod that is let go needs fewer clothoids than helices');
  return (
    `For a rod that is let go, the cheapest runs within 1 % use ${clothoids} clothoids or more, ` +
    `and ${helices} helices or more`
  );
};

// Largest error of a winner's neighbours over its target, of all winners.
export const margins = (tables) => {
  const known = all_winners(tables).filter((row) => is_number(row.margin));
  if (known.length === 0) return 'not known for this table';
  return `${range(known.map((row) => row.margin))} over all ${known.length} winners`;
};

// How far two references of the continuous rod are apart at most.
export const gap = (tables) =>
  number(
    Math.max(
      ...rows_of(tables, 'cost_of_accuracy', { kind: 'winner' }).map((row) => row.reference_gap),
    ),
  );
