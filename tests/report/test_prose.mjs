// The pages made from templates and tables: `node --test tests/report/test_prose.mjs`.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { must, number, percent, range, row_of, table, time } from '../../experiments/report/prose/markdown.mjs';
import { account } from '../../experiments/report/prose/account.mjs';
import { literals } from '../../experiments/report/prose/literals.mjs';
import {
  answers,
  is_manual,
  results_in_manual,
  untraced_literals,
  written_pages,
} from '../../experiments/report/prose/pages.mjs';
import { snapshot } from '../../experiments/report/prose/queries/catalogue.mjs';
import { unit_of } from '../../experiments/report/prose/queries/columns.mjs';
import { provenance } from '../../experiments/report/prose/queries/machine.mjs';
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

test('every number and number word of every page and text has a query, or a reason', () => {
  const all = account(root);
  assert.deepEqual(all.flatMap(({ problems }) => problems), []);
  for (const { page, slots, tables } of all)
    assert.ok(slots > 0 || tables.length === 0, `${page}: tables without a query`);
});

test('no page of the repository escapes the account', (t) => {
  const counted = new Set(account(root).map(({ page }) => page));
  const { status, stdout } = spawnSync('git', ['ls-files', '*.md'], { cwd: root, encoding: 'utf8' });
  if (status !== 0) return t.skip('no git checkout');
  const pages = stdout.trim().split('\n');
  const missing = pages.filter(
    (page) => !counted.has(page) && !page.startsWith('docs/templates/') && !is_manual(page),
  );
  // The program prints this one, and a test compares it.
  return assert.deepEqual(missing, ['scenes/README.md']);
});

test('pages of the manual state no results', () => {
  assert.deepEqual(results_in_manual('a.md', 'An error of 1 %, in 4.2 ms.\n```text\n3 ms\n```\nBy 47 %.'), [
    "a.md:1: '4.2 ms' may be a result; compute it on a page made from a template",
    "a.md:5: '47 %' may be a result; compute it on a page made from a template",
  ]);
  const found = readdirSync(join(root, 'docs'), { recursive: true })
    .map((name) => `docs/${name}`)
    .filter((page) => page.endsWith('.md') && is_manual(page));
  assert.ok(found.length > 20, `${found.length} pages of the manual`);
  for (const page of [...found, 'CHANGELOG.md'])
    assert.deepEqual(results_in_manual(page, readFileSync(join(root, page), 'utf8')), []);
});

test('number words are found, and grammar is not', () => {
  const words = (text) => untraced_numbers(text).map((one) => one.text);
  assert.deepEqual(words('A step costs some three times that of a helix.'), ['some', 'three']);
  assert.deepEqual(words('Rods need a quarter of the elements, less than half the time.'), ['a quarter', 'half']);
  assert.deepEqual(words('It is twice as fast; most of the runs fail, nearly all hairs hold.'), [
    'twice', 'most of the runs', 'nearly',
  ]);
  assert.deepEqual(words('it takes about {{ a.b }} minutes'), ['about']);
  assert.deepEqual(words('it turns about the axis, at most, at the most, with some friction'), []);
  assert.deepEqual(words('the default of the third argument in double precision'), []);
  assert.deepEqual(words('<!-- inputs: the scene -->\n3 m, half\n<!-- end of inputs -->\nthen 4 m'), ['4']);
  assert.deepEqual(words('<!-- inputs: -->\n3 m\n<!-- end of inputs -->'), ['3'], 'a region has a reason');
});

test('texts of sources are read with their slots, and code and comments are not', () => {
  const source =
    "// don't\nconst a = `takes ${b > 2 ? `about ${n} s` : ''} of \\`x2\\` half`;\n" +
    'const r = /[\'"`]/; const name = \'wall_1pct_s\'; const d = "Young\'s modulus";\n';
  assert.deepEqual(
    literals(source).map(({ line, text }) => [line, text]),
    [[2, 'takes {{ }} of `x2` half'], [2, 'about {{ }} s'], [3, "Young's modulus"]],
  );
  assert.deepEqual(untraced_literals('a.mjs', source).map((text) => text.split(' ')[1]), ["'half'", "'about'"]);
});

test('a page ends with the commits of the tables that it read', () => {
  const made = written_pages(root).find(({ page }) => page === 'experiments/hard_cases/README.md');
  assert.ok(made.tables.includes('hard_cases'));
  assert.match(made.text, /\nTables behind this page, from .*`hard_cases`.* at commit [0-9a-f]{7}.*\.\n$/);
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
  assert.match(say('peers_table'), /is missing/);
  const peers = [
    { peer: 'MuJoCo', method: 'ball', status: 'ok', dt_s: 1e-3, wall_s: 0.2, total_error_rel: 0.009 },
    { peer: 'ODE', method: 'step', status: 'unstable', dt_s: 1e-2, wall_s: 0.1, total_error_rel: null },
  ];
  assert.match(say('total_table', { peers }), /\| MuJoCo \| 100 ms \| 100 ms \| 100 ms \| 0\.9 %/);
  assert.doesNotMatch(say('total_table', { peers }), /ODE/);
  const links = peers.map((row) => ({ ...row, version: '1', elements: 20 }));
  assert.match(
    say('peers_table', { peers: links }),
    /\| MuJoCo 1, ball \| 100 ms \(1 ms\) \| .* \| 0\.9 % at 1 ms \|\n\| ODE 1, step \| never .* unstable/,
  );
  assert.match(say('flight_missing'), /no flight of `xpbd`, .*`vbd`/);
  const validation = [{ test: 'free_flight', model: 'corde', integrator: 'vbd', dt_s: 1e-3,
    status: 'ok', energy_change_rel: -0.02, angular_error_rel: 0.01 }];
  assert.match(say('flight_table', { validation }), /`vbd` \| `corde` \| -2 %, 1 %/);
  assert.doesNotMatch(say('flight_missing', { validation }), /`vbd`,/);
});

// What a query says of small tables.
const say_of = (tables) => (query) => answers(tables, root)(query);

test('a denominator counts what could have come out otherwise', () => {
  const run = (dt_s, outcome, more) => ({ case: 'cone', model: 'der', integrator: 'rk4', dt_s, outcome, error_rel: 0.1, ...more });
  const hard_cases = [
    run(1e-3, 'unstable'), run(1e-2, 'stable'),
    run(1e-3, 'stable', { model: 'corde' }), run(1e-2, 'stable', { model: 'corde' }),
    // One step, and one that is left of two: neither can break at the shorter.
    run(1e-3, 'stable', { integrator: 'bdf2' }),
    run(1e-3, 'refused', { model: 'xpbd' }), run(1e-2, 'stable', { model: 'xpbd' }),
  ];
  assert.equal(say_of({ hard_cases })('hard.broken_at_shorter_count'), '1 of 2 (50 %)');
  const grazing = (name, more) => run(1e-3, 'unstable', { case: name, ...more });
  const contact = [
    grazing('grazing_contact'), grazing('grazing_exact', { outcome: 'stable' }),
    grazing('grazing_contact', { integrator: 'bdf2' }), grazing('grazing_exact', { integrator: 'bdf2', outcome: 'refused' }),
  ];
  assert.equal(say_of({ hard_cases: contact })('hard.rising_count'), '1 of 1');
  const compared = [run(1e-2, 'stable'), run(1e-2, 'stable and accurate', { case: 'a' }), run(1e-2, 'stable', { case: 'b', error_rel: null })];
  assert.match(
    say_of({ hard_cases: compared, validation: [{ model: 'der' }] })('newest.survived_table'),
    /\| `rk4` \| 10 ms \| 3 \| 2 \| 1 \| 50 % \|/,
  );
  // Chains and particles are no strand models.
  assert.match(
    say_of({ hard_cases: [...compared, run(1e-2, 'stable', { model: 'tinkertoys' })], validation: [{ model: 'der' }] })('newest.survived_table'),
    /\| `rk4` \| 10 ms \| 3 \|/,
  );
});

test('a tie is no win, and winners say how near the edge they are', () => {
  const row = { target_error_rel: 0.01, wall_s_per_sim_s: 1, status: 'ok', model: 'der', elements: 5, dt_s: 1e-3 };
  const winner = { ...row, kind: 'winner', integrator: 'esdirk43', error_rel: 0.009, error_neighbours_rel: 0.013, tolerance: 1, margin: 1.3 };
  const tables = {
    cost_of_accuracy: [
      { ...winner, scene: 'a' },
      { ...winner, scene: 'b', error_neighbours_rel: 0.0095, mean_step_s: 0.002 },
      { ...row, kind: 'runner_up', scene: 'a', integrator: 'tr_bdf2', tied: 'true', cost_factor: 1.02 },
      { ...row, kind: 'runner_up', scene: 'b', integrator: 'tr_bdf2', tied: 'false', cost_factor: 2 },
    ],
  };
  const say = say_of(tables);
  assert.equal(say('cost.winning_integrators'), '`esdirk43` on 1 of 2 scenes (and tied on 1)');
  assert.equal(say('cost.winning_models'), '`der` on 2 of 2 scenes', 'a tie between methods of one model is its win');
  assert.match(say('cost.nominal'), /1 of 2 winners exceed 1 %, by up to 1\.3 %/);
  assert.match(say('cost.step_rule'), /2 of these 2 winners adapt/);
  assert.match(say('cost.winners_table'), /adaptive \(tolerance 1, mean step 2 ms\) \| 0\.9 %, 0\.95 %/);
});

test('engines are not compared at the floor of their links', () => {
  const row = { peer: 'p', version: '1', method: 'm', elements: 20, status: 'ok' };
  const peers = [
    { ...row, dt_s: 1e-3, wall_s: 0.2, total_error_rel: 0.015 },
    { ...row, dt_s: 1e-5, wall_s: 20, total_error_rel: 0.00998 },
  ];
  const lines = say_of({ peers })('newest.peers_table').split('\n');
  assert.doesNotMatch(lines[0], /within 1 %/);
  assert.match(lines[2], /\| 1 % at 10 µs \|$/);
  assert.match(say_of({ peers })('newest.peers_confirm'), /a target below 2 % compares meshes/);
});

test('values below what is printed, given parameters and signs are shown as they are', () => {
  const cell = { test: 'impact', model: 'der', elements: 10, status: 'ok', judged: 'true', passed: 'true', error_rel: 2e-16, tolerance: 1e-6 };
  const matrix = say_of({ validation: [cell] })('validation.matrix');
  assert.match(matrix, /\| 1e-4 \| 2e-14 \|/);
  const partly = say_of({ validation: [cell, { ...cell, status: 'refused', error_rel: null }] });
  assert.match(partly('validation.matrix'), /2e-14 \(in part\)/);
  assert.match(partly('validation.scores_table'), /\| der \| 1 \| 1 \| impact \|/);
  const calibrate = [{ data: 'a_b', signal: 's', fit: 'gamma', integrator: 'bdf2', status: 'ok',
    internal_friction_kg_m3_s: 1e-10, internal_friction_low_kg_m3_s: 9e-11, internal_friction_high_kg_m3_s: 1.1e-10,
    drag_kg_m_s: 2e-5, drag_low_kg_m_s: null, drag_high_kg_m_s: null }];
  assert.match(say_of({ calibrate })('friction.fits_table'), /\| 1 \[0\.9, 1\.1\] \| 2 \(given\) \|/);
  const lost = (dt_s, energy_lost_rel, status = 'ok') => ({ model: 'der', integrator: 'e', dt_s, energy_lost_rel, status });
  assert.match(
    say_of({ damping: [lost(1e-3, 0.13), lost(4e-3, 0.09), lost(0.016, null, 'unstable')] })('damping.not_monotone'),
    /loses 9 % at 4 ms and 13 % at 1 ms, and is unstable at 16 ms/,
  );
});

test('tables of several commits and loaded machines are named', () => {
  const made = mkdtempSync(join(tmpdir(), 'tress-made-'));
  const manifest = (commit, load) => JSON.stringify({ quick: true, git: { commit, dirty: false }, timings: ['wall_s'],
    start: '2026-01-01T00:00:00Z', end: '2026-01-01T00:01:00Z', sundials_speed_ratio: 1,
    machine: { cpu: 'X', cpus: 2, load_before: [load, 0, 0], load_after: [1, 0, 0] } });
  try {
    mkdirSync(join(made, 'results'));
    writeFileSync(join(made, 'results/a.meta.json'), manifest('aaaaaaaaaa', 0.1));
    writeFileSync(join(made, 'results/b.meta.json'), manifest('aaaaaaaaaa', 0.1));
    const say = (query) => answers({}, made)(`machine.${query}`);
    assert.equal(say('one_run'), 'The 2 tables of `./tress run` come from commit aaaaaaa');
    assert.equal(provenance(['a', 'b', 'c'], made), 'Tables behind this page, from `a`, `b` at commit aaaaaaa.');
    writeFileSync(join(made, 'results/b.meta.json'), manifest('bbbbbbbbbb', 2.8));
    assert.match(say('one_run'), /come from 2 commits, not from one run \(1 from aaaaaaa, 1 from bbbbbbb\)/);
    assert.match(say('made_table'), /`b` \| bbbbbbb .* 2\.8, 1 \| 1 \| uncertain \|/);
    assert.match(provenance(['a', 'b'], made), /from 2 commits, not one run: .*`b` \(times uncertain: loaded machine\) at commit bbbbbbb/);
  } finally {
    rmSync(made, { recursive: true });
  }
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
