// What is compared: a folder of results, a build, or a commit, which is built.
import { spawnSync } from 'node:child_process';
import {
  closeSync,
  existsSync,
  mkdirSync,
  openSync,
  readdirSync,
  statSync,
} from 'node:fs';
import { join, resolve } from 'node:path';
import { InputError } from '../report/src/input.mjs';

const benchmarks = 'experiments/benchmarks';

/// {kind: 'results', folder} or {kind: 'programs', folder, name} or {kind: 'commit', sha, name}.
export function side_of(text, repository) {
  if (existsSync(text) && statSync(text).isDirectory()) {
    if (existsSync(join(text, benchmarks)))
      return { kind: 'programs', name: text, folder: resolve(text, benchmarks) };
    const tables = readdirSync(text).some((name) =>
      /\.csv$|^bench_\w+\.json$/.test(name),
    );
    if (tables) return { kind: 'results', name: text, folder: text };
    throw new InputError(
      `${text}: holds neither tables nor ${benchmarks}; give results, a build such as build/bench, or a commit`,
    );
  }
  const found = spawnSync(
    'git',
    ['rev-parse', '--verify', '--quiet', `${text}^{commit}`],
    {
      cwd: repository,
      encoding: 'utf8',
    },
  );
  if (found.status !== 0)
    throw new InputError(
      `${text}: neither a folder nor a commit; give results, a build such as build/bench, or a commit`,
    );
  return { kind: 'commit', name: text, sha: found.stdout.trim() };
}

/// Builds the benchmarks of a commit in build/compare/<commit>, once.
export function build(side, repository, say) {
  const tree = join(repository, 'build/compare', side.sha.slice(0, 12));
  const log_file = `${tree}.log`;
  mkdirSync(join(repository, 'build/compare'), { recursive: true });
  const log = openSync(log_file, 'w');
  const run = (cwd, program, ...args) => {
    const { status, error } = spawnSync(program, args, {
      cwd,
      stdio: ['ignore', log, log],
    });
    if (status !== 0)
      throw new InputError(
        `${side.name}: ${program} ${args[0]} failed${error ? ` (${error.code})` : ''}; log: ${log_file}`,
      );
  };
  try {
    if (!existsSync(tree)) {
      run(repository, 'git', 'worktree', 'prune');
      run(repository, 'git', 'worktree', 'add', '--detach', tree, side.sha);
    }
    say(`building ${side.name} (${tree}, log: ${log_file})`);
    const sundials = process.env.TRESS_SUNDIALS_ROOT ?? '';
    run(tree, 'cmake', '--preset', 'bench', `-DTRESS_SUNDIALS_ROOT=${sundials}`);
    run(tree, 'cmake', '--build', '--preset', 'bench', '--target', 'benchmarks');
  } finally {
    closeSync(log);
  }
  return { ...side, kind: 'programs', folder: join(tree, 'build/bench', benchmarks) };
}
