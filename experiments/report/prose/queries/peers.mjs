// Other simulators on the swinging strand: how their table was made, and how far they agree.
import { is_number } from '../../src/tables.mjs';
import { number, range, rows_of } from '../markdown.mjs';
import { manifest_of } from './machine.mjs';

export const minutes = (_, root) => {
  const { start, end } = manifest_of(root, 'peers');
  return String(Math.ceil((Date.parse(end) - Date.parse(start)) / 60_000));
};

export const load = (_, root) => {
  const { machine } = manifest_of(root, 'peers');
  const uncertain = machine.load_before[0] > machine.cpus ? ': its times are uncertain' : '';
  return `the load before it was ${number(machine.load_before[0])} on ${machine.cpus} processors${uncertain}`;
};

// "1.4 mm with universal joints, 0 to 0.024 mm with ball joints"
export const apart = (tables) => {
  const rows = rows_of(tables, 'peers', { precision: 'double' }).filter((row) => is_number(row.apart_mm));
  const of = (kept) => `${range(rows.filter(kept).map((row) => row.apart_mm))} mm`;
  const universal = (row) => /universal/.test(row.method);
  return (
    `${of(universal)} with universal joints, ${of((row) => !universal(row))} with other joints ` +
    `(${rows.length} methods in double precision)`
  );
};

export const published = (tables) => String(rows_of(tables, 'peers_swing').length);
