// Which model and integrator survives which hard case.
import { outcomes } from '../../figures/hard_cases.mjs';
import { by_pace, by_tolerance, pace } from '../../src/pace.mjs';
import { distinct, group_by, minimum_by } from '../../src/tables.mjs';
import { rows_of, table, time } from '../markdown.mjs';

const rank = (row) => outcomes.findIndex(([name]) => name === row.outcome);

// One row for each case, model, integrator and step or tolerance: the best variant counts.
const best_variants = (rows) =>
  [
    ...group_by(rows, (row) =>
      [row.case, row.model, row.integrator, pace(row)].join('|'),
    ).values(),
  ].map((members) => minimum_by(members, rank));

const judged = (tables) =>
  best_variants(rows_of(tables, 'hard_cases').filter((row) => rank(row) >= 0));

export const cases = (tables) =>
  String(distinct(rows_of(tables, 'hard_cases').map((row) => row.case)).length);

export const pairs = (tables) =>
  String(distinct(judged(tables).map((row) => `${row.case}|${row.model}`)).length);

export function outcomes_table(tables) {
  const groups = group_by(judged(tables), (row) => `${pace(row)}|${row.integrator}`);
  const count = (members, ...wanted) =>
    members.filter((row) => wanted.includes(row.outcome)).length;
  const rows = [...groups.values()]
    .sort(([a], [b]) => by_pace(a, b))
    .map((members) => [
      by_tolerance(members[0]) ? pace(members[0]) : time(members[0].dt_s),
      members[0].integrator,
      count(members, 'stable', 'stable and accurate'),
      count(members, 'stable and accurate'),
      count(members, 'unstable'),
      count(members, 'not finished'),
      count(members, 'refused'),
    ]);
  return table(
    ['step or tolerance', 'integrator', 'stable', 'of these accurate', 'unstable', 'not finished', 'refused'],
    rows,
  );
}

const survived = (row) => row.outcome.startsWith('stable');

// What super_helix by backward_euler survives at each step, and what it does not.
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

export const rising_count = (tables) => {
  const all = fallen(tables);
  return `${all.filter(rises).length} of ${all.length}`;
};

// Why the best of the exact laws does not survive, in few words.
function why_not({ row, exact }) {
  const tried = exact.filter((one) => one.outcome !== 'refused');
  if (tried.length === 0) return `${row.integrator} takes no exact contact`;
  const said = minimum_by(tried, rank);
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

// Combinations of case, model and integrator that break at a shorter step although they
// hold at a longer one, and how many there are.
function broken_at_shorter_groups(tables) {
  const stepped = judged(tables).filter((row) => !by_tolerance(row));
  const groups = group_by(stepped, (row) =>
    [row.case, row.model, row.integrator].join('|'),
  );
  const broken = [...groups.values()].filter((members) => {
    const sorted = [...members].sort((a, b) => a.dt_s - b.dt_s);
    return sorted.some(
      (row, i) => row.outcome === 'unstable' && sorted.slice(i + 1).some(survived),
    );
  });
  return { broken, all: groups.size };
}

export function broken_at_shorter_count(tables) {
  const { broken, all } = broken_at_shorter_groups(tables);
  return `${broken.length} of ${all}`;
}

export const broken_at_shorter = (tables) =>
  distinct(broken_at_shorter_groups(tables).broken.map(([row]) => `\`${row.case}\``)).join(', ');
