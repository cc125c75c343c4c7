// What position-based dynamics, block descent and other simulators are worth on hair.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { family_runs, newest } from '../../figures/newest_methods.mjs';
import { hard_rows, not_compared, survives } from '../../src/hard.mjs';
import { distinct, group_by, is_number, minimum_by, succeeded } from '../../src/tables.mjs';
import { must, number, ok_rows, percent, range, rows_of, table, time } from '../markdown.mjs';

const code = (names) => names.map((name) => `\`${name}\``).join(', ');

// Chains of so few links stay off the rod however short their steps: no total error below
// the floor compares methods.
const links = 20;
const floor = 0.02;
const levels = { total: [0.2, 0.05, floor], time: [0.01, 0.001] };

// By family: the cheapest run within each error, and the least error.
function levels_table(tables, kind) {
  const families = [...group_by(family_runs(tables, kind), (run) => run.family)];
  const cheapest = (runs, error) =>
    minimum_by(
      runs.filter((run) => run.error <= error),
      (run) => run.wall_s,
    );
  const rows = families.map(([family, runs]) => {
    const best = minimum_by(runs, (run) => run.error);
    return [
      family,
      ...levels[kind].map((error) => {
        const run = cheapest(runs, error);
        return run === undefined ? 'never' : time(run.wall_s);
      }),
      runs[0].loose ? '' : `${percent(best.error)} in ${time(best.wall_s)} (${best.how})`,
    ];
  });
  return table(
    ['family', ...levels[kind].map((error) => `within ${percent(error)}`), 'least error'],
    rows,
  );
}

export const total_table = (tables) => levels_table(tables, 'total');
export const time_table = (tables) => levels_table(tables, 'time');

// "block_descent.csv on A, work_precision.csv on B", of the tables that are there.
export const machines = (_, root) =>
  ['work_precision', 'block_descent', 'peers']
    .map((name) => [name, join(root, 'results', `${name}.meta.json`)])
    .filter(([, file]) => existsSync(file))
    .map(([name, file]) => {
      const { machine } = JSON.parse(readFileSync(file, 'utf8'));
      return `\`${name}.csv\` on ${machine.cpu}`;
    })
    .join(', ');

const no_peers =
  'The table `results/peers.csv` of other simulators is missing; `./tress peers` makes it.';

// By engine and method: its time for an error against the continuous rod, and its floor, the
// error at its shortest step, which is that of its links.
export function peers_table({ peers }) {
  if (peers === undefined) return no_peers;
  const bounds = [0.05, floor];
  const methods = group_by(
    peers.filter((row) => row.elements === links),
    (row) => `${row.peer} ${row.version}, ${row.method}`,
  );
  const lines = [...methods].map(([method, rows]) => {
    const kept = rows.filter(succeeded);
    const cheapest = (error) =>
      minimum_by(
        kept.filter((row) => row.total_error_rel <= error),
        (row) => row.wall_s,
      );
    const finest = minimum_by(kept, (row) => row.dt_s);
    return [
      method,
      ...bounds.map((error) => {
        const row = cheapest(error);
        return row === undefined ? 'never' : `${time(row.wall_s / 2)} (${time(row.dt_s)})`;
      }),
      finest === undefined ? 'unstable' : `${percent(finest.total_error_rel)} at ${time(finest.dt_s)}`,
    ];
  });
  return table(
    ['engine, method', ...bounds.map((error) => `within ${percent(error)}`), 'error at the shortest step'],
    lines,
  );
}

// Links of other engines are a rod of ours meshed as finely: their error of space.
export function peers_confirm({ peers }) {
  if (peers === undefined) return '';
  const finest = [
    ...group_by(
      peers.filter((row) => row.elements === links && row.precision !== 'single' && succeeded(row)),
      (row) => row.peer + row.method,
    ).values(),
  ].map((rows) => minimum_by(rows, (row) => row.dt_s));
  const errors = finest.map((row) => row.total_error_rel);
  must(Math.max(...errors) < floor, 'the finest runs of all engines are above the least target');
  const mujoco = finest.filter((row) => row.peer === 'mujoco_3').map((row) => row.total_error_rel);
  return (
    `At their shortest steps all ${finest.length} methods in double precision, with ${links} links, are ${range(errors, percent)} off the ` +
    `continuous rod. This is the error of their links, so that a target below ${percent(floor)} compares meshes and not methods` +
    (mujoco.length > 0 ? `; MuJoCo 3 ${range(mujoco, percent)}.` : '.')
  );
}

// Order 2 beside order 1 of position-based steps, where sweeps are few.
export function order_two(tables) {
  const rows = rows_of(tables, 'block_descent', { part: 'order' }).filter(succeeded);
  const pairs = [...group_by(rows, (row) => `${row.dt_s} ${row.sweeps}`).values()].map((both) => [
    both.find((row) => row.integrator === 'xpbd'),
    both.find((row) => row.integrator === 'xpbd_bdf2'),
  ]);
  if (pairs.length === 0) return 'The table does not compare `xpbd_bdf2` with `xpbd` yet';
  must(
    pairs.every(([first, second]) => second.error_rel < first.error_rel),
    'order 2 is the less wrong at every step and number of sweeps',
  );
  return (
    'Position-based dynamics gain more from order 2 than from sweeps. `xpbd` and `xpbd_bdf2`: ' +
    pairs
      .map(
        ([first, second]) =>
          `${percent(first.error_rel)} and ${percent(second.error_rel)} off the rod at steps of ${time(first.dt_s)} and ` +
          `${first.sweeps} sweeps (time ${number(second.wall_s_per_sim_s / first.wall_s_per_sim_s, 2)} times)`,
      )
      .join('; ')
  );
}

// The model that the chain of Zhao et al. would be, beside the one that they compare with.
export function chain_beside_helix(tables) {
  const at_20 = family_runs(tables, 'total').filter((run) => run.how.endsWith(` ${links} elements`));
  const least = (model) =>
    minimum_by(
      at_20.filter((run) => run.how.startsWith(`${model},`)),
      (run) => run.error,
    );
  const [chain, helix] = [least('articulated_chain'), least('super_helix')];
  return (
    `with ${links} elements \`articulated_chain\` comes within ${percent(chain.error)} of the swinging rod, ` +
    `\`super_helix\` within ${percent(helix.error)}`
  );
}

// Sweeps lead to the solution of the step, whose own error stays.
export function step_is_the_limit(tables) {
  const near = ok_rows(tables, 'block_descent', { integrator: 'vbd_augmented' }).filter(
    (row) => row.direct_distance_rel <= 1e-3,
  );
  must(
    near.length > 0 &&
      near.every((row) => Math.abs(row.error_rel / row.direct_error_rel - 1) < 0.05),
    'what sweeps converge to is as far off the rod as the direct step',
  );
  const ends = [...group_by(near, (row) => row.dt_s)]
    .map(([dt_s, rows]) => `${percent(rows[0].direct_error_rel)} at steps of ${time(dt_s)}`)
    .join(', ');
  return (
    'More sweeps converge to the step of backward Euler, not to the exact rod: where `vbd_augmented` has reached that step, ' +
    `both are off by ${ends}`
  );
}

// ---- free flight

const flights = (tables) =>
  rows_of(tables, 'validation', { test: 'free_flight' }).filter((row) => is_number(row.dt_s));

const beside = ['backward_euler', 'bdf2', 'implicit_midpoint'];

// Models on which a newest method has flown, and all of its methods worth comparing.
function compared(tables) {
  const rows = flights(tables);
  const models = distinct(
    rows.filter((row) => newest.includes(row.integrator)).map((row) => row.model),
  );
  return rows.filter(
    (row) => models.includes(row.model) && [...beside, ...newest].includes(row.integrator),
  );
}

const signed = (x) => `${x > 0 ? '+' : ''}${percent(x)}`;

export function flight_table(tables) {
  const rows = compared(tables);
  const steps = distinct(rows.map((row) => row.dt_s)).sort((a, b) => b - a);
  const shown = (row) =>
    row === undefined
      ? ''
      : succeeded(row)
        ? `${signed(row.energy_change_rel)}, ${percent(row.angular_error_rel)}`
        : 'unstable';
  const lines = [...beside, ...newest].flatMap((integrator) =>
    [
      ...group_by(
        rows.filter((row) => row.integrator === integrator),
        (row) => row.model,
      ),
    ].map(([model, members]) => [
      `\`${integrator}\``,
      `\`${model}\``,
      ...steps.map((dt_s) => shown(members.find((row) => row.dt_s === dt_s))),
    ]),
  );
  return table(['integrator', 'model', ...steps.map((dt_s) => `at ${time(dt_s)}`)], lines);
}

const listed_missing = (there, what) => {
  const missing = newest.filter((name) => !there.includes(name));
  return missing.length === 0 ? '' : `The table has no ${what} of ${code(missing)} yet.`;
};

export const flight_missing = (tables) =>
  listed_missing(distinct(flights(tables).map((row) => row.integrator)), 'flight');

// The order of the step, both solved to the end.
export function order_in_flight(tables) {
  const rows = compared(tables).filter(succeeded);
  const longest = Math.max(...rows.map((row) => row.dt_s));
  const losses = (integrator) =>
    rows
      .filter((row) => row.integrator === integrator && row.dt_s === longest)
      .map((row) => Math.abs(row.energy_change_rel));
  const [first, second] = [losses('backward_euler'), losses('bdf2')];
  must(
    first.length > 0 &&
      second.length > 0 &&
      Math.min(...first) > 5 * Math.max(...second),
    '`bdf2` loses far less energy than `backward_euler`',
  );
  return (
    `The order of the step limits what sweeps can reach: fully converged, \`backward_euler\` loses ${range(first, percent)} of the ` +
    `energy at ${time(longest)}, \`bdf2\` ${range(second, percent)}`
  );
}

// ---- stable is not accurate

export function map_counts(tables) {
  const rows = rows_of(tables, 'block_descent', { part: 'rods', scene: 'swing' });
  const stiffest = Math.max(...rows.map((row) => row.stretch_over_bending));
  const hair = rows.filter((row) => row.stretch_over_bending === stiffest);
  const errors = rows.filter(succeeded).map((row) => row.error_rel);
  return (
    `${errors.length} of the ${rows.length} runs of \`stable_cosserat_rods\` on the hair finish, ` +
    `${errors.filter((error) => error <= 0.01).length} of these within 1 % of the rod. The runs with the stretch stiffness of a hair ` +
    `(${hair.length}, of which ${hair.filter(succeeded).length} finish) are off by ${range(hair.filter(succeeded).map((row) => row.error_rel), percent)}`
  );
}

// What is accurate of what is stable and has a reference, over strand models and their
// variants, at the longest step of each integrator.
export function survived_table(tables) {
  const strands = distinct(rows_of(tables, 'validation').map((row) => row.model));
  const rows = hard_rows(tables).filter(
    (row) => survives(row) && row.cut === 0 && is_number(row.dt_s) && strands.includes(row.model),
  );
  const lines = [...group_by(rows, (row) => row.integrator)].map(([integrator, all]) => {
    const longest = Math.max(...all.map((row) => row.dt_s));
    const members = all.filter((row) => row.dt_s === longest);
    const compared = members.filter((row) => row.outcome !== not_compared).length;
    const accurate = members.filter((row) => row.outcome === 'stable and accurate').length;
    return [
      `\`${integrator}\``,
      time(longest),
      members.length,
      compared,
      accurate,
      compared > 0 ? percent(accurate / compared) : '',
    ];
  });
  return table(
    ['integrator', 'longest step', 'stable', 'of these with a reference', 'accurate', 'accurate of those with a reference'],
    lines,
  );
}

export const survived_missing = (tables) =>
  listed_missing(distinct(rows_of(tables, 'hard_cases').map((row) => row.integrator)), 'hard case');

export const energy_cases = (tables) =>
  String(
    distinct(
      rows_of(tables, 'hard_cases')
        .filter((row) => String(row.measure_name).includes('energy'))
        .map((row) => row.case),
    ).length,
  );

// ---- published figures

const source = ({ source: text, address, cited_as: cited }) =>
  `[${text}](${address})${cited ? `; ${cited}` : ''}`;

export const published_table = (tables) =>
  table(
    ['code', 'simulated', 'hardware', 'figure', 'measured', 'not measured', 'source', 'found there'],
    rows_of(tables, 'peers_published').map((row) => [
      row.name,
      row.simulated,
      row.hardware || 'not said',
      [row.figure, row.unit].filter(Boolean).join(' ') || 'none there',
      row.measured,
      row.not_measured,
      source(row),
      row.checked,
    ]),
  );

// No published figure is an error of a motion: it would be a row to compare with.
export function published_errors(tables) {
  const rows = rows_of(tables, 'peers_published').filter((row) => row.figure);
  must(
    rows.every((row) => !/error/.test(row.measured ?? '')),
    'no published figure gives the error of the motion',
  );
  return `None of these ${rows.length} figures gives the error of the motion`;
}
