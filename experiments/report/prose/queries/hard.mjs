// Which model and integrator survives which hard case.
import { hard_rows, judged, not_compared, rank, survives as survived } from '../../src/hard.mjs';
import { by_pace, by_tolerance, pace } from '../../src/pace.mjs';
import { distinct, group_by, minimum_by } from '../../src/tables.mjs';
import { percent, rows_of, table, time } from '../markdown.mjs';

export const cases = (tables) =>
  String(distinct(rows_of(tables, 'hard_cases').map((row) => row.case)).length);

const all_pairs = (tables) => distinct(judged(tables).map((row) => `${row.case}|${row.model}`));
export const pairs = (tables) => String(all_pairs(tables).length);

const count = (members, ...wanted) =>
  members.filter((row) => wanted.includes(row.outcome)).length;

export function outcomes_table(tables) {
  const groups = group_by(judged(tables), (row) => `${pace(row)}|${row.integrator}`);
  const rows = [...groups.values()]
    .sort(([a], [b]) => by_pace(a, b))
    .map((members) => [
      by_tolerance(members[0]) ? pace(members[0]) : time(members[0].dt_s),
      members[0].integrator,
      members.length - count(members, 'refused'),
      count(members, 'stable and accurate'),
      count(members, 'stable'),
      count(members, not_compared),
      count(members, 'unstable'),
      count(members, 'not finished'),
    ]);
  return table(
    [
      'step or tolerance',
      'integrator',
      'pairs that can run',
      'stable and accurate',
      'stable, inaccurate',
      'stable, no reference',
      'unstable',
      'not finished',
    ],
    rows,
  );
}

// Which steps of the million steps count: those that were run whole.
export const million_steps = (tables) => {
  const rows = hard_rows(tables).filter((row) => row.case === 'million_steps');
  const cut = rows.filter((row) => row.cut > 0);
  if (cut.length === 0) return '`million_steps` was run whole';
  const whole = distinct(rows.filter((row) => row.cut === 0).map((row) => time(row.dt_s)));
  return (
    `\`million_steps\` counts ` +
    `${whole.length > 0 ? `at ${whole.join(' and ')} only, where all of its steps were run` : 'nowhere'}: ` +
    `the other runs stop after ${cut[0].cut} steps`
  );
};

// What super_helix with backward_euler survives at each step, and what it does not.
export function super_helix(tables) {
  const rows = judged(tables).filter(
    (row) =>
      row.model === 'super_helix' &&
      row.integrator === 'backward_euler' &&
      row.outcome !== 'refused',
  );
  return [...group_by(rows, (row) => row.dt_s).values()]
    .sort((a, b) => b[0].dt_s - a[0].dt_s)
    .map((members) => {
      const lost = members.filter((row) => !survived(row)).map((row) => `\`${row.case}\``);
      const not = lost.length > 0 ? ` (not: ${lost.join(', ')})` : '';
      return (
        `${members.length - lost.length} of ${members.length} cases at steps of ` +
        `${time(members[0].dt_s)}${not}`
      );
    })
    .join('; ');
}

// Cases of contact by a regularised law, and the same by the exact one: within the step of
// the strand, and by impulses after it.
const contact_cases = [
  ['grazing_contact', 'grazing_exact', 'grazing_impulse'],
  ['cone', 'cone_exact', 'cone_impulse'],
  ['coil_contact', 'coil_impulse'],
];

// Their outcomes by backward_euler at its longest step, with Newton's iterations.
export function friction_table(tables) {
  const all = judged(tables).filter((row) => row.integrator === 'backward_euler' && !by_tolerance(row));
  const longest = Math.max(...all.map((row) => row.dt_s));
  const of = (name, model) => {
    const row = all.find((one) => one.case === name && one.model === model && one.dt_s === longest);
    if (row === undefined || row.outcome === 'refused') return '';
    return survived(row) ? `${row.outcome} (${row.newton_iterations})` : row.outcome;
  };
  const names = contact_cases.flat();
  const models = distinct(all.filter((row) => names.includes(row.case)).map((row) => row.model));
  const rows = models.map((model) => [model, ...names.map((name) => of(name, model))]);
  const kept = rows.filter((row) => row.slice(1).some((cell) => cell !== ''));
  return table(['model', ...names.map((name) => `\`${name}\``)], kept);
}

// Runs that a regularised law does not survive, each with its outcomes by the exact one.
function fallen(tables) {
  const all = judged(tables);
  return contact_cases.flatMap(([regularised, ...exact]) =>
    all
      .filter((row) => row.case === regularised && ['unstable', 'not finished'].includes(row.outcome))
      .map((row) => ({
        row,
        exact: exact
          .map((name) =>
            all.find(
              (one) =>
                one.case === name &&
                one.model === row.model &&
                one.integrator === row.integrator &&
                pace(one) === pace(row),
            ),
          )
          .filter((one) => one !== undefined),
      })),
  );
}

const rises = ({ exact }) => exact.some(survived);
const tried = ({ exact }) => exact.filter((one) => one.outcome !== 'refused');

// Of those that an exact law can run.
export const rising_count = (tables) => {
  const all = fallen(tables).filter((one) => tried(one).length > 0);
  return `${all.filter(rises).length} of ${all.length}`;
};

// Why the best of the exact laws does not survive, in few words.
function why_not(one) {
  const able = tried(one);
  if (able.length === 0) return `${one.row.integrator} does not support exact contact`;
  const said = minimum_by(able, rank);
  const [, what] = /^(.*?)(?: at t = |: | = |$)/.exec(said.why);
  const words = {
    'its work was done': 'not finished within its work',
    speed: 'faster than its root can make it',
    reach: 'farther from its root than it is long',
    energy: 'gains energy at the impact',
    penetration_over_bound: 'deeper than allowed',
    overlap_over_radius: 'parts pass through each other',
  };
  return `${said.case}: ${words[what] ?? what}`;
}

// What rises, and why the rest does not: models, by case, method and step.
export function rising_table(tables) {
  const groups = group_by(fallen(tables), (one) => {
    const { row } = one;
    return [row.case, row.integrator, pace(row), rises(one) ? '**survives**' : why_not(one)].join('|');
  });
  const rows = [...groups.values()].map((members) => {
    const [one] = members;
    const { row } = one;
    return [
      `\`${row.case}\``,
      row.integrator,
      by_tolerance(row) ? pace(row) : time(row.dt_s),
      rises(one) ? '**survives**' : why_not(one),
      distinct(members.map((member) => member.row.model)).join(', '),
    ];
  });
  return table(['fails by a regularised law', 'integrator', 'step or tolerance', 'by the exact law', 'models'], rows);
}

// Combinations of case, model and integrator that were run at two steps or more, and those
// that break at a shorter one although they hold at a longer one.
function broken_at_shorter_groups(tables) {
  const stepped = judged(tables).filter((row) => !by_tolerance(row) && row.outcome !== 'refused');
  const groups = group_by(stepped, (row) =>
    [row.case, row.model, row.integrator].join('|'),
  );
  const compared = [...groups.values()].filter((members) => members.length > 1);
  const broken = compared.filter((members) => {
    const sorted = [...members].sort((a, b) => a.dt_s - b.dt_s);
    return sorted.some(
      (row, i) => row.outcome === 'unstable' && sorted.slice(i + 1).some(survived),
    );
  });
  return { broken, all: compared.length };
}

export function broken_at_shorter_count(tables) {
  const { broken, all } = broken_at_shorter_groups(tables);
  return `${broken.length} of ${all} (${percent(broken.length / all)})`;
}

export const broken_at_shorter = (tables) =>
  distinct(broken_at_shorter_groups(tables).broken.map(([row]) => `\`${row.case}\``)).join(', ');
