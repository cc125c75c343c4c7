// node experiments/report/compare.mjs BEFORE AFTER [OLD=NEW...]: which rows of two folders of
// results agree? Tables are matched by name; OLD=NEW says that the rows of table OLD have
// moved to table NEW. Compared are the columns that both tables have, except run_id, timings
// (named by the manifest) and what follows from timings; numbers agree to five digits.
// Exit code 3 when a row of BEFORE has no equal in AFTER.
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { basename, join } from 'node:path';
import { InputError } from './src/input.mjs';
import { parse_csv } from './src/csv.mjs';

const digits = 5;
const follows_from_timings = ['run_id', 'pareto', 'rank', 'reason'];

function read_table(folder, name) {
  const file = join(folder, `${name}.csv`);
  if (!existsSync(file)) return undefined;
  const manifest = join(folder, `${name}.meta.json`);
  const timings = existsSync(manifest)
    ? (JSON.parse(readFileSync(manifest, 'utf8')).timings ?? [])
    : [];
  return { ...parse_csv(readFileSync(file, 'utf8'), file), timings };
}

const cell = (value) =>
  typeof value === 'number' ? value.toPrecision(digits) : (value ?? '').toString();

function compare(before, after) {
  const skipped = new Set([...follows_from_timings, ...before.timings, ...after.timings]);
  const names = (table) => table.columns.map(({ name }) => name);
  const shared = names(before).filter(
    (name) => names(after).includes(name) && !skipped.has(name),
  );
  const keys = (table) => {
    const places = shared.map((name) => names(table).indexOf(name));
    return table.rows.map((row) => places.map((i) => cell(row[i])).join(','));
  };
  const left = new Map();
  for (const key of keys(after)) left.set(key, (left.get(key) ?? 0) + 1);
  const lost = keys(before).filter((key) => {
    const count = left.get(key) ?? 0;
    if (count > 0) left.set(key, count - 1);
    return count === 0;
  });
  return { shared, lost };
}

try {
  const [old_folder, new_folder, ...moves] = process.argv.slice(2);
  if (new_folder === undefined)
    throw new InputError('usage: compare.mjs BEFORE AFTER [OLD=NEW...]');
  const moved = new Map(moves.map((move) => move.split('=')));
  let any_lost = false;
  const tables = readdirSync(old_folder).filter((file) => file.endsWith('.csv'));
  for (const name of tables.map((file) => basename(file, '.csv')).sort()) {
    const before = read_table(old_folder, name);
    const after = read_table(new_folder, moved.get(name) ?? name);
    if (after === undefined) {
      any_lost = true;
      console.log(`${name}: no such table in ${new_folder}`);
      continue;
    }
    const { shared, lost } = compare(before, after);
    any_lost ||= lost.length > 0;
    const equal = before.rows.length - lost.length;
    console.log(
      `${name}: ${equal} of ${before.rows.length} rows agree in ${shared.length} columns` +
        ` (${after.rows.length} rows after)`,
    );
    for (const key of lost.slice(0, 5)) console.log(`  lost: ${key}`);
  }
  process.exitCode = any_lost ? 3 : 0;
} catch (error) {
  if (!(error instanceof InputError) && error.code !== 'ENOENT') throw error;
  console.error(`compare: ${error.message}`);
  process.exitCode = 2;
}
