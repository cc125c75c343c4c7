// A sweep as a Snakefile: a rule that makes a part, a rule that joins them.
import { spawnSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { InputError } from '../report/src/input.mjs';
import { flags } from './slurm.mjs';
import { quoted } from './sweep.mjs';

export function write(sweep) {
  const { experiment, parts, needs } = sweep;
  const file = join(sweep.folder, 'Snakefile');
  writeFileSync(
    file,
    `# Made by ./tress cluster.
rule merged:
    input: expand("${experiment}.{i}-of-${parts}.csv", i=range(1, ${parts + 1}))
    output: "${experiment}.csv"
    log: "logs/merge.log"
    resources: mem_mb=${needs.memory_mb}, runtime=10
    shell: "./merge.sh > {log} 2>&1"

rule part:
    output: "${experiment}.{i}-of-${parts}.csv"
    log: "logs/{i}.log"
    resources: mem_mb=${needs.memory_mb}, runtime=${needs.minutes}
    shell: "./part.sh {wildcards.i} >> {log} 2>&1"
`,
  );
  return file;
}

export function command(sweep, { cores, sbatch }) {
  const all = [
    'snakemake',
    '--snakefile',
    join(sweep.folder, 'Snakefile'),
    '--directory',
    sweep.folder,
    '--keep-going',
    '--rerun-incomplete',
    '--rerun-triggers',
    'mtime',
  ];
  if (!sbatch) return [...all, '--cores', String(cores)];
  const job = [
    'sbatch',
    '--parsable',
    '--ntasks=1',
    '--cpus-per-task=1',
    `--output=${join(sweep.folder, 'logs', 'sbatch-%j.log')}`,
    '--time={resources.runtime}',
    '--mem={resources.mem_mb}M',
  ];
  // A shell reads this; the scheduler fills in what stands in braces.
  const words = [...job, ...flags(sweep).map(quoted)];
  return [...all, '--jobs', String(sweep.parts), '--cluster', words.join(' ')];
}

/// To its end; true if every part was made.
export function run(words) {
  const [program, ...args] = words;
  const done = spawnSync(program, args, { stdio: ['ignore', 'inherit', 'inherit'] });
  if (done.error)
    throw new InputError(
      'snakemake: not found; apt-get install snakemake, or: ./tress cluster slurm',
    );
  return done.status === 0;
}
