// Is what cost_of_accuracy --advise promises true? On random scenes, none of them shipped.
//
//   node run.mjs FOLDER [count seed seconds]
//
// FOLDER is that of the build. Each of `count` scenes (12) from `seed` (1) on is advised within
// `seconds` (100). The judge runs the file as it is written over the whole scene and compares
// it with a reference of its own. Prints a line a scene, and in the end the shares of scenes
// with an answer and of answers that keep their promise. Exit codes: 0 at least 80 % have an
// answer, 95 % of these are kept and all files say what the text says; 3 otherwise.
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { random_scene } from './scenes.mjs';

const [folder, count = 12, first = 1, seconds = 100] = process.argv
  .slice(2)
  .map((word, i) => (i === 0 ? path.resolve(word) : Number(word)));
if (!folder || ![count, first, seconds].every((x) => x > 0)) {
  console.error('usage: run.mjs FOLDER [count seed seconds]');
  process.exit(2);
}
const target = 0.01, strands = 3, grace = 1.2;
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'tress_advice_'));

const judgeMs = 200_000;

const run = (program, args, timeout = 0) =>
  spawnSync(path.join(folder, program), args,
    { cwd: work, encoding: 'utf8', maxBuffer: 1 << 26, timeout });

/// Whether the advised file has the elements and the step or tolerance of the text.
function same(line, file) {
  const of = (text, pattern) => Number(text.match(pattern)?.[1]);
  const table = file.slice(file.indexOf('[integrator]'));
  const alike = (said, written) => Math.abs(said - written) <= 1e-4 * written;
  const elements = of(line, /(\d+) elements/) === of(file, /\nelements = (\d+)/);
  return elements && (line.includes(', tolerance')
    ? of(line, /tolerance ([\d.e-]+)/) === of(table, /\ntolerance = ([\d.e-]+)/)
    : alike(1e-3 * of(line, /dt ([\d.e-]+) ms/), of(table, /\ndt_s = ([\d.e-]+)/)));
}

/// What was said about one scene, and whether it is true.
function judged(seed) {
  const { name, text } = random_scene(seed);
  const scene = `${name}_${seed}.toml`;
  fs.writeFileSync(path.join(work, scene), text);
  const start = process.hrtime.bigint();
  const advice = run('experiments/cost_of_accuracy',
    ['--advise', scene, '--out', `${name}_${seed}.csv`, '--progress', 'none',
      '--set', `answer_s=${seconds}`]);
  const took = Number(process.hrtime.bigint() - start) / 1e9;
  const line = advice.stdout.split('\n')[0] || advice.stderr.trim();
  const made = { scene, took, line, verdict: 'no promise', files: true };
  if (took > grace * seconds) return { ...made, verdict: 'late' };
  if (!line.startsWith('take ')) return made;
  const file = `${name}_${seed}.advised.toml`;
  made.files = same(line, fs.readFileSync(path.join(work, file), 'utf8'));
  const judge = run('tests/advice_judge', [scene, file, String(strands)], judgeMs);
  if (judge.status !== 0) {
    return { ...made, verdict: `not judged: ${judge.stderr.trim() || 'takes too long'}` };
  }
  const [error, doubt] = judge.stdout.split(' ').map(Number);
  made.line = `${(100 * error).toPrecision(2)} % (doubt ${(100 * doubt).toPrecision(1)} %): ${line}`;
  if (error <= target) return { ...made, verdict: 'kept' };
  return { ...made, verdict: error > target + doubt ? 'BROKEN' : 'not judged: reference' };
}

const all = [];
for (let seed = first; seed < first + count; seed++) {
  all.push(judged(seed));
  const { scene, took, line, verdict, files } = all.at(-1);
  console.log(`${scene}: ${took.toFixed(0)} s, ${verdict}${files ? '' : ', FILE DIFFERS'}: ${line}`);
}
fs.rmSync(work, { recursive: true });
const some = (verdict) => all.filter((one) => one.verdict.startsWith(verdict)).length;
const kept = some('kept'), broken = some('BROKEN'), answers = kept + broken + some('not judged');
const differ = all.filter((one) => !one.files).length;
const times = all.map((one) => one.took).sort((a, b) => a - b);
console.log(`${answers} of ${count} scenes have an answer; ${kept} promises kept, ${broken} ` +
  `broken, ${some('not judged')} not judged; ${differ} files differ from the text; median ` +
  `${times[Math.floor(count / 2)].toFixed(0)} s`);
const good = answers >= 0.8 * count && kept >= 0.95 * (kept + broken) && differ === 0;
process.exit(good ? 0 : 3);
