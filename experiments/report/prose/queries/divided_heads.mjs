// What a groom costs when processes divide it.
import { distinct, is_number, is_positive, succeeded } from '../../src/tables.mjs';
import { number, percent, range, rows_of, table } from '../markdown.mjs';

const all = (tables) => rows_of(tables, 'divided_heads').filter(succeeded);
const measured = (tables) => all(tables).filter((row) => row.kind === 'measured');
const predicted = (tables) => all(tables).filter((row) => row.kind === 'predicted');
const milli = (seconds) => (is_positive(seconds) ? number(1e3 * seconds) : '');
const micro = (seconds) => (is_positive(seconds) ? number(1e6 * seconds) : '');

const share = (value) => (is_number(value) ? percent(value) : '');

export const measured_table = (tables) =>
  table(
    [
      'hairs',
      'effects with gravity',
      'processes',
      'grooms at once',
      'a step, ms',
      'model, ms',
      'model off by',
      'off by, fitted without that number of hairs',
      'ghosts per hair',
      'model',
      'to find them, per element, µs',
      'to exchange them',
      'to list contacts',
      'memory of a process, MB',
      'checksum of the states',
    ],
    measured(tables).map((row) => [
      row.strands,
      row.effects,
      row.ranks,
      row.beside,
      milli(row.cost_per_step_s),
      milli(row.model_cost_per_step_s),
      share(row.model_off_rel),
      share(row.held_out_off_rel),
      number(row.ghosts_per_strand),
      is_positive(row.model_ghosts_per_strand) ? number(row.model_ghosts_per_strand) : '',
      micro(row.claim_per_element_s),
      micro(row.exchange_per_element_s),
      micro(row.meet_per_element_s),
      number(row.memory_mb),
      String(row.state).slice(0, 8),
    ]),
  );

// The same number of hairs on each of more processes.
export function weak_table(tables) {
  const rows = measured(tables).filter(({ beside }) => beside === 1);
  const own = Math.min(...rows.map(({ strands }) => strands));
  const one = (effects) =>
    rows.find((row) => row.effects === effects && row.strands === own && row.ranks === 1);
  return table(
    ['effects with gravity', 'processes', 'hairs', 'a step, ms', 'over that of one process', 'model'],
    rows
      .filter((row) => row.strands === own * row.ranks)
      .map((row) => [
        row.effects,
        row.ranks,
        row.strands,
        milli(row.cost_per_step_s),
        number(row.cost_per_step_s / one(row.effects).cost_per_step_s),
        number(row.model_cost_per_step_s / one(row.effects).model_cost_per_step_s),
      ]),
  );
}

export function predicted_table(tables) {
  const rows = predicted(tables);
  const ranks = distinct(rows.map((row) => row.ranks)).sort((a, b) => a - b);
  const runs = distinct(rows.map((row) => `${row.effects} ${row.strands}`));
  return table(
    ['effects with gravity', 'hairs', ...ranks.map((count) => `R = ${count}`)],
    runs.map((run) => {
      const own = rows.filter((row) => `${row.effects} ${row.strands}` === run);
      return [
        ...run.split(' '),
        ...ranks.map((count) => {
          const row = own.find((one) => one.ranks === count);
          if (row === undefined || !is_positive(row.model_cost_per_step_s)) return '';
          return `${milli(row.model_cost_per_step_s)} (${percent(row.efficiency)})`;
        }),
      ];
    }),
  );
}

// Of one and two processes, which have a core each, the largest difference.
const largest = (column) => (tables) =>
  percent(
    Math.max(
      ...measured(tables)
        .filter((row) => row.ranks <= 2 && row.beside === 1 && is_number(row[column]))
        .map((row) => Math.abs(row[column])),
    ),
  );
export const off = largest('model_off_rel');
export const held_out = largest('held_out_off_rel');
export const exchange = (tables) =>
  micro(
    Math.max(
      ...measured(tables)
        .filter((row) => row.ranks === 2 && is_number(row.exchange_per_element_s))
        .map((row) => row.exchange_per_element_s),
    ),
  );

// "1, 2 and 4 processes of 1000 to 8000 hairs ...": what was measured, and on what.
export const extent = (tables) => {
  const rows = measured(tables);
  const of = (column) => distinct(rows.map((row) => row[column])).sort((a, b) => a - b);
  return (
    `${rows.length} runs with ${of('ranks').join(', ')} processes and ${range(rows.map((row) => row.strands))} hairs ` +
    `on ${of('cores').join(', ')} cores`
  );
};
