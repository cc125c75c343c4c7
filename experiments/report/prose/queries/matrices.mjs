// The matrices of systems at an instant.
import { is_positive } from '../../src/tables.mjs';
import { number, range, rows_of, table } from '../markdown.mjs';

const of_strands = (tables) =>
  rows_of(tables, 'matrices').filter((row) => row.elements > 0);

const square = (row) => row.rows === row.cols;

const line = (row) => [
  `\`${row.model}\``,
  row.matrix,
  number(row.rows),
  number(row.nonzeros),
  row.derivatives,
  square(row) ? number(row.asymmetry_rel, 2) : '',
  square(row) ? number(row.condition, 2) : '',
];

const columns = [
  'model',
  'matrix',
  'rows',
  'entries',
  'derivatives',
  'asymmetry',
  'condition',
];

export const strands_table = (tables) => table(columns, of_strands(tables).map(line));

export const others_table = (tables) =>
  table(
    columns,
    rows_of(tables, 'matrices')
      .filter((row) => Number(row.elements) === 0)
      .map(line),
  );

export const frequencies_table = (tables) =>
  table(
    ['model', 'lowest frequency (Hz)', 'highest (Hz)'],
    of_strands(tables)
      .filter((row) => row.matrix === 'K' && row.frequency_least_hz)
      .map((row) => [
        `\`${row.model}\``,
        number(row.frequency_least_hz),
        number(row.frequency_largest_hz),
      ]),
  );

// Over the models of the table above.
export const lowest_frequencies = (tables) => {
  const found = of_strands(tables)
    .filter((row) => row.matrix === 'K' && is_positive(row.frequency_least_hz))
    .map((row) => row.frequency_least_hz);
  const factor = Math.max(...found) / Math.min(...found);
  return `${range(found)} Hz over ${found.length} models, a factor of ${number(factor)}`;
};
