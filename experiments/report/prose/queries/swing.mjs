// Accuracy on the swinging strand, beside other simulators.
import { fastest_at, swing_levels, swing_runs } from '../../src/strand.mjs';
import { is_positive, minimum_by, swing_rows } from '../../src/tables.mjs';
import { rows_of, table, time } from '../markdown.mjs';

const ours = (tables, kind, error) => {
  const best = fastest_at(swing_runs(swing_rows(tables), kind), error);
  if (best === undefined) return 'none';
  return `${time(best.wall_s)}, \`${best.model}\`, \`${best.integrator}\`, ${best.elements} elements`;
};

const peers = (tables, column) => {
  const rows = rows_of(tables, 'peers_swing').filter((row) => is_positive(row[column]));
  const best = minimum_by(rows, (row) => row[column]);
  return `${time(best[column])}, ${best.peer}`;
};

export function best_table(tables) {
  const [one, tenth] = swing_levels;
  return table(
    ['', '1 % in time', '0.1 % in time', '1 % in total'],
    [
      [
        'tress, best',
        ours(tables, 'time', one.error),
        ours(tables, 'time', tenth.error),
        ours(tables, 'total', one.error),
      ],
      [
        `best of ${rows_of(tables, 'peers_swing').length} others`,
        peers(tables, one.peer),
        peers(tables, tenth.peer),
        '',
      ],
    ],
  );
}
