// What the rows of work_precision.csv by tolerance say, as sentences.
import { format_number } from '../format.mjs';
import { group_by, is_positive, is_set, minimum_by, problem_name, succeeded } from '../tables.mjs';

const spaced = (name) => name.replaceAll('_', ' ');
export const bounds = { least: 0.05, most: 1 };
const inside = ({ achieved_over_asked: ratio }) =>
  ratio >= bounds.least && ratio <= bounds.most;

// Runs whose error is known: time errors above the references' own.
export const control_rows = ({ work_precision = [] }) =>
  work_precision.filter(
    (row) =>
      succeeded(row) &&
      is_positive(row.tolerance) &&
      is_positive(row.achieved_over_asked) &&
      !is_set(row.below_reference),
  );

const range = (rows) => {
  const ratios = rows.map((row) => row.achieved_over_asked);
  return `${format_number(Math.min(...ratios))} to ${format_number(Math.max(...ratios))}`;
};

const place = (row) =>
  `${spaced(row.model)} (${problem_name(row)}, ${format_number(row.tolerance)}: ` +
  `${format_number(row.achieved_over_asked)})`;

function method_sentence([method, rows]) {
  const kept = rows.filter(inside).length;
  const most = minimum_by(rows, (row) => -row.achieved_over_asked);
  const above = rows.filter((row) => row.achieved_over_asked > bounds.most);
  const worst = above.length > 0 ? `; above the tolerance in ${above.length}, most on ${place(most)}` : '';
  return (
    `${method}: error over tolerance ${range(rows)}, between ${format_number(bounds.least)} and ` +
    `${format_number(bounds.most)} in ${kept} of ${rows.length} runs${worst}.`
  );
}

export const control_findings = (tables) =>
  [...group_by(control_rows(tables), (row) => row.integrator)].map(method_sentence);

export const control_finding = (tables) => control_findings(tables).join(' ');
