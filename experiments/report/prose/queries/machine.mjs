// Where, when and from which commit the tables were made.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

const manifests = (root) =>
  readdirSync(join(root, 'results'))
    .filter((file) => file.endsWith('.meta.json'))
    .sort()
    .map((file) => JSON.parse(readFileSync(join(root, 'results', file), 'utf8')));

// Those of one `./tress run`.
const quick = (root) => manifests(root).filter((manifest) => manifest.quick);

const listed = (values) => [...new Set(values.filter(Boolean))].join('; ');

export const processors = (_, root) => listed(quick(root).map(({ machine }) => machine?.cpu));

export const commits = (_, root) =>
  listed(quick(root).map(({ git }) => git?.commit?.slice(0, 7)))
    .split('; ')
    .map((commit) => `\`${commit}\``)
    .join(', ');

// Wall time of all experiments together, rounded up to whole minutes.
export const run_minutes = (_, root) => {
  const spent = quick(root).map(({ start, end }) => Date.parse(end) - Date.parse(start));
  return String(Math.ceil(spent.reduce((sum, ms) => sum + ms, 0) / 60_000));
};
