// What a head of hair costs.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { parse_csv } from '../../src/csv.mjs';
import { group_by, succeeded } from '../../src/tables.mjs';
import { number, percent, range, rows_of, table } from '../markdown.mjs';
import { manifest_of } from './machine.mjs';

const all = (tables) => rows_of(tables, 'heads').filter(succeeded);
/// Heads of super-helices by one solve a step.
const all_heads = (tables) =>
  all(tables).filter(
    (row) => row.model === 'super_helix' && row.integrator === 'semi_implicit_euler',
  );
const heads = (tables) => all_heads(tables).filter((row) => (row.effects ?? 'drag') === 'drag');
const largest = (tables) => {
  const rows = heads(tables);
  const most = Math.max(...rows.map((row) => Number(row.strands)));
  return rows.filter((row) => Number(row.strands) === most);
};
/// With Euler's methods, in steps that have one solution.
const damps = (row) => row.integrator.endsWith('_euler') && Number(row.dt_s) <= 1 / 120;
const least = (rows, column) =>
  rows.reduce((best, row) => (Number(row[column]) < Number(best[column]) ? row : best));

export const cost_table = (tables) =>
  table(
    [
      'hairs',
      'precision, bits',
      'SIMD lanes',
      'threads',
      'memory per hair, bytes',
      'a step, ms',
      'per element, ns',
      'a frame of 1/60 s with its points, ms',
      'difference from double precision',
      'checksum of the states',
    ],
    heads(tables).map((row) => [
      row.strands,
      row.bits,
      row.lanes,
      row.threads,
      number(row.bytes_per_strand),
      number(1e3 * row.cost_per_step_s),
      number(1e9 * row.cost_per_element_step_s),
      number(1e3 * row.cost_per_frame_s),
      Number(row.difference_rel) === 0 ? '0' : number(row.difference_rel),
      row.state.slice(0, 8),
    ]),
  );

/// Cost by effect and number of hairs: one thread, eight lanes in double precision.
export const effect_table = (tables) => {
  const rows = all_heads(tables).filter(
    (row) => Number(row.bits) === 64 && Number(row.lanes) === 8 && Number(row.threads) === 1,
  );
  const of = (strands, effects) =>
    rows.find((row) => row.strands === strands && (row.effects ?? 'drag') === effects);
  const cost = (row) => (row ? number(1e9 * row.cost_per_element_step_s) : '');
  const kinds = ['none', 'drag', 'body', 'interaction'];
  return table(
    ['hairs', 'gravity: ns per element', 'and drag', 'drag and a head', 'drag and interaction'],
    [...new Set(rows.map((row) => row.strands))].map((strands) => [
      strands,
      ...kinds.map((kind) => cost(of(strands, kind))),
    ]),
  );
};

const processors = (root) => manifest_of(root, 'heads').machine.cpus;

/// The fastest run of the largest groom in each precision, by no more threads than processors.
export const fastest = (tables, root) => {
  const cpus = processors(root);
  const words = ['64', '32'].map((bits) => {
    const row = least(
      largest(tables).filter((each) => String(each.bits) === bits && each.threads <= cpus),
      'cost_per_step_s',
    );
    return (
      `${number(1e3 * row.cost_per_step_s)} ms in ${bits === '64' ? 'double' : 'single'} precision ` +
      `(${row.lanes} SIMD lanes, ${row.threads} threads)`
    );
  });
  return `${words.join(', ')} on ${cpus} processors`;
};

/// Which runs had more threads than processors, and where these cannot have been timed well.
export const oversubscribed = (tables, root) => {
  const cpus = processors(root);
  const rows = heads(tables);
  const over = rows.filter((row) => row.threads > cpus);
  if (over.length === 0) return 'No row has more threads than processors';
  const odd = over.flatMap((row) => {
    const full = rows.find((other) =>
      other.threads === cpus && ['strands', 'bits', 'lanes'].every((key) => other[key] === row[key]),
    );
    return full && full.cost_per_step_s > 1.1 * row.cost_per_step_s ? [{ row, full }] : [];
  });
  const words = odd.map(
    ({ row, full }) =>
      `${row.strands} hairs in ${row.bits}-bit precision take ${number(1e3 * full.cost_per_step_s)} ms with ${full.threads} threads and ` +
      `${number(1e3 * row.cost_per_step_s)} ms with ${row.threads}`,
  );
  return (
    `${over.length} of ${rows.length} rows have more threads than the machine's ${cpus} processors, to show that the states ` +
    `stay the same. More threads cannot be faster there` +
    (odd.length > 0 ? `; where the table has them so, the times are unreliable (${words.join('; ')})` : '')
  );
};

export const largest_head = (tables) => largest(tables)[0].strands;
export const elements = (tables) => largest(tables)[0].elements;
export const build = (tables) =>
  number(Math.max(...largest(tables).map((row) => Number(row.build_s))));
export const narrow = (tables) =>
  number(
    Math.max(
      ...all(tables)
        .filter((row) => damps(row) && Number(row.bits) === 32)
        .map((row) => Number(row.difference_rel || 0)),
    ),
  );
/// Time of one thread over that of two, for every number of hairs.
export const two_threads = (tables) => {
  const rows = heads(tables).filter((row) => row.lanes === 8);
  const words = [...new Set(rows.map((row) => row.strands))].map((strands) => {
    const ratios = [64, 32].map((bits) => {
      const of = (threads) =>
        rows.find((row) => row.strands === strands && row.bits === bits && row.threads === threads);
      return number(of(1).cost_per_step_s / of(2).cost_per_step_s);
    });
    return `${ratios.join(' and ')} for ${strands} hairs`;
  });
  return `${words.join(', ')} (double and single precision)`;
};

/// In single precision otherwise: the largest difference.
export const narrow_otherwise = (tables) =>
  number(
    Math.max(
      ...all(tables)
        .filter((row) => !damps(row) && Number(row.bits) === 32)
        .map((row) => Number(row.difference_rel || 0)),
    ),
  );

/// Where something that is added makes a step cheaper, the times scatter by that much.
export const effect_noise = (tables) => {
  const rows = all_heads(tables).filter(
    (row) => row.bits === 64 && row.lanes === 8 && row.threads === 1,
  );
  const gains = rows
    .filter((row) => row.effects === 'none')
    .map((bare) => {
      const drag = rows.find((row) => row.strands === bare.strands && row.effects === 'drag');
      return drag ? 1 - drag.cost_per_step_s / bare.cost_per_step_s : 0;
    });
  const most = Math.max(...gains);
  return most > 0
    ? `Drag cannot make a step cheaper, yet the table has it ${percent(most)} cheaper: differences of that size are noise of the timing`
    : 'No added effect makes a step cheaper';
};

/// Time of a chain's step over that of a super-helix with as many elements, by method.
export const chain_over_helix = (tables) => {
  const rows = all(tables).filter(
    (row) => row.bits === 64 && row.lanes === 8 && row.threads === 1 && (row.effects ?? 'drag') === 'drag',
  );
  const helices = rows.filter((row) => row.model === 'super_helix');
  const pairs = rows
    .filter((row) => row.model === 'articulated_chain')
    .flatMap((chain) => {
      const helix = helices.find((row) =>
        ['integrator', 'dt_s', 'strands', 'elements'].every((key) => row[key] === chain[key]),
      );
      return helix ? [{ ...chain, ratio: chain.cost_per_step_s / helix.cost_per_step_s }] : [];
    });
  return [...group_by(pairs, (row) => row.integrator)]
    .map(([integrator, members]) => `${range(members.map((row) => row.ratio))} with \`${integrator}\``)
    .join(', ');
};

/// Other models and methods; one thread.
export const other_heads_table = (tables) =>
  table(
    [
      'model',
      'method',
      'step, ms',
      'hairs',
      'precision, bits',
      'SIMD lanes',
      'memory per hair, bytes',
      'a step, ms',
      'per element, ns',
      'iterations a step',
      'lanes over hairs iterated',
      'damped steps, %',
      'lanes they take, %',
      'failed hairs',
      'difference from double precision',
      'checksum of the states',
    ],
    all(tables)
      .filter(
        (row) =>
          (row.model !== 'super_helix' || row.integrator !== 'semi_implicit_euler') &&
          Number(row.threads) === 1 &&
          Number(row.lanes) > 1,
      )
      .map((row) => {
        const newton = row.integrator !== 'semi_implicit_euler';
        return [
          row.model,
          row.integrator,
          number(1e3 * row.dt_s),
          row.strands,
          row.bits,
          row.lanes,
          number(row.bytes_per_strand),
          number(1e3 * row.cost_per_step_s),
          number(1e9 * row.cost_per_element_step_s),
          newton ? number(row.iterations_per_step) : '1',
          newton ? number(row.lanes_per_iteration) : '1',
          newton ? number(100 * row.retried_share) : '0',
          newton ? number(100 * row.lanes_of_retries) : '0',
          row.lost,
          Number(row.difference_rel) === 0 ? '0' : number(row.difference_rel),
          row.state.slice(0, 8),
        ];
      }),
  );

/// What others have published, and ours by the fastest run of each size and effect. A
/// frame of ours is 1/60 s.
export const published_table = (tables, root) => {
  const path = 'experiments/heads/published.csv';
  const published = parse_csv(readFileSync(join(root, path), 'utf8'), path, {
    required: ['source', 'computed', 'machine', 'strands', 'cost_per_frame_s'],
    numeric: ['strands', 'cost_per_frame_s'],
  }).rows;
  const effects = {
    drag: 'gravity and drag',
    body: 'gravity, drag, contact with a head',
    interaction: 'gravity, drag, repulsion and drag between hairs',
  };
  const rows = all_heads(tables).filter((row) => Number(row.bits) === 64);
  const ours = [...new Set(rows.map((row) => row.strands))].flatMap((strands) =>
    Object.entries(effects).flatMap(([kind, computed]) => {
      const of_kind = rows.filter((row) => row.strands === strands && row.effects === kind);
      if (of_kind.length === 0) return [];
      const row = least(of_kind, 'cost_per_frame_s');
      return [
        [
          'here',
          `super-helices of ${row.elements} elements, steps of ${number(1e3 * row.dt_s)} ms; ${computed}`,
          `${row.threads} threads`,
          strands,
          row.cost_per_frame_s,
        ],
      ];
    }),
  );
  return table(
    ['source', 'what is computed', 'on', 'hairs', 'a frame, s', 'of a hair, µs'],
    [...published, ...ours].map(([source, computed, machine, strands, cost]) => [
      source,
      computed,
      machine,
      strands,
      number(cost),
      number((1e6 * cost) / strands),
    ]),
  );
};
