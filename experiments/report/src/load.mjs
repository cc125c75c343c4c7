// Reads a results directory: every CSV with its manifest. What cannot be read is a
// warning and left out.
import { existsSync, readdirSync } from 'node:fs';
import { basename, join } from 'node:path';
import { parse_csv } from './csv.mjs';
import { InputError, read_json, read_or_warn, read_text } from './input.mjs';
import { is_object } from './objects.mjs';
import { table_rules } from './tables.mjs';

function read_manifest(directory, name) {
  const path = [`${name}.meta.json`, `${name}.csv.meta.json`]
    .map((file) => join(directory, file))
    .find(existsSync);
  if (path === undefined) return undefined;
  const manifest = read_json(path);
  if (!is_object(manifest))
    throw new InputError(`${path}: must be a JSON object; run the experiment again`);
  return manifest;
}

// Texts by column, value and key; whatever else stands there is left out.
function glossary_of(manifest) {
  const objects = (value) =>
    is_object(value) ? Object.entries(value).filter(([, inner]) => is_object(inner)) : [];
  return Object.fromEntries(
    objects(manifest?.glossary).map(([column, values]) => [
      column,
      Object.fromEntries(
        objects(values).map(([value, texts]) => [
          value,
          Object.fromEntries(
            Object.entries(texts).filter(([, text]) => typeof text === 'string'),
          ),
        ]),
      ),
    ]),
  );
}

function csv_files(directory) {
  try {
    return readdirSync(directory)
      .filter((file) => file.endsWith('.csv'))
      .sort();
  } catch (error) {
    throw new InputError(
      `${directory}: cannot read this directory (${error.code}); ` +
        'give the directory that holds the CSV files',
    );
  }
}

// {name: {columns, rows, manifest, glossary}} for every readable *.csv in `directory`.
export function load_results(directory, warn) {
  const tables = csv_files(directory).flatMap((file) => {
    const name = basename(file, '.csv');
    const path = join(directory, file);
    const table = read_or_warn(
      () => parse_csv(read_text(path), path, table_rules(name)),
      warn,
      name,
    );
    if (table === undefined) return [];
    const manifest = read_or_warn(() => read_manifest(directory, name), warn);
    return [[name, { ...table, manifest, glossary: glossary_of(manifest) }]];
  });
  return Object.fromEntries(tables);
}
