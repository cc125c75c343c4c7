// Cost of a step against elements, and the published table.
import { solver_pairs, spaced } from '../../src/strand.mjs';
import { group_by, is_positive, succeeded } from '../../src/tables.mjs';
import { number, range, rows_of, table } from '../markdown.mjs';

const micro = (row) =>
  row && succeeded(row) && is_positive(row.cost_per_step_s) ? number(1e6 * row.cost_per_step_s) : '';

export function source_table(tables) {
  const pairs = solver_pairs(rows_of(tables, 'scaling')).filter(
    ({ structure, composite, recursive }) =>
      structure !== 'straight' ||
      is_positive(composite?.seed_fps) ||
      is_positive(recursive?.seed_fps),
  );
  return table(
    [
      'structure',
      'elements',
      'recursive, µs a step',
      'composite, µs a step',
      'composite / recursive',
      'the published ratio',
      'recursive, frames/s',
      'published, recursive',
      'published, composite',
    ],
    pairs.map(({ structure, elements, composite, recursive, ours, source }) => [
      spaced(structure),
      elements,
      micro(recursive),
      micro(composite),
      number(ours),
      number(source),
      number(recursive?.fps),
      number(recursive?.seed_fps),
      number(composite?.seed_fps),
    ]),
  );
}

// Cost of an element and step (µs) from 20 elements on, by model, solver and tangent.
export function element_table(tables) {
  const rows = rows_of(tables, 'scaling', { structure: 'straight', status: 'ok' }).filter(
    (row) => row.elements >= 20 && is_positive(row.cost_per_element_step_s),
  );
  const groups = group_by(rows, (row) =>
    [row.model, row.solver, row.tangent, row.modes].join('|'),
  );
  return table(
    ['model', 'solver', 'tangent', 'modes', 'elements', 'µs an element and step'],
    [...groups.values()].map((members) => [
      `\`${members[0].model}\``,
      members[0].solver,
      members[0].tangent,
      members[0].modes,
      range(members.map((row) => row.elements)),
      range(members.map((row) => 1e6 * row.cost_per_element_step_s)),
    ]),
  );
}
