// What friction, drag and stiffness a measured oscillation determines.
import { is_number } from '../../src/tables.mjs';
import { must, number, rows_of, table } from '../markdown.mjs';

const units = { gamma: 1e-10, nu: 1e-5, modulus: 1e9 };

// A value that was given has no interval.
const estimate = (row, name, unit) => {
  const [value, low, high] = ['', '_low', '_high'].map((end) => name.replace(/_(kg|pa)/, `${end}_$1`)).map(
    (column) => (is_number(row[column]) ? number(row[column] / unit, 3) : ''),
  );
  return low === '' ? `${value} (given)` : `${value} [${low}, ${high}]`;
};

export const fits_table = (tables) =>
  table(
    ['records', 'fitted', 'by', `γ / ${number(units.gamma)}`, `ν / ${number(units.nu)}`, 'E / GPa', 'verdict'],
    rows_of(tables, 'calibrate').map((row) => [
      `${row.data.replaceAll('_', ' ')}, ${row.signal}`,
      row.fit,
      `\`${row.integrator}\``,
      estimate(row, 'internal_friction_kg_m3_s', units.gamma),
      estimate(row, 'drag_kg_m_s', units.nu),
      estimate(row, 'youngs_modulus_pa', units.modulus),
      row.status === 'ok' ? '' : `flagged: ${row.reason}`,
    ]),
  );

// "γ = 1e-10 kg m³/s, ν = 2e-5 kg/(m s) and E = 3 GPa", which all records share.
export const truth = (tables) => {
  const rows = rows_of(tables, 'calibrate');
  const of = (column) => {
    const found = [...new Set(rows.map((row) => row[column]).filter(is_number))];
    must(found.length === 1, `all records have the same ${column}`);
    return found[0];
  };
  return (
    `γ = ${number(of('internal_friction_true_kg_m3_s'))} kg m³/s, ν = ${number(of('drag_true_kg_m_s'))} kg/(m s) and ` +
    `E = ${number(of('youngs_modulus_true_pa') / units.modulus)} GPa`
  );
};
