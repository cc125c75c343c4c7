// What friction and drag a measured oscillation tells.
import { number, rows_of, table } from '../markdown.mjs';

const interval = (row, name, unit) =>
  [name, name.replace('_kg', '_low_kg'), name.replace('_kg', '_high_kg')]
    .map((column) => number(row[column] / unit, 3))
    .join(' | ');

const estimate = (row, name, unit) => {
  const [value, low, high] = interval(row, name, unit).split(' | ');
  return low === '' || Number.isNaN(Number(low)) ? `${value} (given)` : `${value} [${low}, ${high}]`;
};

export const fits_table = (tables) =>
  table(
    ['records', 'fitted', 'by', 'γ / 1e-10', 'ν / 1e-5', 'verdict'],
    rows_of(tables, 'calibrate').map((row) => [
      `${row.data.replaceAll('_', ' ')}, ${row.signal}`,
      row.fit,
      `\`${row.integrator}\``,
      estimate(row, 'internal_friction_kg_m3_s', 1e-10),
      estimate(row, 'drag_kg_m_s', 1e-5),
      row.status === 'ok' ? '' : `flagged: ${row.reason}`,
    ]),
  );
