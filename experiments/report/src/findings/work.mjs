// What work_precision.csv says, as sentences computed from their rows.
import {
  distinct,
  group_by,
  is_number,
  is_positive,
  is_set,
  minimum_by,
  order_rows,
  problem_name,
  problem_rows,
  succeeded,
} from '../tables.mjs';
import { format_number, format_ratio, format_time } from '../format.mjs';
import { code, spaced } from '../strand.mjs';
import { failure_sentence } from './drift.mjs';

export const levels = [1e-2, 1e-4, 1e-6];
const answered = 1e-4;

const usable = (rows) =>
  rows.filter(
    (row) =>
      succeeded(row) &&
      is_positive(row.error_rel) &&
      is_positive(row.wall_s_per_sim_s) &&
      !is_set(row.below_reference),
  );

const cheapest = (rows, level) =>
  minimum_by(
    rows.filter((row) => row.error_rel <= level),
    (row) => row.wall_s_per_sim_s,
  );

function cheapest_sentences(rows) {
  return [...group_by(usable(rows), problem_name)].map(([problem, members]) => {
    const parts = levels.flatMap((level) => {
      const best = cheapest(members, level);
      return best
        ? [
            `error ${format_number(level)} with ${code(best.integrator)} ` +
              `(${format_time(best.wall_s_per_sim_s)})`,
          ]
        : [];
    });
    const tried = distinct(members.map((row) => row.integrator)).length;
    const field = tried === 1 ? 'the only integrator run' : `of ${tried} integrators`;
    return parts.length > 0
      ? `${problem}, cheapest per simulated second (${field}): ${parts.join(', ')}.`
      : `${problem}: no run of ${tried} integrators reaches an error of ${levels[0]}.`;
  });
}

// Rows of problem, integrators with a finished run above the reference's error, and the cheapest of these at each level of error.
export const cheapest_table = (tables) =>
  [...group_by(usable(problem_rows(tables)), problem_name)].map(([problem, members]) => [
    problem,
    distinct(members.map((row) => row.integrator)).length,
    ...levels.map((level) => {
      const best = cheapest(members, level);
      return best ? `${code(best.integrator)}, ${format_time(best.wall_s_per_sim_s)}` : 'none';
    }),
  ]);

// Who was put to each problem: rows of problem, kind of error, integrators, runs.
export function field_table(tables) {
  const rows = problem_rows(tables).filter((row) => row.error_kind);
  return [...group_by(rows, (row) => `${row.scene}|${row.error_kind}`).values()].map((members) => {
    const names = distinct(members.map((row) => row.integrator));
    return [
      spaced(members[0].scene),
      members[0].error_kind,
      names.length > 3 ? names.length : `${names.length}: ${names.map(code).join(', ')}`,
      members.length,
    ];
  });
}

// By integrator: {integrator, orders}, those fitted on each problem, ascending.
const fitted_orders = (rows) =>
  [
    ...group_by(
      rows.filter((row) => succeeded(row) && is_number(row.order_fit)),
      (row) => row.integrator,
    ),
  ].map(([integrator, members]) => ({
    integrator,
    orders: [...group_by(members, problem_name)]
      .map(([problem, [row]]) => ({ problem, order: row.order_fit }))
      .sort((a, b) => a.order - b.order),
  }));
const middle = (orders) => {
  const [low, high] = [Math.floor, Math.ceil].map((round) => orders[round((orders.length - 1) / 2)].order);
  return ((low + high) / 2).toFixed(2);
};

// Rows of integrator, problems, median, lowest and highest order with the problem of each.
export const order_table = (tables) =>
  fitted_orders(problem_rows(tables)).map(({ integrator, orders }) => [
    integrator,
    orders.length,
    middle(orders),
    ...[orders[0], orders.at(-1)].map(({ order, problem }) => `${order.toFixed(2)} (${problem})`),
  ]);

const order_sentences = (rows) =>
  fitted_orders(rows).map(
    ({ integrator, orders }) =>
      `${code(integrator)}: fitted order ${middle(orders)}, the median of ${orders.length} ` +
      `problem${orders.length === 1 ? '' : 's'}.`,
  );

function digits_sentences(rows) {
  const scored = rows.filter((row) => succeeded(row) && is_positive(row.scd));
  const parts = [...group_by(scored, (row) => row.scene)].map(([scene, members]) => {
    const best = minimum_by(members, (row) => -row.scd);
    return `${code(scene)} ${best.scd.toFixed(1)} (${code(best.integrator)})`;
  });
  return parts.length > 0 ? [`Most correct digits: ${parts.join(', ')}.`] : [];
}

function reference_sentence(rows) {
  const below = rows.filter((row) => succeeded(row) && is_set(row.below_reference));
  return below.length === 0
    ? []
    : [
        `${below.length} of ${rows.filter(succeeded).length} runs agree with the reference better than ` +
          'the references agree with each other. They are drawn hollow and left out of these findings.',
      ];
}

export function work_findings(tables) {
  const rows = problem_rows(tables);
  return [
    ...cheapest_sentences(rows),
    ...digits_sentences(rows),
    ...reference_sentence(rows),
    ...failure_sentence(rows),
    ...order_sentences(rows),
  ];
}

export function work_answer(tables) {
  const problems = [...group_by(usable(problem_rows(tables)), problem_name)];
  const winners = problems.flatMap(([problem, members]) => {
    const best = cheapest(members, answered);
    return best
      ? [`${code(best.integrator)} on ${problem} ` + `(${format_time(best.wall_s_per_sim_s)})`]
      : [];
  });
  if (winners.length === 0) return undefined;
  const same = distinct(winners.map((w) => w.split(' ')[0])).length === 1;
  return (
    `For a relative error of ${format_number(answered)} the cheapest integrator per simulated second is ` +
    `${winners.join(', ')}${problems.length > 1 && !same ? ': no single method wins everywhere' : ''}.`
  );
}

const compared_orders = [3, 4, 5];

// Rows of tolerance, steps at order 2, and steps at each higher order with the ratio.
export function bdf_table(tables) {
  const all = compared_orders.map((order) => bdf_comparison(order_rows(tables), 2, order));
  return distinct(all.flat().map(({ rtol }) => rtol)).map((rtol) => {
    const pairs = all.map((of) => of.find((pair) => pair.rtol === rtol));
    return [
      format_number(rtol),
      pairs.find(Boolean).low,
      ...pairs.map((pair) => (pair ? `${pair.high} (${format_ratio(pair.high / pair.low)})` : '')),
    ];
  });
}

// Steps of one maximum BDF order against another, at every tolerance both finished.
export function bdf_comparison(rows, low, high) {
  const of = (order) =>
    rows.filter(
      (row) =>
        succeeded(row) &&
        row.integrator === 'cvode_bdf' &&
        row.max_order === order &&
        is_positive(row.steps) &&
        is_positive(row.rtol),
    );
  const pairs = of(low).flatMap((a) =>
    of(high)
      .filter((b) => b.rtol === a.rtol && b.scene === a.scene)
      .map((b) => ({ rtol: a.rtol, low: a.steps, high: b.steps })),
  );
  return pairs.sort((a, b) => b.rtol - a.rtol);
}

export function bdf_findings(tables) {
  const rows = order_rows(tables);
  const comparisons = compared_orders.flatMap((order) => {
    const pairs = bdf_comparison(rows, 2, order);
    if (pairs.length === 0) return [];
    const parts = pairs.map(
      ({ rtol, low, high }) =>
        `${high} against ${low} at rtol ${format_number(rtol)} (${format_ratio(high / low)})`,
    );
    return [`Steps at maximum order ${order} against order 2: ${parts.join(', ')}.`];
  });
  const done = rows.filter((row) => succeeded(row) && is_positive(row.error_rel));
  const best = levels.flatMap((level) => {
    const row = minimum_by(
      done.filter((r) => r.error_rel <= level),
      (r) => r.wall_s,
    );
    return row
      ? [
          `Cheapest at or below error ${format_number(level)}: ${row.label}, ` +
            `${row.steps} steps, ${format_time(row.wall_s)}.`,
        ]
      : [];
  });
  return [...comparisons, ...best, ...failure_sentence(rows)];
}
