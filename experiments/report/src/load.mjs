// Reads a results directory: every CSV with its manifest.
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { InputError, parse_csv } from './csv.mjs';
import { known_tables } from './tables.mjs';

function read_manifest(directory, name) {
  const path = [`${name}.meta.json`, `${name}.csv.meta.json`]
    .map((file) => join(directory, file))
    .find(existsSync);
  if (path === undefined) return undefined;
  try {
    return JSON.parse(readFileSync(path, 'utf8'));
  } catch (error) {
    throw new InputError(`${path}: not valid JSON (${error.message.split('\n')[0]})`);
  }
}

// {name: {columns, rows, manifest, glossary}} for every *.csv in `directory`.
export function load_results(directory) {
  let files;
  try {
    files = readdirSync(directory)
      .filter((file) => file.endsWith('.csv'))
      .sort();
  } catch (error) {
    throw new InputError(
      `${directory}: cannot read this directory (${error.code}); ` +
        'give the directory that holds the CSV files',
    );
  }
  return Object.fromEntries(
    files.map((file) => {
      const name = basename(file, '.csv');
      const path = join(directory, file);
      const table = parse_csv(readFileSync(path, 'utf8'), path, known_tables[name]);
      const manifest = read_manifest(directory, name);
      return [name, { ...table, manifest, glossary: manifest?.glossary ?? {} }];
    }),
  );
}
