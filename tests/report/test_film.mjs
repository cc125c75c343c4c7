// Films of scenes: `node --test tests/report/test_film.mjs`.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fixture_directory, remove, report_root } from './support.mjs';

let directory, run;

before(() => {
  directory = fixture_directory();
  run = join(directory, 'scenes/fixture_wind.json');
});
after(() => remove(directory));

const film = (...argv) =>
  spawnSync(process.execPath, [join(report_root, 'dist/film.mjs'), ...argv], {
    encoding: 'utf8',
  });

// The fixture's wind blows for 29/40 s: at 10 pictures a second of half its speed that are
// floor(0.2 / 0.5 * 10) + 1 between 0.1 s and 0.3 s.
test('Film_HasAPictureForEveryMoment', () => {
  const range = [
    '--size',
    '320,240',
    '--scale',
    '2',
    '--rate',
    '10',
    '--speed',
    '0.5',
    '--from',
    '0.1',
  ];
  const out = join(directory, 'pictures');
  const { status, stderr } = film(run, 'colour=hair', out, ...range, '--to', '0.3');
  assert.equal(status, 0, stderr);
  assert.match(stderr, /pictures: 5 pictures$/m);
  const pictures = readdirSync(out).map((name) => readFileSync(join(out, name)));
  assert.equal(pictures.length, 5);
  for (const png of pictures)
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [320, 240]);
  assert.equal(new Set(pictures.map((png) => png.toString('base64'))).size, 5);
});

test('Film_IsWebm', () => {
  const out = join(directory, 'film.webm');
  const { status, stderr } = film(run, '', out, '--size', '160,120', '--rate', '4');
  assert.equal(status, 0, stderr);
  const bytes = readFileSync(out);
  // The EBML header, its type, the track's codec.
  assert.equal(bytes.readUInt32BE(0), 0x1a45dfa3);
  for (const text of ['webm', 'V_VP9']) assert.ok(bytes.includes(text), text);
  assert.equal(existsSync(`${out}.part`), false);
});

test('BadArguments_ExitWithTwoAndLeaveNothing', () => {
  const out = join(directory, 'none.webm');
  for (const [argv, wanted] of [
    [['none.html', '', out], /^film: none\.html: no such file/],
    [[run, '', out, '--size', '161,120'], /a film needs even numbers/],
    [[run, '', out, '--rate', 'x'], /--rate x: must be a number from 1 to 240/],
    [[run, '', join(directory, 'a/b.webm')], /its folder does not exist/],
    [[run, '', directory], /is there and no empty folder/],
    [[run, ''], /three arguments are needed/],
    [[run, '', out, '--fast'], /Unknown option '--fast'/],
  ]) {
    const { status, stderr } = film(...argv);
    assert.equal(status, 2, `${argv}: ${stderr}`);
    assert.match(stderr, wanted);
    assert.equal(stderr.trim().split('\n').length, 1, stderr);
  }
  assert.equal(existsSync(out), false);
});
