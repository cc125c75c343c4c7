// Energy that methods take from a hair that swings without friction.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
import { line_panels } from './common.mjs';

const rows_of = ({ damping = [] }) =>
  damping
    .filter(succeeded)
    .map((row) => ({
      ...row,
      dt_ms: 1e3 * row.dt_s,
      lost_pct: 100 * row.energy_lost_rel,
      change_pct: 100 * Math.abs(row.energy_lost_rel),
    }))
    .filter((row) => is_positive(row.change_pct));

export const damping = {
  id: 'damping',
  title: 'Energy that a method takes',
  table: 'damping',
  caption: `What a hair that was let go has less of its energy after a second without friction, against the step: lost or gained, over
    what a fall to rest would free. A panel per model. Made from damping.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    return line_panels(
      [...group_by(rows, (row) => row.model)].map(([model, members]) => [
        spaced(model),
        members,
      ]),
      {
        id: 'damping',
        width,
        series: ['integrator', 'method'],
        x: ['dt_ms', 'step (ms)'],
        y: ['change_pct', 'energy lost or gained (%)'],
        tooltip: [
          ['integrator', 'method'],
          ['elements', 'elements'],
          ['dt_ms', 'step (ms)', '.3g'],
          ['lost_pct', 'lost (%)', '.3g'],
        ],
      },
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Energy lost or gained in percent against the step, both log scale, for
      ${distinct(rows.map((row) => row.integrator)).length} methods and
      ${distinct(rows.map((row) => row.model)).length} models.`;
  },
};
