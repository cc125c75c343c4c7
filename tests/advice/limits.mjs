// Is what stability_limit --scene answers true? On random scenes, none of them shipped.
//
//   node limits.mjs FOLDER [count seed]
//
// FOLDER is that of the build. Of each of `count` scenes (12) from `seed` (101) on, every
// integrator that has a stable step at every frame is run by simulate over five times the scene's
// duration: at 0.9 times the answer it must end "ok" by whole steps, at 1.5 times end as unstable,
// or by shorter steps where the answer says so. Limits that are the longest step tried are left.
// Prints a line a scene, and the shares in the end. Exit codes: 0 at least 90 % of the limits
// hold; 3 otherwise.
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { random_scene } from './scenes.mjs';

const [folder, count = 12, first = 101] = process.argv
  .slice(2)
  .map((word, i) => (i === 0 ? path.resolve(word) : Number(word)));
if (!folder || ![count, first].every((x) => x > 0)) {
  console.error('usage: limits.mjs FOLDER [count seed]');
  process.exit(2);
}
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'tress_limits_'));
const run = (program, args) =>
  spawnSync(path.join(folder, 'experiments', program), args,
    { cwd: work, encoding: 'utf8', maxBuffer: 1 << 26 });

const seconds = { s: 1, ms: 1e-3, us: 1e-6 };
const times = 5;  // the scene's duration
/// A limit of so many steps in all runs within a minute.
const mostSteps = 2e5;

/// "X: backward_euler (tangent exact): stable up to 4.1 ms, unstable at 1.5 times that ...", or
/// "..., at 1.5 times that some step has no solution ..."
function limit_of(line) {
  const found = line.match(
    /: (\w+) \(tangent (\w+)\): stable up to ([\d.e+-]+) (s|ms|us), (unstable )?at 1\.5 times/);
  if (!found) return null;
  return { integrator: found[1], tangent: found[2], step: Number(found[3]) * seconds[found[4]],
    unstable: Boolean(found[5]) };
}

/// Whether the scene ends "ok", a frame a step, and whether by whole steps.
function stable(text, { integrator, tangent, step }, factor, file) {
  const dt = factor * step;
  const duration = times * Number(text.match(/duration_s = ([\d.]+)/)[1]);
  const changed = text
    .replace(/duration_s = .*/, `duration_s = ${duration}\nframes_1_s = ${1 / dt}`)
    .replace('[model]', `[model]\ntangent = "${tangent}"`)
    .replace(/\[integrator\][^[]*/, `[integrator]\nid = "${integrator}"\ndt_s = ${dt}\n`);
  fs.writeFileSync(path.join(work, file), changed);
  const made = run('simulate', [file, '--out', 'run.csv', '--progress', 'none']);
  if (made.status === 2) throw new Error(`${file}: ${made.stderr.trim()}`);
  const ok = made.status === 0;
  return { ok, whole: ok && !made.stderr.includes('tried again with shorter ones'),
    why: ok ? 'shorter steps' : made.stderr.trim().split('\n').at(-1) };
}

let held = 0, all = 0;
for (let seed = first; seed < first + count; seed++) {
  const { name, text } = random_scene(seed);
  const scene = `${name}_${seed}.toml`;
  fs.writeFileSync(path.join(work, scene), text);
  const answer = run('stability_limit',
    ['--scene', scene, '--progress', 'none', '--out', `${name}_${seed}.csv`]);
  if (answer.status === 2) throw new Error(`${scene}: ${answer.stderr.trim()}`);
  const duration = times * Number(text.match(/duration_s = ([\d.]+)/)[1]);
  const limits = answer.stdout.split('\n').map(limit_of)
    .filter((one) => one !== null && duration / one.step <= mostSteps);
  const faults = [];
  for (const one of limits) {
    const file = `${name}_${seed}_${one.integrator}.toml`;
    const below = stable(text, one, 0.9, file), above = stable(text, one, 1.5, file);
    const limited = one.unstable ? !above.ok : !above.whole;
    if (!below.whole) faults.push(`${one.integrator} at 0.9 of ${one.step} s: ${below.why}`);
    if (!limited) faults.push(`${one.integrator} stable at 1.5 of ${one.step} s`);
    if (below.whole && limited) ++held;
    ++all;
  }
  console.log(`${scene}: ${limits.length} limits, ${faults.length ? faults.join('; ') : 'all hold'}`);
}
fs.rmSync(work, { recursive: true });
console.log(`${held} of ${all} limits hold over ${times} times the duration`);
process.exit(all > 0 && held >= 0.9 * all ? 0 : 3);
