// What ./tress compare says of a build beside itself, and beside a slowed one.
import { number, percent, range, rows_of } from '../markdown.mjs';

const count = (rows, column) => rows.reduce((sum, row) => sum + Number(row[column]), 0);

export const itself = (tables) => {
  const all = rows_of(tables, 'compare_itself');
  const same = all.filter((row) => row.beside === 'itself');
  const slowed = all.filter((row) => row.beside === 'slowed');
  const found = slowed.filter((row) => row.verdict === 'slower').length;
  return (
    `${count(same, 'wrong')} false verdicts of ${count(same, 'rows')} in ${same.length} runs against itself. ` +
    `The slowed kernel was found in ${found} of ${slowed.length} runs, ` +
    `${range(slowed.map((row) => row.ratio - 1), percent)} slower, with ${count(slowed, 'wrong')} wrong verdicts on all rows.`
  );
};
