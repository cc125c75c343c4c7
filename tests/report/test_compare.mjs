// The comparison of two folders of results: what is equal, what is lost, what moved.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';

const program = fileURLToPath(new URL('../../experiments/report/compare.mjs', import.meta.url));

function folder(tables) {
  const path = mkdtempSync(join(tmpdir(), 'tress-compare-'));
  for (const [name, text] of Object.entries(tables)) writeFileSync(join(path, name), text);
  return path;
}
const compare = (...args) =>
  spawnSync(process.execPath, [program, ...args], { encoding: 'utf8' });

const manifest = JSON.stringify({ timings: ['wall_s'] });
const before = folder({
  'swing.csv': 'model,error,wall_s\nder,0.25,1\ncorde,0.5,2\n',
  'swing.meta.json': manifest,
});

test('timings, new columns and the sixth digit do not count; another value does', () => {
  const same = folder({
    'swing.csv': 'model,error,wall_s,scene\nder,0.2500001,7,a\ncorde,0.5,8,a\n',
    'swing.meta.json': manifest,
  });
  const equal = compare(before, same);
  assert.match(equal.stdout, /swing: 2 of 2 rows agree in 2 columns/);
  assert.equal(equal.status, 0);
  const other = folder({ 'swing.csv': 'model,error,wall_s\nder,0.251,1\ncorde,0.5,2\n' });
  const lost = compare(before, other);
  assert.match(lost.stdout, /swing: 1 of 2 rows agree/);
  assert.match(lost.stdout, /lost: der,0\.25000/);
  assert.equal(lost.status, 3);
});

test('rows are found in the table that they moved to', () => {
  const moved = folder({
    'work.csv': 'scene,model,error,wall_s\nx,der,0.25,1\nx,corde,0.5,2\ny,der,9,9\n',
    'work.meta.json': manifest,
  });
  assert.equal(compare(before, moved).status, 3);
  const found = compare(before, moved, 'swing=work');
  assert.match(found.stdout, /swing: 2 of 2 rows agree .* \(3 rows after\)/);
  assert.equal(found.status, 0);
});

test('a folder that is not there is one line and exit code 2', () => {
  const run = compare(before, '/nowhere');
  assert.match(run.stdout, /no such table/);
  const none = compare('/nowhere', before);
  assert.equal(none.status, 2);
  assert.equal(none.stderr.trim().split('\n').length, 1);
});
