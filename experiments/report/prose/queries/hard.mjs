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

// Cases with bodies under both laws of friction, by backward_euler at its longest step:
// outcome and Newton's iterations of each model.
export function friction_table(tables) {
  const laws = [['grazing_contact', 'grazing_exact'], ['cone', 'cone_exact']];
  const all = judged(tables).filter((row) => row.integrator === 'backward_euler' && !by_tolerance(row));
  const longest = Math.max(...all.map((row) => row.dt_s));
  const of = (name, model) => {
    const row = all.find((one) => one.case === name && one.model === model && one.dt_s === longest);
    if (row === undefined || row.outcome === 'refused') return '';
    return survived(row) ? `${row.outcome} (${row.newton_iterations})` : row.outcome;
  };
  const models = distinct(all.filter((row) => row.case === 'grazing_exact').map((row) => row.model));
  const rows = models.map((model) => [model, ...laws.flat().map((name) => of(name, model))]);
  const kept = rows.filter((row) => row.slice(1).some((cell) => cell !== ''));
  return table(['model', ...laws.flat().map((name) => `\`${name}\``)], kept);
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
