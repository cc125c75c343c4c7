// cluster.mjs slurm|snakemake [--parts n] [--profile file] [--folder folder] [--cores n]
//             [--sbatch] [--write-only] EXPERIMENT [its arguments]
// cluster.mjs status|resume|merge FOLDER
// cluster.mjs estimate [--out FILE] [--timeout TIME] [EXPERIMENT...]
// See docs/cluster.md. Exit codes as of ./tress.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { join, relative, resolve } from 'node:path';
import { InputError } from '../report/src/input.mjs';
import { write_estimates } from './estimate.mjs';
import { read_profile } from './profile.mjs';
import * as slurm from './slurm.mjs';
import * as snakemake from './snakemake.mjs';
import * as sweeps from './sweep.mjs';

const repository = resolve(import.meta.dirname ?? '.', '../..');
const programs =
  process.env.TRESS_PROGRAMS ?? join(repository, 'build/release/experiments');
const say = (text) => console.error(`tress: ${text}`);
const here = (path) => {
  const short = relative(process.cwd(), path) || '.';
  return short.startsWith('..') ? path : short;
};

const takes = {
  '--parts': 'whole',
  '--cores': 'whole',
  '--profile': 'text',
  '--folder': 'text',
  '--sbatch': 'flag',
  '--write-only': 'flag',
};

/// Options before the experiment's name; all that follows it is the experiment's.
function read_words(words) {
  const options = {};
  while (words.length > 0 && words[0].startsWith('-')) {
    const name = words.shift();
    const kind = takes[name];
    if (kind === undefined)
      throw new InputError(
        `cluster: unknown option '${name}'; there are ${Object.keys(takes).join(', ')}`,
      );
    if (kind === 'flag') {
      options[name] = true;
      continue;
    }
    const value = words.shift();
    if (value === undefined)
      throw new InputError(`cluster: ${name} without a value; give one`);
    if (kind === 'whole' && !/^[1-9][0-9]{0,5}$/.test(value))
      throw new InputError(
        `cluster: ${name} ${value} is not a whole number above 0; as in ${name} 4`,
      );
    options[name] = kind === 'whole' ? Number(value) : value;
  }
  const [experiment, ...args] = words;
  return { options, experiment, args };
}

const known_experiments = () =>
  readFileSync(join(programs, 'list.txt'), 'utf8').trim().split('\n');

function known_experiment(name) {
  const list = known_experiments();
  if (name === undefined || !list.includes(name))
    throw new InputError(
      `cluster: no experiment '${name ?? ''}'; there are ${list.join(' ')}`,
    );
  return join(programs, name);
}

const version_of = (program) =>
  spawnSync(program, ['--version'], { encoding: 'utf8' }).stdout.trim();

/// Slurm and Snakemake each read paths in a way of their own (blanks, %, {}, $), which no
/// quoting suits.
function refuse_strange(folder) {
  const strange = folder.match(/[^\p{L}\p{N}_@+=:,./-]/u);
  if (strange)
    throw new InputError(
      `${JSON.stringify(folder)}: has ${JSON.stringify(strange[0])} in its path, which ` +
        'Slurm and Snakemake may take for something else; give a --folder of letters, ' +
        'digits and _ @ + = : , . / -',
    );
}

/// As it is in its folder, or a new one with the pilot's estimate.
function prepared(scheduler, { options, experiment, args }, program, folder) {
  const profile = read_profile(options['--profile']);
  const fresh = {
    experiment,
    args,
    program,
    repository,
    folder,
    version: version_of(program),
  };
  if (existsSync(join(folder, 'sweep.json'))) {
    const sweep = sweeps.load(folder);
    for (const key of ['experiment', 'args'])
      if (JSON.stringify(sweep[key]) !== JSON.stringify(fresh[key]))
        throw new InputError(
          `${here(folder)}: holds another sweep: '${sweep[key]}', not '${fresh[key]}'; ` +
            'give another --folder, or remove it',
        );
    if (options['--parts'] && options['--parts'] !== sweep.parts)
      throw new InputError(
        `${here(folder)}: the sweep has ${sweep.parts} parts; leave --parts out`,
      );
    return {
      ...sweep,
      ...fresh,
      version: sweep.version,
      scheduler,
      profile,
      needs: sweeps.needs(sweep.pilot, sweep.parts, profile),
    };
  }
  const strange = sweeps.remains(folder);
  if (strange.length > 0)
    throw new InputError(
      `${here(folder)}: holds '${strange[0]}' and no sweep; give another --folder`,
    );
  const pilot = sweeps.pilot(fresh, say);
  const parts = options['--parts'] ?? sweeps.usual_parts(pilot, profile);
  if (parts > pilot.rows)
    throw new InputError(`--parts: ${parts} parts of ${pilot.rows} rows; give fewer`);
  return {
    ...fresh,
    scheduler,
    profile,
    pilot,
    parts,
    needs: sweeps.needs(pilot, parts, profile),
    submissions: [],
  };
}

function tell_estimate({ pilot, parts, needs }) {
  const hours = sweeps.core_hours(pilot, parts);
  say(
    `${pilot.rows} rows of about ${pilot.row_s.toPrecision(2)} s ` +
      `(${pilot.timed} were timed): ${hours.toPrecision(2)} core hours in ${parts} parts; ` +
      `each asks for ${needs.minutes} min and ${needs.memory_mb} MB`,
  );
}

function refuse_while_running(sweep) {
  for (const { array, merge } of sweep.submissions)
    for (const job of [array, merge])
      if (Object.keys(slurm.states(job)).length > 0)
        throw new InputError(
          `${here(sweep.folder)}: job ${job} is still at work; wait for it, or: scancel ${array} ${merge}`,
        );
}

function submit(sweep, options) {
  refuse_while_running(sweep);
  const version = version_of(sweep.program);
  if (sweep.version !== version)
    throw new InputError(
      `${here(sweep.folder)}: begun by '${sweep.version}', but the program is ` +
        `'${version}'; build that again, or remove the folder`,
    );
  const lost = sweeps.lost_parts(sweep);
  sweeps.write_scripts(sweep);
  sweeps.save(sweep);
  if (lost.length < sweep.parts)
    say(`${sweep.parts - lost.length} of ${sweep.parts} parts are there`);
  if (lost.length === 0) return merged(sweep);
  const again = `./tress cluster status ${here(sweep.folder)}`;
  if (sweep.scheduler === 'slurm') {
    const files = slurm.write(sweep, lost);
    if (options['--write-only']) {
      say(`wrote ${here(files.array)} and ${here(files.merge)}`);
      return 0;
    }
    const jobs = slurm.submit(files);
    sweep.submissions.push(jobs);
    sweeps.save(sweep);
    say(
      `submitted job ${jobs.array} (${lost.length} parts) and ${jobs.merge}, which joins them; ${again}`,
    );
    return 0;
  }
  const file = snakemake.write(sweep);
  const cores = options['--cores'] ?? availableParallelism();
  const words = snakemake.command(sweep, { cores, sbatch: options['--sbatch'] });
  if (options['--write-only']) {
    say(`wrote ${here(file)}; start it: ${words.map(sweeps.quoted).join(' ')}`);
    return 0;
  }
  if (snakemake.run(words)) return told(sweep);
  say(`parts are missing; ${again}`);
  return 3;
}

function told(sweep) {
  say(`the table: ${here(sweeps.table_of(sweep))}`);
  return 0;
}

function merged(sweep) {
  const lost = sweeps.lost_parts(sweep);
  if (lost.length > 0)
    throw new InputError(
      `${here(sweep.folder)}: parts ${lost.join(', ')} of ${sweep.parts} are missing; ` +
        `./tress cluster resume ${here(sweep.folder)}`,
    );
  const done = spawnSync(join(sweep.folder, 'merge.sh'), { encoding: 'utf8' });
  if (done.status !== 0)
    throw new InputError(done.stderr.trim().split('\n').pop() || 'merge.sh failed');
  return told(sweep);
}

function status(sweep) {
  const lost = sweeps.lost_parts(sweep);
  const rows = sweeps
    .numbers(sweep)
    .reduce((sum, i) => sum + sweeps.rows_of_part(sweep, i), 0);
  console.log(`${sweep.experiment} ${sweep.args.join(' ')}`.trim());
  console.log(
    `parts: ${sweep.parts - lost.length} of ${sweep.parts} complete; rows: ${rows} finished`,
  );
  let active = false;
  for (const { array, merge } of sweep.submissions)
    for (const [what, job] of [
      ['parts', array],
      ['join', merge],
    ])
      for (const [state, count] of Object.entries(slurm.states(job))) {
        active = true;
        console.log(`job ${job} (${what}): ${count} ${state.toLowerCase()}`);
      }
  for (const i of lost) {
    const log = join(sweep.folder, 'logs', `${i}.log`);
    const last = existsSync(log)
      ? readFileSync(log, 'utf8').trim().split('\n').pop()
      : '';
    console.log(
      `part ${i}: ${sweeps.rows_of_part(sweep, i)} rows finished${last ? `; log: ${last}` : ''}`,
    );
  }
  const table = sweeps.table_of(sweep);
  if (existsSync(table)) console.log(`table: ${here(table)}`);
  else if (lost.length === 0)
    console.log(`next: ./tress cluster merge ${here(sweep.folder)}`);
  else if (!active) console.log(`next: ./tress cluster resume ${here(sweep.folder)}`);
  return 0;
}

/// What every sweep of all rows takes, as a table.
function estimate(words) {
  const options = { '--out': 'results/full_sweeps.csv', '--timeout': '60s' };
  while (words.length > 0 && words[0].startsWith('-')) {
    const name = words.shift();
    if (!(name in options))
      throw new InputError(
        `cluster: unknown option '${name}'; there are ${Object.keys(options).join(', ')}`,
      );
    if (words.length === 0)
      throw new InputError(`cluster: ${name} without a value; give one`);
    options[name] = words.shift();
  }
  // simulate runs scenes, which are not rows of a sweep.
  const names =
    words.length > 0 ? words : known_experiments().filter((name) => name !== 'simulate');
  const list = names.map((name) => [name, known_experiment(name)]);
  return write_estimates(
    list.map(([experiment, program]) => ({
      experiment,
      program,
      repository,
      args: ['--full', '--timeout', options['--timeout']],
    })),
    resolve(repository, options['--out']),
    say,
  );
}

function answer([command, ...words]) {
  if (command === 'slurm' || command === 'snakemake') {
    const read = read_words(words);
    const program = known_experiment(read.experiment);
    sweeps.refuse_ours(read.args);
    const folder = resolve(
      read.options['--folder'] ?? join(repository, 'results/cluster', read.experiment),
    );
    refuse_strange(folder);
    const was_there = existsSync(folder);
    mkdirSync(folder, { recursive: true });
    try {
      return sweeps.alone(folder, () => {
        const sweep = prepared(command, read, program, folder);
        tell_estimate(sweep);
        return submit(sweep, read.options);
      });
    } finally {
      if (!was_there && sweeps.remains(folder).length === 0)
        rmSync(folder, { recursive: true });
    }
  }
  if (['status', 'resume', 'merge'].includes(command)) {
    if (words.length !== 1)
      throw new InputError(`cluster ${command}: give the folder of a sweep`);
    const sweep = sweeps.load(words[0]);
    if (command === 'status') return status(sweep);
    return sweeps.alone(sweep.folder, () =>
      command === 'merge' ? merged(sweep) : submit(sweep, {}),
    );
  }
  if (command === 'estimate') return estimate(words);
  throw new InputError(
    `cluster: no command '${command ?? ''}'; there are slurm, snakemake, status, resume, merge, estimate`,
  );
}

try {
  process.exitCode = answer(process.argv.slice(2));
} catch (error) {
  if (!(error instanceof InputError)) throw error;
  say(error.message);
  process.exitCode = 2;
}
