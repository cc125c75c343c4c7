// What scaling.csv says, as sentences computed from its rows.
import { is_positive, succeeded } from '../tables.mjs';
import { format_number, format_ratio, format_time } from '../format.mjs';
import { method_name, scaling_series, solver_pairs, spaced } from '../strand.mjs';
import { failure_sentence } from './drift.mjs';

const straight_pairs = (rows) =>
  solver_pairs(rows)
    .filter(({ structure, ours }) => structure === 'straight' && ours !== undefined)
    .sort((a, b) => a.elements - b.elements);

export function scaling_finding({ scaling: rows = [] }) {
  const pairs = straight_pairs(rows);
  if (pairs.length === 0) return '';
  const named = (n) => pairs.find(({ elements }) => elements === n);
  const shown = [...new Set([named(30), named(100), pairs.at(-1)])].filter(Boolean);
  const recursive = scaling_series(rows).find(({ name }) => name === 'recursive');
  const slope = is_positive(recursive?.exponent)
    ? `The recursive step costs N^${recursive.exponent.toFixed(2)}. `
    : '';
  return (
    `${slope}One composite step costs ` +
    shown
      .map(
        ({ elements, ours, source }) =>
          `${format_ratio(ours)} the recursive one at ${elements} elements` +
          (source ? ` (the published frames: ${format_ratio(source)})` : ''),
      )
      .join(', ') +
    '.'
  );
}

function slope_sentence(rows) {
  const parts = scaling_series(rows)
    .filter(({ exponent }) => is_positive(exponent))
    .map(({ name, exponent }) => `${name} ${exponent.toFixed(2)}`);
  return parts.length > 0
    ? [
        `Cost of one step on a straight strand, fitted exponent in the number of elements: ${parts.join('; ')}.`,
      ]
    : [];
}

function element_sentence(rows) {
  const row = rows.find(
    (r) =>
      r.structure === 'straight' &&
      r.elements === 20 &&
      method_name(r) === 'recursive' &&
      succeeded(r) &&
      is_positive(r.cost_per_element_step_s),
  );
  return row
    ? [
        `Recursive at 20 elements: ${format_time(row.cost_per_element_step_s)} per element and step.`,
      ]
    : [];
}

function tree_sentences(rows) {
  return solver_pairs(rows)
    .filter(({ structure, recursive }) => structure !== 'straight' && recursive)
    .sort((a, b) => a.elements - b.elements)
    .map(({ structure, elements, recursive, ours }) => {
      const frames = is_positive(recursive.fps)
        ? `, ${format_number(recursive.fps)} frames per second at its largest stable step` +
          (is_positive(recursive.published_fps)
            ? ` (published: ${format_number(recursive.published_fps)} on hardware of 2008)`
            : '')
        : '';
      return (
        `${spaced(structure)}, ${elements} elements: recursive ` +
        `${format_time(recursive.cost_per_step_s)} per step${frames}` +
        `${ours ? `; composite costs ${format_ratio(ours)} that` : ''}.`
      );
    });
}

export function scaling_findings({ scaling: rows = [] }) {
  return [
    ...slope_sentence(rows),
    ...element_sentence(rows),
    ...tree_sentences(rows),
    ...failure_sentence(rows),
  ];
}
