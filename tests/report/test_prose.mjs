// The pages made from templates and tables: `node --test tests/report/test_prose.mjs`.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { must, number, percent, range, row_of, table, time } from '../../experiments/report/prose/markdown.mjs';
import { answers, written_pages } from '../../experiments/report/prose/pages.mjs';
import { snapshot } from '../../experiments/report/prose/queries/catalogue.mjs';
import { unit_of } from '../../experiments/report/prose/queries/columns.mjs';
import { names_of } from '../../experiments/report/prose/queries/python.mjs';
import { citations, match, works } from '../../experiments/report/prose/queries/references.mjs';
import { fill, untraced_numbers } from '../../experiments/report/prose/template.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
const command = join(root, 'experiments/report/prose/prose.mjs');

test('every page says what templates and tables say', () => {
  for (const { page, text } of written_pages(root)) {
    assert.equal(readFileSync(join(root, page), 'utf8'), text, `${page}: run ./tress report`);
  }
});

test('a citation is authors, years and a place', () => {
  assert.deepEqual(citations('Bergou et al. 2008, 2010'), [
    { authors: 'Bergou et al.', year: '2008', place: '' },
    { authors: 'Bergou et al.', year: '2010', place: '' },
  ]);
  assert.deepEqual(citations(' van der Heijden &  Thompson 2000: closed form'), [
    { authors: 'van der Heijden & Thompson', year: '2000', place: 'closed form' },
  ]);
  assert.deepEqual(citations('Newton'), []);
});

test('every source has a line, once, with all places that cite it', () => {
  const list = answers({}, root)('references.list');
  const lines = list.split('\n').filter((line) => line.startsWith('| Chung'));
  assert.equal(lines.length, 1, 'Chung-Hulbert is Chung, Hulbert');
  assert.match(lines[0], /1993 .*`integrators\/generalized_alpha.cpp`/);
  assert.match(list, /Baraff 1996 .*`models\/catalogue.cpp`.*`models\/maximal\/mass_spring.cpp`/);
  assert.match(list, /\| Swope et al\. 1982 \| W\. C\. Swope, .*J\. Chem\. Phys\. 76, 637-649 \|/);
});

test('a citation has its publication, and a publication its citation', () => {
  const known = works('# comment\nKutta 1901\tW. Kutta: Beitrag\n');
  assert.deepEqual([...known], [['Kutta 1901', 'W. Kutta: Beitrag']]);
  match(['Kutta 1901'], known);
  assert.throws(() => match(['Kutta 1901', 'Heun 1900'], known), /nothing stands there for Heun 1900/);
  assert.throws(() => match([], known), /nothing cites Kutta 1901/);
  assert.throws(() => works('Kutta 1901\n'), /references\.txt:1: expected/);
});

test('newest methods: other simulators and flights count where the tables have them', () => {
  const swing = { scene: 'swing', status: 'ok', block: 1 };
  const tables = {
    block_descent: [{ ...swing, integrator: 'vbd', model: 'mass_spring', dt_s: 1e-3, sweeps: 4,
      error_rel: 0.04, wall_s_per_sim_s: 0.5 }],
    validation: [],
  };
  const say = (query, more = {}) => answers({ ...tables, ...more }, root)(`newest.${query}`);
  assert.match(say('total_table'), /\| vbd \| 500 ms \| 500 ms \| never \| 4 % in 500 ms/);
  assert.match(say('peers_table'), /is not there/);
  const peers = [
    { peer: 'MuJoCo', method: 'ball', status: 'ok', dt_s: 1e-3, wall_s: 0.2, total_error_rel: 0.009 },
    { peer: 'ODE', method: 'step', status: 'unstable', dt_s: 1e-2, wall_s: 0.1, total_error_rel: null },
  ];
  assert.match(say('total_table', { peers }), /\| MuJoCo \| 100 ms \| 100 ms \| 100 ms \| 0\.9 %/);
  assert.doesNotMatch(say('total_table', { peers }), /ODE/);
  const links = peers.map((row) => ({ ...row, version: '1', elements: 20 }));
  assert.match(
    say('peers_table', { peers: links }),
    /\| MuJoCo 1, ball \| 100 ms \(1 ms\) \| .* \| 0\.9 % \|\n\| ODE 1, step \| never .* comes apart/,
  );
  assert.match(say('flight_missing'), /no flight of `xpbd`, .*`vbd`/);
  const validation = [{ test: 'free_flight', model: 'corde', integrator: 'vbd', dt_s: 1e-3,
    status: 'ok', energy_change_rel: -0.02, angular_error_rel: 0.01 }];
  assert.match(say('flight_table', { validation }), /`vbd` \| `corde` \| -2 %, 1 %/);
  assert.doesNotMatch(say('flight_missing', { validation }), /`vbd`,/);
});

test('the README fits on three screens', () => {
  const lines = readFileSync(join(root, 'README.md'), 'utf8').split('\n');
  assert.ok(lines.length <= 151, `${lines.length} lines`);
});

test('a number that nobody computed is found, with its line', () => {
  const found = untraced_numbers('one step\nholds 19 of 22 cases\n');
  assert.deepEqual(found, [
    { line: 2, text: '19' },
    { line: 2, text: '22' },
  ]);
});

test('slots, code, links and what is allowed are no such numbers', () => {
  const template =
    'a hair of 10 cm, {{ hard.cases }} cases, `--elements 5`, [page](a1.md)\n```\nrun 2\n```\n';
  assert.deepEqual(untraced_numbers(template), []);
});

test('what is allowed does not hide a number beside it', () => {
  assert.equal(untraced_numbers('a hair of 10 cm hangs 3 mm\n')[0].text, '3');
  assert.equal(untraced_numbers('order 2 takes 258 steps\n')[0].text, '258');
  assert.equal(untraced_numbers('21 % off\n').length, 1);
});

test('an unknown query and a broken one name file and line', () => {
  const answer = answers({}, root);
  assert.throws(() => fill('\n{{ hard.nothing }}', 'a.md', answer), /a\.md:2: .*no such query/);
  assert.throws(() => fill('{{ hard.cases }}', 'a.md', answer), /a\.md:1: .*hard_cases\.csv/);
});

test("a unit stands at the end of a column's name", () => {
  const found = ['dt_s', 'drag_kg_m_s', 'density_kg_m3', 'natural_1_m', 'steps', 's'];
  assert.deepEqual(found.map(unit_of), ['s', 'kg/(m s)', 'kg/m³', '1/m', '', '']);
});

test('names of Python are found with what is said of them', () => {
  const source = [
    'def _own():', '    """None of yours."""', 'def far(', '    a,', '    b=1,', '):',
    '    """Says', '', '      more."""', 'class Thing(Base):', '    """A thing."""', '',
    '    def __init__(self):', '        pass', '    @property', '    def size(self):',
    '        """m."""', '    def grow(self, by):', '        return by', '', 'def last():',
  ]; // prettier-ignore
  assert.deepEqual(names_of(source.join('\n')), [
    { name: 'far', signature: 'far(a, b=1)', text: 'Says\n\n  more.', owner: undefined },
    { name: 'Thing', signature: 'Thing', text: 'A thing.', owner: undefined },
    { name: 'size', signature: 'size', text: 'm.', owner: 'Thing' },
    { name: 'grow', signature: 'grow(by)', text: '', owner: 'Thing' },
    { name: 'last', signature: 'last()', text: '', owner: undefined },
  ]);
});

test('a sentence whose condition failed is not printed', () => {
  assert.throws(() => must(false, 'A wins everywhere'), /"A wins everywhere"/);
});

test('rows are selected by value, and one row must be one', () => {
  const tables = { t: [{ n: 0.1, x: 1 }, { n: 0.2, x: 2 }] };
  assert.equal(row_of(tables, 't', { n: 0.1 + 1e-12 }).x, 1);
  assert.throws(() => row_of(tables, 't', {}), /2 rows/);
});

test('the command writes pages, checks them, and refuses numbers typed by hand', () => {
  const made = mkdtempSync(join(tmpdir(), 'tress-prose-'));
  const run = (...argv) => spawnSync(process.execPath, [command, ...argv, made], { encoding: 'utf8' });
  try {
    mkdirSync(join(made, 'docs/templates/studies'), { recursive: true });
    mkdirSync(join(made, 'results'));
    writeFileSync(join(made, 'docs/templates/README.md'), '# strands\n');
    assert.equal(run('--check').status, 3);
    assert.equal(run().status, 0);
    assert.equal(run('--check').status, 0);
    writeFileSync(join(made, 'README.md'), readFileSync(join(made, 'README.md'), 'utf8') + 'more\n');
    const changed = run('--check');
    assert.equal(changed.status, 3);
    assert.match(changed.stderr, /^README\.md:3: says "more"/);
    writeFileSync(join(made, 'docs/templates/README.md'), 'holds 19 cases\n');
    const typed = run();
    assert.equal(typed.status, 2);
    assert.match(typed.stderr, /docs\/templates\/README\.md:1: '19' is typed by hand/);
  } finally {
    rmSync(made, { recursive: true });
  }
});

test('values are written in few digits', () => {
  assert.equal(number(0.012345), '0.012');
  assert.equal(number(123.4), '123');
  assert.equal(number(1.5e-7), '1.5e-7');
  assert.equal(number(null), '');
  assert.equal(percent(0.0137), '1.4 %');
  assert.equal(time(0.0083), '8.3 ms');
  assert.equal(time(6.04e-4), '604 µs');
  assert.equal(range([3, 1, 2]), '1 to 3');
  assert.equal(table(['a'], [['x|y']]), '| a |\n|---|\n| x\\|y |');
});

test('the catalogue page shows what the program lists', () => {
  const program = process.env.TRESS_PROGRAM;
  assert.ok(program, 'TRESS_PROGRAM names an experiment');
  const { stdout } = spawnSync(program, ['--list'], { encoding: 'utf8' });
  assert.equal(
    readFileSync(join(root, snapshot), 'utf8'),
    stdout,
    `${snapshot}: write it anew with ./tress report`,
  );
});
