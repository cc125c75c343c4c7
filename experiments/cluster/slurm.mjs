// A sweep as a job array of Slurm, and a job that joins its parts when all have ended.
import { spawnSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { InputError } from '../report/src/input.mjs';
import { quoted } from './sweep.mjs';

function slurm(command, args) {
  const done = spawnSync(command, args, { encoding: 'utf8' });
  if (done.error)
    throw new InputError(
      `${command}: not found; install Slurm's commands, or: ./tress cluster snakemake`,
    );
  if (done.status !== 0)
    throw new InputError(`${command}: ${done.stderr.trim().split('\n').pop()}`);
  return done.stdout.trim();
}

/// 1,2,3,7 as 1-3,7.
function ranges(parts) {
  const all = [];
  for (const i of parts) {
    const last = all[all.length - 1];
    if (last && last[1] === i - 1) last[1] = i;
    else all.push([i, i]);
  }
  return all.map(([a, b]) => (a === b ? `${a}` : `${a}-${b}`)).join(',');
}

export function flags(sweep) {
  const { partition, account, qos, options } = sweep.profile;
  return [
    partition && `--partition=${partition}`,
    account && `--account=${account}`,
    qos && `--qos=${qos}`,
    ...(options ? options.split(/\s+/) : []),
  ].filter(Boolean);
}

function write_job(sweep, name, lines, command) {
  const file = join(sweep.folder, name);
  const of_user = flags(sweep).map((flag) => `#SBATCH ${flag}`);
  writeFileSync(
    file,
    ['#!/usr/bin/env bash', ...lines, ...of_user, `exec ${command}`].join('\n') + '\n',
    { mode: 0o755 },
  );
  return file;
}

export function write(sweep, parts) {
  const job = `tress-${sweep.experiment}`;
  const log = (name) => `#SBATCH --output=${join(sweep.folder, 'logs', name)}`;
  return {
    array: write_job(
      sweep,
      'array.sbatch',
      [
        `#SBATCH --job-name=${job}`,
        `#SBATCH --array=${ranges(parts)}`,
        '#SBATCH --ntasks=1 --cpus-per-task=1 --open-mode=append',
        `#SBATCH --time=${sweep.needs.minutes} --mem=${sweep.needs.memory_mb}M`,
        log('%a.log'),
      ],
      `${quoted(join(sweep.folder, 'part.sh'))} "$SLURM_ARRAY_TASK_ID"`,
    ),
    merge: write_job(
      sweep,
      'merge.sbatch',
      [
        `#SBATCH --job-name=${job}-merge`,
        '#SBATCH --ntasks=1 --cpus-per-task=1 --open-mode=append',
        `#SBATCH --time=10 --mem=${sweep.needs.memory_mb}M`,
        log('merge.log'),
      ],
      quoted(join(sweep.folder, 'merge.sh')),
    ),
  };
}

/// Numbers of the array's job and of the one that joins.
export function submit(files) {
  const array = slurm('sbatch', ['--parsable', files.array]).split(';')[0];
  const merge = slurm('sbatch', [
    '--parsable',
    `--dependency=afterok:${array}`,
    '--kill-on-invalid-dep=yes',
    files.merge,
  ]).split(';')[0];
  return { array, merge };
}

/// What Slurm says of a job's tasks, as in { RUNNING: 2, PENDING: 1 }; empty: it has ended.
export function states(job) {
  const done = spawnSync('squeue', ['-h', '-r', '-o', '%T', '-j', job], {
    encoding: 'utf8',
  });
  if (done.error)
    throw new InputError('squeue: not found; ask where the sweep was submitted');
  const count = {};
  if (done.status !== 0) return count; // it is no longer known
  for (const state of done.stdout.split('\n').filter(Boolean))
    count[state] = (count[state] ?? 0) + 1;
  return count;
}
