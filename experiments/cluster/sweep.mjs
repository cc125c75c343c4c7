// A sweep: one experiment with its arguments, cut into parts, in a folder of its own. What
// is known of it stands in sweep.json; a part is complete when its table is there, which a
// program writes last, after the manifest.
import { spawnSync } from 'node:child_process';
import {
  existsSync,
  mkdirSync,
  readFileSync,
  readdirSync,
  renameSync,
  rmSync,
  writeFileSync,
} from 'node:fs';
import { hostname } from 'node:os';
import { join, resolve } from 'node:path';
import { InputError, read_json } from '../report/src/input.mjs';

const ours = [
  '--shard',
  '--out',
  '--merge',
  '--resume',
  '--jobs',
  '--dry-run',
  '--list',
  '--help',
];

export const quoted = (word) =>
  /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", `'\\''`)}'`;

export function refuse_ours(args) {
  for (const arg of args) {
    const [option] = arg.split('=');
    if (ours.includes(option))
      throw new InputError(`${option}: the sweep gives this itself; leave it out`);
  }
}

export const table_of = (sweep) => join(sweep.folder, `${sweep.experiment}.csv`);
export const table_of_part = (sweep, i) =>
  join(sweep.folder, `${sweep.experiment}.${i}-of-${sweep.parts}.csv`);
const manifest_beside = (table) => table.replace(/\.csv$/, '.meta.json');

export function numbers(sweep) {
  return Array.from({ length: sweep.parts }, (_, k) => k + 1);
}
export const lost_parts = (sweep) =>
  numbers(sweep).filter((i) => !existsSync(table_of_part(sweep, i)));

/// Of a part that has not ended: rows that its journal holds.
export function rows_of_part(sweep, i) {
  const table = table_of_part(sweep, i);
  if (existsSync(table)) return read_json(manifest_beside(table)).rows.total;
  const journal = `${table}.journal`;
  if (!existsSync(journal)) return 0;
  return Math.max(0, readFileSync(journal, 'utf8').split('\n').length - 2);
}

export function save(sweep) {
  const file = join(sweep.folder, 'sweep.json');
  writeFileSync(`${file}.part`, `${JSON.stringify(sweep, null, 2)}\n`);
  renameSync(`${file}.part`, file);
}

export function load(folder) {
  const file = join(folder, 'sweep.json');
  if (!existsSync(file))
    throw new InputError(
      `${folder}: no sweep there; begin one: ./tress cluster slurm EXPERIMENT`,
    );
  const sweep = read_json(file, 2 ** 20);
  if (typeof sweep.experiment !== 'string' || !Number.isInteger(sweep.parts))
    throw new InputError(`${file}: not of a sweep; remove the folder and begin again`);
  return { ...sweep, folder: resolve(folder) };
}

/// `use()` while no other process works on the folder.
export function alone(folder, use) {
  const lock = join(folder, 'lock');
  for (;;) {
    try {
      writeFileSync(lock, `${process.pid} ${hostname()}`, { flag: 'wx' });
      break;
    } catch (error) {
      if (error.code !== 'EEXIST') throw error;
    }
    const [pid, host] = readFileSync(lock, 'utf8').split(' ');
    if (host !== hostname() || existsSync(`/proc/${pid}`))
      throw new InputError(
        `${lock}: process ${pid} on ${host} works on this sweep; wait for it`,
      );
    rmSync(lock, { force: true });
  }
  try {
    return use();
  } finally {
    rmSync(lock, { force: true });
  }
}

/// Runs the experiment's program here; its last line on failure is the complaint. What it
/// takes of a processor, in s, is bash's to say.
function program(sweep, args) {
  const done = spawnSync(
    'bash',
    ['-c', 'code=0; "$@" || code=$?; times >&2; exit $code', 'bash', sweep.program]
      .concat(sweep.args)
      .concat(args),
    { cwd: sweep.repository, encoding: 'utf8', maxBuffer: 2 ** 28 },
  );
  if (done.status === 130 || done.signal)
    throw new InputError('interrupted; give the same command again');
  // The last two lines are of times: the shell's own, the program's.
  const lines = done.stderr.trim().split('\n');
  if (done.status !== 0 && done.status !== 3)
    throw new InputError(lines.at(-3) || `${sweep.program} ended with ${done.status}`);
  const times = [...lines.at(-1).matchAll(/(\d+)m([\d.]+)s/g)];
  const processor_s = times.reduce((sum, [, m, s]) => sum + 60 * Number(m) + Number(s), 0);
  return { stdout: done.stdout, processor_s };
}

/// Counts rows and runs some of them, spread over all, to tell what they take: a row, and
/// to plan them, which every part does.
export function pilot(sweep, say) {
  const plan = program(sweep, ['--dry-run']);
  const rows = plan.stdout.split('\n').length - 1;
  if (rows < 2)
    throw new InputError(
      `${sweep.experiment}: ${rows} row, nothing to share; ./tress run`,
    );
  const sample = Math.max(2, Math.ceil(rows / 6));
  say(`${rows} rows; some of them are timed first`);
  for (const name of readdirSync(sweep.folder))
    if (name.startsWith('pilot.')) rmSync(join(sweep.folder, name));
  const out = join(sweep.folder, 'pilot.csv');
  program(sweep, [
    '--shard',
    `1/${sample}`,
    '--out',
    out,
    '--jobs',
    '1',
    '--progress',
    'none',
  ]);
  const table = out.replace(/csv$/, `1-of-${sample}.csv`);
  const manifest = read_json(manifest_beside(table));
  rmSync(table);
  rmSync(manifest_beside(table));
  const timed = Math.ceil(rows / sample);
  return {
    rows,
    timed,
    plan_s: plan.processor_s,
    row_s: Math.max(0, manifest.spent.processor_s - plan.processor_s) / timed,
    cut_off: manifest.rows.by_status.timeout ?? 0,
    largest_mb: manifest.spent.largest_mb,
    timeout_s: manifest.timeout_s,
  };
}

/// Of the whole, in so many parts.
export const core_hours = ({ rows, row_s, plan_s = 0 }, parts) =>
  (rows * row_s + parts * plan_s) / 3600;

/// Minutes and memory of a part: twice what the pilot's rows took, and one row that runs
/// into its timeout; half more memory than its largest process, twice (two processes).
export function needs(known, parts, profile) {
  const rows = Math.ceil(known.rows / parts);
  return {
    minutes:
      profile.minutes ??
      Math.ceil((2 * (rows * known.row_s + (known.plan_s ?? 0)) + known.timeout_s) / 60),
    memory_mb:
      profile.memory_mb ?? Math.max(256, 64 * Math.ceil((3 * known.largest_mb) / 64)),
  };
}

/// Parts of about a quarter of an hour.
export function usual_parts(known, profile) {
  const wanted = Math.ceil((known.rows * known.row_s) / 900);
  return Math.max(2, Math.min(wanted, known.rows, profile.most_tasks));
}

/// The script that runs part $1 to its end, and the one that joins the parts. A table
/// whose rows failed is complete: they are rows with a reason.
export function write_scripts(sweep) {
  const command = [sweep.program, ...sweep.args].map(quoted).join(' ');
  const head = `#!/usr/bin/env bash
# Made by ./tress cluster.
set -euo pipefail
cd ${quoted(sweep.repository)}
${sweep.profile.setup ? `${sweep.profile.setup}\n` : ''}${command} \\
`;
  const end = ` || {
  code=$?
  ((code == 3)) || exit "$code"
}
`;
  const tables = numbers(sweep).map((i) => quoted(table_of_part(sweep, i)));
  mkdirSync(join(sweep.folder, 'logs'), { recursive: true });
  const write = (name, text) =>
    writeFileSync(join(sweep.folder, name), text, { mode: 0o755 });
  write(
    'part.sh',
    `${head}  --shard "$1/${sweep.parts}" --out ${quoted(table_of(sweep))} ` +
      `--jobs 1 --resume --progress none${end}`,
  );
  write(
    'merge.sh',
    `${head}  --out ${quoted(table_of(sweep))} --merge \\
  ${tables.join(' \\\n  ')}${end}`,
  );
}

/// What else lies in the folder than what an interrupted pilot left.
export const remains = (folder) =>
  readdirSync(folder).filter((name) => name !== 'lock' && !name.startsWith('pilot.'));
