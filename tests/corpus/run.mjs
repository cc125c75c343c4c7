// Bad inputs of all kinds through every program of the testbed.
//
//   node run.mjs FOLDER [--quick] [--seed N] [--unbounded]
//
// FOLDER holds the programs that its list.txt names. Each input must be refused: exit code
// 2, one line "what is wrong (where): what to do" on standard error, nothing on standard
// output, nothing written, within 10 s of processor time, a minute in all, and 2 GiB of
// address space. --unbounded lets programs have more, which sanitizers need. --quick takes
// some inputs of each kind for each program. Exit codes: 0 all are refused, 3 some are not.
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { corpus } from './cases.mjs';
import { scene } from './texts.mjs';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const processorLimit = 10;  // s
const limitMs = 60_000;
const limitKiB = 2 << 20;
const message = /^\w+: error: .+ \(.+\): .+\n$/;

function parse(argv) {
  const options = { quick: false, seed: 1, unbounded: false, folder: '' };
  for (let i = 0; i < argv.length; i++) {
    if (argv[i] === '--quick') options.quick = true;
    else if (argv[i] === '--unbounded') options.unbounded = true;
    else if (argv[i] === '--seed') options.seed = Number(argv[++i]);
    else options.folder = path.resolve(argv[i]);
  }
  if (!fs.existsSync(path.join(options.folder, 'list.txt')) || !Number.isInteger(options.seed)) {
    console.error('usage: run.mjs FOLDER [--quick] [--seed N] [--unbounded]');
    process.exit(2);
  }
  return options;
}

function make(folder, files) {
  for (const [name, what] of Object.entries(files)) {
    const file = path.join(folder, name);
    fs.mkdirSync(path.dirname(file), { recursive: true });
    fs.rmSync(file, { force: true });
    if (what === null) continue;
    if (typeof what === 'string' || Buffer.isBuffer(what)) fs.writeFileSync(file, what);
    else if (what.folder) fs.mkdirSync(file);
    else if (what.pipe) execFileSync('mkfifo', [file]);
    else fs.symlinkSync(what.link === 'itself' ? path.basename(name) : what.link, file);
  }
}

const listing = (folder) => fs.readdirSync(folder, { recursive: true }).sort().join('\n');

/// Largest resident size so far, in KiB; 0 once it is gone.
function peak(pid) {
  try {
    return Number(fs.readFileSync(`/proc/${pid}/status`, 'utf8').match(/VmHWM:\s*(\d+)/)?.[1] ?? 0);
  } catch {
    return 0;
  }
}

/// Runs a program in a folder of its own: {code, signal, hung, out, err, left, kib}.
function run({ program, args, files }, { folder, unbounded }) {
  const work = fs.mkdtempSync(path.join(os.tmpdir(), 'tress_corpus_'));
  make(work, files);
  const before = listing(work);
  const bounds = unbounded ? '' : `ulimit -v ${limitKiB} -S -t ${processorLimit}; `;
  return new Promise((resolve) => {
    const child = spawn('bash', ['-c', `ulimit -c 0; ${bounds}exec "$0" "$@"`,
      path.join(folder, program), ...args],
    { cwd: work, detached: true, stdio: ['ignore', 'pipe', 'pipe'] });
    const result = { out: '', err: '', hung: false, kib: 0 };
    child.stdout.on('data', (data) => { result.out += data; });
    child.stderr.on('data', (data) => { result.err += data; });
    const watch = setInterval(() => { result.kib = Math.max(result.kib, peak(child.pid)); }, 20);
    const timer = setTimeout(() => {
      result.hung = true;
      process.kill(-child.pid, 'SIGKILL');
    }, limitMs);
    child.on('close', (code, signal) => {
      clearInterval(watch);
      clearTimeout(timer);
      result.left = listing(work) !== before;
      fs.rmSync(work, { recursive: true });
      resolve({ ...result, code, signal });
    });
  });
}

/// Empty where the input was refused as it should be.
function fault(result, maybe) {
  if (result.hung || result.signal === 'SIGXCPU') return 'hang';
  if (result.signal || result.code >= 128) return 'signal';
  if (result.code === 1) return 'internal error';
  if (result.code !== 2) return maybe ? 'legal' : 'accepted';
  // That a machine is busy is not about the input, nor is how large a head of hair is.
  const err = result.err.replace(/^\w+: warning: the machine is busy.*\n/m, '')
    .replace(/^simulate: \w+: a head of .*\n/m, '');
  if (!message.test(err) || result.out !== '') return 'message';
  return result.left ? 'left something behind' : '';
}

/// The first line of a program's table, which it writes before it looks for what to merge.
function header(program, { folder }) {
  const { stdout } = spawnSync(path.join(folder, program),
    ['--merge', 'none_such.csv', '--out', '-'], { encoding: 'utf8' });
  if (!/,run_id\n$/.test(stdout)) throw new Error(`${program} writes no header`);
  return stdout;
}

/// Some of each kind for each program, spread over what there is.
function fewOf(all) {
  const groups = new Map();
  for (const one of all) {
    const key = `${one.program}/${one.kind}`;
    groups.set(key, [...(groups.get(key) ?? []), one]);
  }
  return [...groups.values()].flatMap((group, i) =>
    Array.from({ length: group[0].kind === 'scene' ? 4 : 1 },
      (_, k) => group[(13 * i + 37 * k) % group.length]));
}

/// {faults: [what], inputs, legal, kib}; tells each fault as it comes.
async function tryAll(cases, options) {
  const found = { faults: [], inputs: 0, legal: 0, kib: 0 };
  const refusals = new Map();  // by program and input: promises of whether it was refused
  const queue = [...cases];
  const worker = async () => {
    for (let one = queue.shift(); one; one = queue.shift()) {
      const label = `${one.kind}: ${one.name}`;
      // What another program reads may be legal and take its time.
      if (one.after && !(await refusals.get(`${one.after} ${label}`))) continue;
      const running = run(one, options);
      refusals.set(`${one.program} ${label}`,
        running.then(({ code, err }) => code === 2 && /scene\.toml:\d+:\d+/.test(err)));
      const result = await running;
      found.kib = Math.max(found.kib, result.kib);
      const what = fault(result, one.maybe);
      found[what === 'legal' ? 'legal' : 'inputs'] += 1;
      if (what === '' || what === 'legal') continue;
      found.faults.push(what);
      console.log(`${what}: ${one.program} ${one.args.join(' ').slice(0, 100)} <- ${label}: ` +
        `exit ${result.code ?? result.signal}: ${result.err.slice(0, 300).trim()}`);
    }
  };
  await Promise.all(Array.from({ length: os.availableParallelism() }, worker));
  return found;
}

const options = parse(process.argv.slice(2));
const programs = fs.readFileSync(path.join(options.folder, 'list.txt'), 'utf8').trim().split('\n');
const shipped = fs.readdirSync(path.join(root, 'scenes')).filter((name) => name.endsWith('.toml'))
  .sort().map((name) => fs.readFileSync(path.join(root, 'scenes', name), 'utf8'));
const good = await run({ program: 'effect_audit', files: { 'scene.toml': scene },
  args: ['--dry-run', '--set', 'scenes=scene.toml'] }, options);
if (good.code !== 0) throw new Error(`the scene that all are made from is refused: ${good.err}`);
const headers = Object.fromEntries(programs.filter((program) => program !== 'simulate')
  .map((program) => [program, header(program, options)]));
const all = [...corpus({ programs, shipped, headers, seed: options.seed, count: 100 })];
const { faults, inputs, legal, kib } = await tryAll(options.quick ? fewOf(all) : all, options);

const kinds = ['signal', 'hang', 'internal error', 'accepted', 'message', 'left something behind'];
const counts = kinds.map((kind) => `${faults.filter((what) => what === kind).length} ${kind}`);
console.log(`${inputs} bad inputs of ${programs.length} programs, ` +
  `${inputs - faults.length} refused as they should be; ${counts.join(', ')}; largest resident ` +
  `size seen ${(kib / 1024).toFixed(0)} MiB; ${legal} spoilt inputs were legal`);
process.exit(faults.length ? 3 : 0);
