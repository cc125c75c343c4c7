// Energy that methods remove from a hair that swings without friction.
import { distinct, group_by, is_positive, minimum_by, succeeded } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
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
      sign: row.energy_lost_rel > 0 ? 'lost' : 'gained',
    }))
    .filter((row) => is_positive(row.change_pct));

export const damping = {
  id: 'damping',
  title: 'Energy that a method loses or gains',
  table: 'damping',
  headline(tables) {
    const rows = rows_of(tables);
    const step = Math.max(...rows.map((row) => row.dt_s));
    const at = [...group_by(rows.filter((row) => row.dt_s === step), (row) => row.model)][0]?.[1] ?? [];
    const most = minimum_by(at, (row) => -row.lost_pct);
    const least = minimum_by(at, (row) => row.change_pct);
    const text = (row) =>
      `${row.integrator} ${row.sign === 'lost' ? 'loses' : 'gains'} ${format_number(row.change_pct, 2)} %`;
    return `With steps of ${format_time(step)}, ${distinct([most, least]).map(text).join(', ')} of the energy in a second`;
  },
  reading: `A hair without friction swings for a second: energy that it loses or gains, over the energy that a fall to rest
    would release. Lower is better.`,
  caption: `A panel for each model and sign. Made from damping.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    return line_panels(
      [...group_by(rows, (row) => `${spaced(row.model)}: energy ${row.sign}`)],
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
          ['lost_pct', 'lost, below zero gained (%)', '.3g'],
        ],
      },
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    const gained = rows.filter((row) => row.sign === 'gained').length;
    return `Energy lost (${rows.length - gained} runs) or gained (${gained} runs) in percent against the step,
      both log scale, for ${distinct(rows.map((row) => row.integrator)).length} methods and
      ${distinct(rows.map((row) => row.model)).length} models.`;
  },
};
