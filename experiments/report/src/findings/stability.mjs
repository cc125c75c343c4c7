// What the grid of stability_limit.csv says, as sentences computed from its rows.
import { distinct, group_by, study_rows } from '../tables.mjs';
import { format_number, format_ratio, format_time } from '../format.mjs';
import {
  damping_name,
  frame_s,
  has_limit,
  is_capped,
  principal_runs,
  run_name,
  spaced,
} from '../strand.mjs';
import { failure_sentence } from './drift.mjs';

// Two limits count as equal within the resolution of the search.
const equal_within = 0.05;

const limit = (row) => `${is_capped(row) ? 'at least ' : ''}${format_time(row.dt_max_s)}`;
const place = (row) => `${spaced(row.scene)}, ${damping_name(row)}`;

// Cases (scene, damping, elements, modes) in which both named runs have a limit.
export function limit_pairs(rows, first, second) {
  return [
    ...group_by(rows.filter(has_limit), (row) =>
      [row.scene, row.damping, row.elements, row.modes].join('|'),
    ).values(),
  ].flatMap((members) => {
    const [a, b] = [first, second].map((name) =>
      members.find((row) => run_name(row) === name),
    );
    return a && b ? [{ a, b, ratio: a.dt_max_s / b.dt_max_s }] : [];
  });
}

// The exact Jacobian's run with the largest step, linearly implicit or backward Euler.
const exact_names = (rows) =>
  distinct(rows.map(run_name)).filter((name) => /exact Jacobian/.test(name));

// The case at 20 elements in which the exact Jacobian gains most over the stiff one.
export function tangent_gain(rows) {
  const pairs = exact_names(rows).flatMap((name) => limit_pairs(rows, name, 'recursive'));
  const at_20 = pairs.filter(
    ({ a }) => a.elements === 20 && !/^articulated/.test(a.model),
  );
  return at_20.reduce(
    (best, pair) => (best === undefined || pair.ratio > best.ratio ? pair : best),
    undefined,
  );
}

function agreement(rows) {
  const pairs = limit_pairs(rows, 'recursive', 'composite');
  if (pairs.length === 0) return undefined;
  const gaps = pairs.map(({ ratio }) => Math.abs(ratio - 1));
  const equal = gaps.filter((gap) => gap <= equal_within).length;
  return { count: pairs.length, equal, largest: Math.max(...gaps) };
}

const agreement_words = ({ count, equal, largest }) =>
  `recursive and composite have the same largest step in ${equal} of ${count} cases` +
  (largest > equal_within
    ? ` (largest difference ${format_number(100 * largest, 2)} %)`
    : '');

const gain_words = ({ a, b }) =>
  `${place(a)}, ${a.elements} elements: ${limit(b)} with the elastic Jacobian, ` +
  `${limit(a)} with ${run_name(a)}`;

const capital = (text) => text[0].toUpperCase() + text.slice(1);

export function stability_finding(tables) {
  const rows = study_rows(tables, 'stability_limit', 'grid');
  const same = agreement(rows);
  const gain = tangent_gain(rows);
  return [
    ...(same ? [`${capital(agreement_words(same))}.`] : []),
    ...(gain ? [`${capital(gain_words(gain))}.`] : []),
  ].join(' ');
}

function elastic_local_sentence(rows) {
  const pairs = limit_pairs(rows, 'local elastic Jacobian', 'recursive');
  const at_20 = pairs.filter(({ a }) => a.elements === 20);
  if (at_20.length === 0) return [];
  const ratios = at_20.map(({ ratio }) => 1 / ratio);
  const ends = [Math.min(...ratios), Math.max(...ratios)].map((r) => format_ratio(r));
  return [
    `The local elastic Jacobian (our reconstruction) at 20 elements: its largest step is ` +
      `${distinct(ends).join(' to ')} smaller ` +
      `than recursive over ${at_20.length} cases.`,
  ];
}

// Which methods keep the frame at 20 elements, over all scenes and dampings.
function frame_sentence(rows) {
  const at_20 = principal_runs(rows.filter((row) => row.elements === 20));
  const parts = [...group_by(at_20, run_name)].map(([name, members]) => {
    const kept = members.filter(
      (row) => has_limit(row) && row.dt_max_s >= frame_s * (1 - 1e-3),
    );
    return `${name} ${kept.length} of ${members.length}`;
  });
  return parts.length > 0
    ? [
        `Stable at 33 ms with 20 elements, cases of scene and damping: ${parts.join('; ')}.`,
      ]
    : [];
}

function damping_sentences(rows) {
  const plain = rows
    .filter(has_limit)
    .filter((row) => row.elements === 20 && run_name(row) === 'recursive');
  return [...group_by(plain, (row) => row.scene)].flatMap(([scene, members]) =>
    members.length > 1
      ? [
          `${spaced(scene)}, recursive, 20 elements: ` +
            `${members.map((row) => `${limit(row)} with ${damping_name(row)}`).join(', ')}.`,
        ]
      : [],
  );
}

export function stability_findings(tables) {
  const rows = study_rows(tables, 'stability_limit', 'grid');
  const same = agreement(rows);
  return [
    ...(same
      ? [`${capital(agreement_words(same))}: they solve the same equations.`]
      : []),
    ...elastic_local_sentence(rows),
    ...frame_sentence(rows),
    ...damping_sentences(rows),
    ...failure_sentence(rows),
  ];
}

export function stability_answer(tables) {
  const finding = stability_finding(tables);
  return finding === '' ? undefined : finding;
}
