// Spoils one line of the sources at a time and asks the tests: do they notice?
//
//   node run.mjs --check             every mutant of mutants.txt still fits its file
//   node run.mjs [--all] [--only PATTERN]   builds a copy of the sources in build/mutants,
//                                    spoils and tests it; writes results/mutants.csv
//
// A mutant is killed when one of its tests fails, crashes or runs out of time. The tests are
// run on the unspoilt copy first: a test that fails there kills nothing. What was found is
// kept in build/mutants/found.json: a mutant that was killed is asked about again when its
// file changes or with --all (after tests were taken away), one that survived when anything
// changes. So an interrupted run goes on where it was. Exit codes: 0 at least 95 % are killed, 2 a mutant does not fit, 3 too few
// are killed or one does not compile.
import { execFileSync, spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const copy = path.join(root, 'build/mutants');
const tree = path.join(copy, 'build/release');
const wanted = 0.95;
const testLimitMs = 300_000;

class Misfit extends Error {}

/// [{file, tests, before, after, line}]
function readMutants() {
  const name = 'tests/mutants/mutants.txt';
  const mutants = [];
  let at = null;
  let before = null;
  fs.readFileSync(path.join(root, name), 'utf8').split('\n').forEach((text, index) => {
    const place = `${name}:${index + 1}`;
    if (text === '' || text.startsWith('#')) return;
    const [mark, rest] = [text[0], text.slice(2)];
    if (mark === '@') {
      const [file, tests] = rest.split(': ');
      if (!tests) throw new Misfit(`no tests (${place}): write "@ file: test test"`);
      at = { file, tests: tests.split(' ') };
    } else if (mark === '-' && at) {
      before = rest;
    } else if (mark === '+' && before !== null) {
      mutants.push({ ...at, before, after: rest, line: lineOf(at.file, before, place) });
      before = null;
    } else {
      throw new Misfit(`line out of place (${place}): write "@", then pairs of "-" and "+"`);
    }
  });
  return mutants;
}

/// From 1.
function lineOf(file, text, place) {
  const lines = fs.readFileSync(path.join(root, file), 'utf8').split('\n');
  const found = lines.flatMap((line, i) => (line.trim() === text ? [i + 1] : []));
  if (found.length !== 1) {
    throw new Misfit(`${found.length} lines of ${file} read "${text}" (${place}): ` +
      'give a line that stands there once');
  }
  return found[0];
}

const hash_of = (text) => createHash('sha256').update(text).digest('hex');

/// What was found of a mutant, unless what it was found on has changed.
function still_true(kept, mutant, sources) {
  if (!kept) return undefined;
  const same = kept.outcome.startsWith('killed')
    ? kept.file === hash_of(fs.readFileSync(path.join(root, mutant.file)))
    : kept.sources === sources;
  return same ? kept : undefined;
}

function spoil({ file, line, after }) {
  const lines = fs.readFileSync(path.join(root, file), 'utf8').split('\n');
  const indentation = lines[line - 1].match(/^\s*/)[0];
  lines[line - 1] = indentation + after;
  fs.writeFileSync(path.join(copy, file), lines.join('\n'));
}

function restore({ file }) {
  fs.copyFileSync(path.join(root, file), path.join(copy, file));
}

/// Writes what differs, so that what is built stays built; returns a hash of all of it.
function copySources() {
  const files = execFileSync('git', ['ls-files', '-z', '--cached', '--others',
    '--exclude-standard'], { cwd: root, encoding: 'utf8', maxBuffer: 1 << 26 });
  const hash = createHash('sha256');
  for (const file of files.split('\0').filter((name) => name && !name.startsWith('results/'))) {
    const from = path.join(root, file);
    if (!fs.existsSync(from)) continue;
    const text = fs.readFileSync(from);
    hash.update(file).update(text);
    const to = path.join(copy, file);
    if (fs.existsSync(to) && fs.readFileSync(to).equals(text)) continue;
    fs.mkdirSync(path.dirname(to), { recursive: true });
    fs.copyFileSync(from, to);
  }
  return hash.digest('hex');
}

const running = new Set();

/// The exit code; null when it was ended by a signal or by the limit.
function run(command, args, { env = {}, limit = 0 } = {}) {
  return new Promise((resolve) => {
    const child = spawn(command, args, { cwd: copy, env: { ...process.env, ...env },
      stdio: 'ignore', timeout: limit, killSignal: 'SIGKILL' });
    running.add(child);
    const done = (code) => {
      running.delete(child);
      resolve(code);
    };
    child.on('close', done);
    child.on('error', () => done(null));
  });
}

const build = (targets) => run('cmake', ['--build', tree, '--target', ...targets]);

/// One process for each processor, each with its share of the cases.
async function passes(test) {
  const shards = os.cpus().length;
  const codes = await Promise.all(Array.from({ length: shards }, (_, shard) =>
    run(path.join(tree, 'tests', `test_${test}`), ['--gtest_brief=1', '--gtest_fail_fast'], {
      env: { GTEST_TOTAL_SHARDS: `${shards}`, GTEST_SHARD_INDEX: `${shard}` },
      limit: testLimitMs })));
  return codes.every((code) => code === 0);
}

async function judge(mutant) {
  spoil(mutant);
  try {
    for (const test of mutant.tests) {
      if (await build([`test_${test}`]) !== 0) return 'does not compile';
      if (!await passes(test)) return `killed by ${test}`;
    }
    return 'survived';
  } finally {
    restore(mutant);
  }
}

const cell = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

function writeTable(rows) {
  const text = rows.map(({ file, line, before, after, outcome }) =>
    [file, line, before, after, outcome].map((value) => cell(`${value}`)).join(','));
  fs.writeFileSync(path.join(root, 'results/mutants.csv'),
    `file,line,before,after,outcome\n${text.join('\n')}\n`);
}

async function prepare(mutants) {
  if (await run('cmake', ['--preset', 'release', '-DTRESS_WERROR=OFF',
    '-DTRESS_BENCHMARKS=OFF']) !== 0) {
    throw new Misfit(`configuring failed (${copy}): ./tress setup installs what is missing`);
  }
  const tests = [...new Set(mutants.flatMap((mutant) => mutant.tests))];
  console.error(`mutants: building ${tests.length} test programs in ${tree}`);
  if (await build(tests.map((test) => `test_${test}`)) !== 0) {
    throw new Misfit(`the unspoilt sources do not build (${tree}): ./tress test shows why`);
  }
  for (const test of tests) {
    if (await passes(test)) continue;
    throw new Misfit(`test_${test} fails on the unspoilt sources (${tree}): mend it first`);
  }
}

async function main(args) {
  const mutants = readMutants();
  if (args[0] === '--check') {
    console.log(`${mutants.length} mutants fit`);
    return 0;
  }
  const all = args[0] === '--all';
  const [option, pattern, ...rest] = all ? args.slice(1) : args;
  if (rest.length > 0 || (option && (option !== '--only' || !pattern))) {
    throw new Misfit(`unknown argument '${rest[0] ?? option}' (command line): ` +
      'give --all, --only PATTERN or none');
  }
  const chosen = mutants.filter(({ file, after }) => !pattern ||
    file.includes(pattern) || after.includes(pattern));
  fs.mkdirSync(copy, { recursive: true });
  const sources = copySources();
  const kept = path.join(copy, 'found.json');
  let last = {};
  try {
    if (!all) last = JSON.parse(fs.readFileSync(kept, 'utf8'));
  } catch { /* the first run */ }
  const key = ({ file, before, after }) => `${file}: ${before} -> ${after}`;
  const found = {};
  for (const mutant of mutants) {
    const before = still_true(last[key(mutant)], mutant, sources);
    if (before) found[key(mutant)] = before;
  }
  if (chosen.some((mutant) => !found[key(mutant)])) await prepare(chosen);
  for (const [index, mutant] of chosen.entries()) {
    found[key(mutant)] ??= {
      outcome: await judge(mutant),
      file: hash_of(fs.readFileSync(path.join(root, mutant.file))),
      sources,
    };
    fs.writeFileSync(kept, JSON.stringify(found, null, 1));
    console.error(`mutants: ${index + 1}/${chosen.length} ${mutant.file}:${mutant.line} ` +
      found[key(mutant)].outcome);
  }
  const rows = chosen.map((mutant) => ({ ...mutant, outcome: found[key(mutant)].outcome }));
  if (!pattern) writeTable(rows);
  const killed = rows.filter(({ outcome }) => outcome.startsWith('killed')).length;
  for (const { file, line, before, after, outcome } of rows) {
    if (!outcome.startsWith('killed')) {
      console.log(`${outcome}: ${file}:${line}\n  - ${before}\n  + ${after}`);
    }
  }
  console.log(`${killed} of ${rows.length} mutants are killed`);
  return killed >= wanted * rows.length &&
    rows.every(({ outcome }) => outcome !== 'does not compile') ? 0 : 3;
}

for (const signal of ['SIGINT', 'SIGTERM']) {
  process.on(signal, () => {
    for (const child of running) child.kill('SIGKILL');
    process.exit(130);
  });
}

main(process.argv.slice(2)).then((code) => { process.exitCode = code; }, (error) => {
  console.error(`mutants: error: ${error instanceof Misfit ? error.message : error.stack}`);
  process.exitCode = error instanceof Misfit ? 2 : 1;
});
