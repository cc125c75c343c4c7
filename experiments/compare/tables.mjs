// Tables of two folders of results, row by row.
import { existsSync, readdirSync } from 'node:fs';
import { basename, join } from 'node:path';
import { parse_csv } from '../report/src/csv.mjs';
import { read_json, read_text } from '../report/src/input.mjs';
import { spread, verdict } from './statistics.mjs';

const digits = 5;
const confidence = 0.99;
// These follow from timings, or tell what other columns tell.
const not_compared = ['run_id', 'pareto', 'rank', 'reason'];
// A time: more of it is slower.
const is_time = (name) => /(^|_)(s|ms|us|ns)(_|$)/.test(name);

function read_table(folder, name) {
  const file = join(folder, `${name}.csv`);
  if (!existsSync(file)) return undefined;
  const meta = join(folder, `${name}.meta.json`);
  const manifest = existsSync(meta) ? read_json(meta) : {};
  const { columns, rows } = parse_csv(read_text(file), file);
  const names = columns.map((column) => column.name);
  return {
    names,
    rows: rows.map((row) => Object.fromEntries(names.map((c, i) => [c, row[i]]))),
    timings: manifest.timings ?? [],
    machine: manifest.machine && `${manifest.machine.cpu}, ${manifest.machine.simd}`,
  };
}

const cell = (value) =>
  typeof value === 'number'
    ? String(Number(value.toPrecision(digits)))
    : String(value ?? '');

/// Rows by what identifies them: run_id, or, in tables without, the columns of words.
/// Equal keys are told apart by their order.
function keyed(table, shared, words) {
  const by_id = shared.includes('run_id');
  const seen = new Map();
  return new Map(
    table.rows.map((row) => {
      const key = by_id ? row.run_id : words.map((name) => cell(row[name])).join(', ');
      const count = (seen.get(key) ?? 0) + 1;
      seen.set(key, count);
      return [count === 1 ? key : `${key} #${count}`, row];
    }),
  );
}

/// What a reader knows a row by.
const label = (row, words) =>
  words
    .map((name) => cell(row[name]))
    .filter((text) => text !== '' && text.length < 60)
    .slice(0, 8)
    .join(', ');

function compare_table(name, before, after, threshold) {
  const shared = before.names.filter((column) => after.names.includes(column));
  const timings = new Set([...before.timings, ...after.timings]);
  const values = shared.filter(
    (column) => !timings.has(column) && !not_compared.includes(column),
  );
  const words = values.filter((column) =>
    before.rows.some((row) => row[column] !== null && typeof row[column] !== 'number'),
  );
  const [of_before, of_after] = [before, after].map((table) =>
    keyed(table, shared, words),
  );
  const rows = [];
  const pairs = [];
  for (const [key, row] of of_before) {
    const other = of_after.get(key);
    if (other === undefined) {
      rows.push({ table: name, row: label(row, words), verdict: 'only before' });
      continue;
    }
    pairs.push([row, other]);
    const changed = values.filter((column) => cell(row[column]) !== cell(other[column]));
    if (changed.length === 0) continue;
    rows.push({
      table: name,
      row: label(row, words),
      column: changed.join(' '),
      verdict: 'changed value',
      change: changed.map((c) => `${c}: ${cell(row[c])} -> ${cell(other[c])}`).join('; '),
    });
  }
  for (const [key, row] of of_after)
    if (!of_before.has(key))
      rows.push({ table: name, row: label(row, words), verdict: 'only after' });
  return {
    rows: [...rows, ...compare_times(name, before, after, pairs, timings, threshold)],
    agree: pairs.length - rows.filter((row) => row.verdict === 'changed value').length,
  };
}

/// A row is timed once, so its ratio has no interval; all rows of a table together have.
function compare_times(name, before, after, pairs, timings, threshold) {
  return [...timings].filter(is_time).flatMap((column) => {
    const ratios = pairs
      .filter((pair) =>
        pair.every((row) => typeof row[column] === 'number' && row[column] > 0),
      )
      .map(([row, other]) => other[column] / row[column]);
    if (ratios.length === 0) return [];
    const interval = spread(ratios, confidence);
    const comparable = before.machine !== undefined && before.machine === after.machine;
    return [
      {
        table: name,
        row: `median of ${ratios.length} rows`,
        column,
        ...interval,
        verdict: comparable ? verdict(interval, threshold) : 'other machine',
      },
    ];
  });
}

/// Benchmarks that are stored, as ./tress bench writes them.
function read_benchmarks(folder, name) {
  const file = join(folder, name);
  if (!existsSync(file)) return undefined;
  const { context, benchmarks } = read_json(file);
  const times = new Map();
  for (const one of benchmarks.filter(
    (b) => b.run_type === 'iteration' && !b.error_occurred,
  ))
    times.set(one.run_name, [...(times.get(one.run_name) ?? []), one.cpu_time]);
  return { times, machine: `${context.cpu}, ${context.simd}` };
}

/// Each pairing of the repetitions; they did not take turns, so that only a ratio that all
/// pairings have beyond the threshold is a verdict.
function compare_stored(name, before, after, threshold) {
  return [...before.times].flatMap(([row, of_before]) => {
    const of_after = after.times.get(row);
    if (of_after === undefined) return [{ table: name, row, verdict: 'only before' }];
    const ratios = of_after
      .flatMap((b) => of_before.map((a) => b / a))
      .sort((a, b) => a - b);
    const interval = {
      ratio: ratios[ratios.length >> 1],
      low: ratios[0],
      high: ratios.at(-1),
    };
    const judged =
      interval.low > threshold
        ? 'slower'
        : interval.high < 1 / threshold
          ? 'faster'
          : 'same';
    return [
      {
        table: name,
        row,
        column: 'cpu_time',
        ...interval,
        verdict: before.machine === after.machine ? judged : 'other machine',
      },
    ];
  });
}

/// Rows with a verdict of all tables, and a line for each table.
export function compare_results(a, b, { threshold }) {
  const rows = [],
    lines = [];
  const files = readdirSync(a).sort();
  for (const file of files.filter((one) => one.endsWith('.csv'))) {
    const name = basename(file, '.csv');
    const [before, after] = [a, b].map((folder) => read_table(folder, name));
    if (after === undefined) {
      rows.push({ table: name, row: '', verdict: 'only before' });
      lines.push(`${name}: no such table after`);
      continue;
    }
    const found = compare_table(name, before, after, threshold);
    rows.push(...found.rows);
    lines.push(`${name}: ${found.agree} of ${before.rows.length} rows agree`);
  }
  for (const file of files.filter((one) => /^bench_\w+\.json$/.test(one))) {
    const [before, after] = [a, b].map((folder) => read_benchmarks(folder, file));
    if (after === undefined) rows.push({ table: file, row: '', verdict: 'only before' });
    else rows.push(...compare_stored(file, before, after, threshold));
  }
  return { rows, lines };
}
