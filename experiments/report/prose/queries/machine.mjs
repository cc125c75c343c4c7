// Where, when and from which commit the tables were made.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { must, number, table } from '../markdown.mjs';

// Manifests by the name of their table.
const manifests = (root) =>
  readdirSync(join(root, 'results'))
    .filter((file) => file.endsWith('.meta.json'))
    .sort()
    .map((file) => ({
      name: file.slice(0, -'.meta.json'.length),
      ...JSON.parse(readFileSync(join(root, 'results', file), 'utf8')),
    }));

export const manifest_of = (root, name) =>
  JSON.parse(readFileSync(join(root, 'results', `${name}.meta.json`), 'utf8'));

// Those of `./tress run`.
const quick = (root) => manifests(root).filter((manifest) => manifest.quick);

const distinct = (values) => [...new Set(values)];
const commit_of = ({ git }) =>
  git?.commit ? `${git.commit.slice(0, 7)}${git.dirty ? ' with uncommitted changes' : ''}` : 'unknown';

const load = (loads) => (Array.isArray(loads) ? number(loads[0]) : '');
// More runnable processes than processors: a timed thread had to share one.
const crowded = ({ machine }) =>
  [machine?.load_before, machine?.load_after].some(
    (loads) => Array.isArray(loads) && loads[0] > machine.cpus,
  );
const is_timed = ({ timings }) => Array.isArray(timings) && timings.length > 0;

export const processors = (_, root) =>
  distinct(quick(root).map(({ machine }) => `${machine?.cpu} (${machine?.cpus} processors)`)).join('; ');

// Whether the tables of `./tress run` are those of one run.
export const one_run = (_, root) => {
  const made = quick(root);
  must(made.length > 0, 'some table is made by ./tress run');
  const commits = distinct(made.map(commit_of));
  return commits.length === 1
    ? `The ${made.length} tables of \`./tress run\` come from commit ${commits[0]}`
    : `The ${made.length} tables of \`./tress run\` come from ${commits.length} commits, not from one run ` +
        `(${commits.map((commit) => `${made.filter((one) => commit_of(one) === commit).length} from ${commit}`).join(', ')})`;
};

// Every table: commit, date, processor, load, whether its times can be trusted.
export const made_table = (_, root) =>
  table(
    ['table', 'commit', 'date', 'processor', 'load before, after', 'SUNDIALS check', 'times'],
    manifests(root).map((manifest) => [
      `\`${manifest.name}\``,
      commit_of(manifest),
      String(manifest.start ?? '').slice(0, 10),
      `${manifest.machine?.cpu}, ${manifest.machine?.cpus} processors`,
      [manifest.machine?.load_before, manifest.machine?.load_after].map(load).filter(Boolean).join(', '),
      number(manifest.sundials_speed_ratio),
      !is_timed(manifest) ? '' : crowded(manifest) ? 'uncertain' : 'load within limit',
    ]),
  );

// How far the check of speed scatters between tables.
export const sundials_scatter = (_, root) => {
  const ratios = manifests(root)
    .map(({ sundials_speed_ratio: ratio }) => ratio)
    .filter((ratio) => ratio > 0);
  return `${number(Math.min(...ratios))} to ${number(Math.max(...ratios))} over ${ratios.length} tables`;
};

// Wall time of all experiments together, rounded up to whole minutes.
export const run_minutes = (_, root) => {
  const spent = quick(root).map(({ start, end }) => Date.parse(end) - Date.parse(start));
  return String(Math.ceil(spent.reduce((sum, ms) => sum + ms, 0) / 60_000));
};

// Where the numbers of a page come from: a line for every commit.
export const provenance = (names, root) => {
  const all = manifests(root).filter(({ name }) => names.includes(name));
  if (all.length === 0) return '';
  const commits = distinct(all.map(commit_of));
  const of = (commit) =>
    all
      .filter((manifest) => commit_of(manifest) === commit)
      .map((manifest) => `\`${manifest.name}\`${is_timed(manifest) && crowded(manifest) ? ' (times uncertain: loaded machine)' : ''}`)
      .join(', ');
  const mixed = commits.length > 1 ? `${commits.length} commits, not one run: ` : '';
  return (
    `Tables behind this page, from ${mixed}` +
    commits.map((commit) => `${of(commit)} at commit ${commit}`).join('; ') +
    '.'
  );
};
