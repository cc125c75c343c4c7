// Every file that the report reads, spoilt in every way: a warning of one line and a gap on
// the page, never a stack trace. `node --test tests/report/test_bad_input.mjs`.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { after, before, test } from 'node:test';
import { run } from '../../experiments/report/src/command.mjs';
import { known_tables } from '../../experiments/report/src/tables.mjs';
import { empty_directory, fixture_directory, remove, run_report } from './support.mjs';

let fixture, directory;
before(() => {
  fixture = fixture_directory();
});
after(() => remove(fixture));

const template =
  '<!--TRESS_BODY--><script id="program"></script><!--TRESS_DATA--><!--TRESS_SCENES-->';

// The command in this process, without figures; the page stays in `directory`.
async function report(path = directory) {
  const said = [];
  const status = await run([path, '--no-figures'], {
    template: () => template,
    say: (line) => said.push(line),
  });
  for (const line of said) assert.doesNotMatch(line, /\n|\bat .*:\d+:\d+/, 'one line');
  const file = join(path, 'report.html');
  const page = existsSync(file) ? readFileSync(file, 'utf8') : undefined;
  return { status, page, warnings: said.filter((line) => line.includes('warning:')) };
}

// A directory with one table that can always be drawn, for `check`.
async function in_directory(check) {
  directory = empty_directory();
  writeFileSync(join(directory, 'good.csv'), 'a,b\n1,2\n');
  try {
    return await check();
  } finally {
    remove(directory);
  }
}

const deep = '['.repeat(2e4) + ']'.repeat(2e4);
// What no reader of text or JSON may stumble over.
const contents = {
  empty: '',
  blank: ' \n\n',
  null: 'null',
  number: '-1',
  text: '"text"',
  array: '[]',
  object: '{}',
  array_of_null: '[null]',
  nan: 'NaN',
  truncated: '{"checks": [{"cla',
  deep,
  deep_object: `{"checks": ${deep}, "glossary": ${deep}}`,
  long_line: 'x'.repeat(2e6),
  many_commas: ','.repeat(5e4),
  open_quote: 'a,b\n"1,2\n',
  byte_order_mark: '\uFEFF{}',
  utf16: Buffer.from('\uFEFFa,b\n1,2\n', 'utf16le'),
  latin1: Buffer.from('a,b\n\xe4,1\n', 'latin1'),
  binary: Buffer.from(Array.from({ length: 4096 }, (_, k) => (k * 197) % 256)),
  nul: 'a,b\n\0,1\n',
};

// What may stand at `path`: those contents, or no file at all.
const makers = {
  ...Object.fromEntries(
    Object.entries(contents).map(([name, data]) => [name, (path) => writeFileSync(path, data)]),
  ),
  folder: (path) => mkdirSync(path),
  pipe: (path) => assert.equal(spawnSync('mkfifo', [path]).status, 0),
};

for (const [what, make] of Object.entries(makers)) {
  test(`EveryFile_MayBe_${what}`, () =>
    in_directory(async () => {
      mkdirSync(join(directory, 'scenes'));
      make(join(directory, 'validation.csv'));
      make(join(directory, 'good.meta.json'));
      make(join(directory, 'scenes', 'a.json'));
      const { status, page, warnings } = await report();
      assert.equal(status, 0);
      assert.match(page, /good\.csv/);
      // No content at all is both a table and a scene.
      for (const file of ['validation.csv', 'scenes/a.json']) {
        const of = warnings.filter((line) => line.includes(join(directory, file)));
        assert.equal(of.length, 1, `${file}: ${warnings}`);
        assert.match(of[0], /; .*(remove|again|write)/, 'names a remedy');
      }
      assert.ok(!page.includes(directory), 'the page names no folder of this machine');
      assert.equal((page.match(/Not everything could be used/g) ?? []).length, 1);
    }));
}

test('OnlyBadFiles_ExitWithTwoAndWriteNothing', async () => {
  directory = empty_directory();
  writeFileSync(join(directory, 'validation.csv'), 'null');
  const { status, page } = await report();
  assert.equal(status, 2);
  assert.equal(page, undefined);
  remove(directory);
});

test('ScenesAsAFile_IsAWarning', () =>
  in_directory(async () => {
    writeFileSync(join(directory, 'scenes'), '');
    const { status, warnings } = await report();
    assert.equal(status, 0);
    assert.match(warnings[0], /scenes: not a readable folder/);
  }));

test('TableNames_MayBeThoseOfObjectsMembers', () =>
  in_directory(async () => {
    for (const name of ['constructor', '__proto__', 'toString', 'glossary', 'a"<b'])
      writeFileSync(join(directory, `${name}.csv`), '__proto__,constructor\n1,2\n');
    const { status, page, warnings } = await report();
    assert.equal(status, 0);
    assert.deepEqual(warnings, []);
    for (const name of ['constructor', '__proto__', 'toString', 'glossary', 'a&quot;&lt;b'])
      assert.ok(page.includes(`data-table="${name}"`), name);
  }));

test('EmptySource_IsAScene', () =>
  in_directory(async () => {
    mkdirSync(join(directory, 'scenes'));
    const scene = JSON.parse(
      readFileSync(join(fixture, 'scenes', 'fixture_wind.json'), 'utf8'),
    );
    Object.assign(scene, { source: '', title: '' });
    writeFileSync(join(directory, 'scenes', 'a.json'), JSON.stringify(scene));
    const { status, page, warnings } = await report();
    assert.equal(status, 0);
    assert.deepEqual(warnings, []);
    assert.match(page, /data-scene="fixture_wind"/);
  }));

test('Checks_MayHaveAnyStateAndNoShape', () =>
  in_directory(async () => {
    const checks = [
      null,
      [],
      3,
      {},
      { claim: 'old and held', held: true, value: 1 },
      { claim: 'old and not', held: false, value: 2 },
      { claim: 'new and held', held: true, state: 'held' },
      { claim: 'a limit', held: false, state: 'known_limit', value: 0.04, reason: 'so <it> is' },
      { claim: 'another', held: false, state: 'changed', value: 3 },
      { claim: 'a later word', state: 'postponed' },
      { claim: ['<b>'], state: { a: 1 }, value: {} },
    ];
    const not_judged = [{ claim: 'was not run', reason: 'no rows' }, null];
    const figures = [{ figure: 'a ratio', value: 3.5 }, 7];
    writeFileSync(
      join(directory, 'good.meta.json'),
      JSON.stringify({ checks, not_judged, figures }),
    );
    const { page, warnings } = await report();
    assert.deepEqual(warnings, []);
    assert.match(
      page,
      /good: 2 of 8 claims .* held, changed: 1, known limit: 1, not judged: 1, figure: 1, postponed: 1/,
    );
    assert.match(page, /Did not hold: old and not \(measured 2\)/);
    assert.match(page, /Known limit: a limit \(measured 0\.04\): so &lt;it&gt; is/);
    assert.match(page, /Changed: another \(measured 3\)/);
    assert.match(page, /Not judged: was not run: no rows/);
    assert.match(page, /Figure: a ratio \(measured 3\.5\)/);
    assert.match(page, /postponed: a later word/);
    writeFileSync(
      join(directory, 'good.meta.json'),
      JSON.stringify({ checks: 5, not_judged: {}, figures: 'x' }),
    );
    assert.deepEqual((await report()).warnings, []);
  }));

// Values that a broken run may leave: every number the same, every text the same.
const values = ['-1', '0', '', 'nan', 'inf', '1e308', '5e-324', '1'];
const texts = ['', '7', 'ok', 'constructor', 'x'.repeat(500)];

const split = (text) =>
  text
    .trimEnd()
    .split('\n')
    .map((line) => line.split(','));
const joined = (rows) => `${rows.map((row) => row.join(',')).join('\n')}\n`;

// Some 60 rows of all kinds: enough for what breaks, few enough for hundreds of pages.
const thinned = ([head, ...body]) => {
  const stride = Math.ceil(body.length / 60);
  return [head, ...body.filter((_, k) => k % stride === 0)];
};

// Tables of the fixture, quotes taken off so that a row splits at its commas.
const tables_of = () =>
  readdirSync(fixture)
    .filter((file) => file.endsWith('.csv'))
    .map((file) => basename(file, '.csv'))
    .filter((name) => Object.hasOwn(known_tables, name))
    .map((name) => {
      const text = readFileSync(join(fixture, `${name}.csv`), 'utf8');
      return [name, thinned(split(text.replace(/"[^"]*"/g, 'quoted')))];
    });

function* spoilt(name, [head, ...body]) {
  const { required, numeric } = known_tables[name];
  const is = (list) => head.map((column) => list.includes(column));
  const number = is(numeric);
  const text = head.map((column, i) => !number[i] && column !== 'status');
  const with_value = (chosen, value) => [
    head,
    ...body.map((row) => row.map((field, i) => (chosen[i] ? value : field))),
  ];
  for (const value of values) yield [`numbers ${value}`, with_value(number, value)];
  for (const value of texts)
    yield [`texts ${value.slice(0, 20)}`, with_value(text, value)];
  yield ['every field -1', with_value(head.map(() => true), '-1')];
  const kept = is(required);
  const only = (row) => row.filter((_, i) => kept[i]);
  yield ['required columns only', [head, ...body].map(only)];
  yield ['no rows', [head]];
  yield ['one row', [head, body[0]]];
  yield ['one failed row', [head, body[0].map((f, i) => (head[i] === 'status' ? 'x' : f))]];
  yield ['rows twice', [head, ...body, ...body]];
}

test('KnownTables_MayHoldAnyValues', () =>
  in_directory(async () => {
    const complaints = [];
    for (const [name, rows] of tables_of()) {
      for (const [what, changed] of spoilt(name, rows)) {
        writeFileSync(join(directory, `${name}.csv`), joined(changed));
        const { status, warnings } = await report();
        assert.equal(status, 0, `${name}, ${what}`);
        complaints.push(...warnings.map((line) => `${name}, ${what}: ${line}`));
      }
      remove(join(directory, `${name}.csv`));
    }
    assert.deepEqual(complaints, []);
  }));

test('FiguresThatCannotBeWritten_LeaveThePage', () =>
  in_directory(async () => {
    const name = 'validation';
    writeFileSync(
      join(directory, `${name}.csv`),
      readFileSync(join(fixture, `${name}.csv`)),
    );
    mkdirSync(join(directory, `${name}.svg`));
    const { status, stderr } = run_report(directory);
    assert.equal(status, 0, stderr);
    assert.match(stderr, /warning: .*cannot write validation\.svg; .*--no-figures/);
    assert.ok(existsSync(join(directory, 'report.html')));
    assert.ok(existsSync(join(directory, 'validation_tests.svg')));
  }));
