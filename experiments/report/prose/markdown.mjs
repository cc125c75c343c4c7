// Rows selected from the tables, and values as Markdown writes them.
import { is_number, is_positive, succeeded } from '../src/tables.mjs';

const same = (value, wanted) =>
  typeof wanted === 'number' && is_number(value)
    ? Math.abs(value - wanted) <= 1e-6 * Math.abs(wanted)
    : value === wanted;

const matches = (row, wanted) =>
  Object.entries(wanted).every(([column, value]) =>
    Array.isArray(value)
      ? value.some((one) => same(row[column], one))
      : same(row[column], value),
  );

// The rows of table `name` whose columns have these values (a list: one of them).
export function rows_of(tables, name, wanted = {}) {
  const table = tables[name];
  if (table === undefined) throw new Error(`results/${name}.csv is missing`);
  return table.filter((row) => matches(row, wanted));
}

// The one row of a kind; more or none are an error of the query, or of the table.
export function row_of(tables, name, wanted) {
  const found = rows_of(tables, name, wanted);
  if (found.length !== 1) {
    throw new Error(
      `results/${name}.csv has ${found.length} rows with ${JSON.stringify(wanted)}, expected one`,
    );
  }
  return found[0];
}

export const ok_rows = (tables, name, wanted) =>
  rows_of(tables, name, wanted).filter(succeeded);

// A sentence that stands on this condition must not be printed without it.
export function must(condition, sentence) {
  if (!condition) throw new Error(`no longer true, write it anew: "${sentence}"`);
}

// `digits` significant digits; powers of ten from 1e4 on and below 1e-3.
export function number(x, digits = 2) {
  if (!is_number(x)) return '';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size < 1e-3 || size >= 1e4) {
    return x
      .toExponential(Math.max(0, digits - 1))
      .replace(/\.0+e/, 'e')
      .replace('e+', 'e');
  }
  return String(Number(x.toPrecision(Math.max(digits, Math.ceil(Math.log10(size))))));
}

export const percent = (x, digits = 2) =>
  is_number(x) ? `${number(100 * x, digits)} %` : '';

export function time(seconds, digits = 2) {
  if (!is_positive(seconds)) return '';
  if (seconds >= 1) return `${number(seconds, digits)} s`;
  if (seconds >= 1e-3) return `${number(1e3 * seconds, digits)} ms`;
  return `${number(1e6 * seconds, digits)} µs`;
}

export const range = (values, as = number) => {
  const ends = [Math.min(...values), Math.max(...values)].map((x) => as(x));
  return ends[0] === ends[1] ? ends[0] : `${ends[0]} to ${ends[1]}`;
};

export function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length / 2;
  return sorted.length % 2 === 1
    ? sorted[Math.floor(middle)]
    : (sorted[middle - 1] + sorted[middle]) / 2;
}

const cell = (value) => String(value ?? '').replaceAll('|', '\\|');
const line = (cells) => `| ${cells.map(cell).join(' | ')} |`;

export const table = (head, rows) =>
  [line(head), `|${head.map(() => '---').join('|')}|`, ...rows.map(line)].join('\n');

export const bullets = (sentences) => sentences.map((text) => `- ${text}`).join('\n');
