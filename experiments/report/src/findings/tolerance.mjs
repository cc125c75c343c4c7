// Findings of the adaptive runs in work_precision.csv, as sentences.
import { format_number } from '../format.mjs';
import { code } from '../strand.mjs';
import { group_by, is_positive, is_set, minimum_by, problem_name, succeeded } from '../tables.mjs';

export const bounds = { least: 0.05, most: 1 };
const inside = ({ error_over_tolerance: ratio }) =>
  ratio >= bounds.least && ratio <= bounds.most;

// Runs whose error is known: time errors above the references' own.
export const control_rows = ({ work_precision = [] }) =>
  work_precision.filter(
    (row) =>
      succeeded(row) &&
      is_positive(row.position_tol_rel) &&
      is_positive(row.error_over_tolerance) &&
      !is_set(row.below_reference),
  );

const range = (rows) => {
  const ratios = rows.map((row) => row.error_over_tolerance);
  return `${format_number(Math.min(...ratios))} to ${format_number(Math.max(...ratios))}`;
};

const place = (row) =>
  `${code(row.model)} (${problem_name(row)}, ${format_number(row.position_tol_rel)}: ` +
  `${format_number(row.error_over_tolerance)})`;

function method_sentence([method, rows]) {
  const kept = rows.filter(inside).length;
  const most = minimum_by(rows, (row) => -row.error_over_tolerance);
  const above = rows.filter((row) => row.error_over_tolerance > bounds.most);
  const worst =
    above.length > 0
      ? `. It is above the tolerance in ${above.length} run${above.length === 1 ? '' : 's'}, with the largest value on ${place(most)}`
      : '';
  return (
    `${code(method)}: error over tolerance ${range(rows)}, between ${format_number(bounds.least)} and ` +
    `${format_number(bounds.most)} in ${kept} of ${rows.length} runs${worst}.`
  );
}

export const control_findings = (tables) =>
  [...group_by(control_rows(tables), (row) => row.integrator)].map(method_sentence);
