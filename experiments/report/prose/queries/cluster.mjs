// What sweeps of every row take.
import { number, rows_of, table } from '../markdown.mjs';

const rows = (tables) => rows_of(tables, 'full_sweeps');

export const full_table = (tables) =>
  table(
    ['experiment', 'rows', 'of which timed', 'a row, s', 'core hours', 'memory, MB'],
    rows(tables).map((row) => [
      `\`${row.experiment}\``,
      row.rows,
      row.timed_rows,
      number(row.row_s),
      `${row.cut_off_rows > 0 ? 'more than ' : ''}${number(row.core_hours)}`,
      row.memory_mb,
    ]),
  );

export const full_hours = (tables) =>
  number(rows(tables).reduce((sum, row) => sum + row.core_hours, 0));
