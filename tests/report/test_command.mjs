// The report command without a browser: `node --test tests/report/test_command.mjs`.
import assert from 'node:assert/strict';
import { copyFileSync, existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { sources_hash } from '../../experiments/report/src/sources_hash.mjs';
import { parse_csv } from '../../experiments/report/src/csv.mjs';
import {
  empty_directory,
  fixture_directory,
  remove,
  report_root,
  run_page,
  run_report,
} from './support.mjs';

let directory;
before(() => {
  directory = fixture_directory();
});
after(() => remove(directory));

const figures = {
  family: ['gravito-bending number', 'not true'],
  drift_cost: ['wall time (s)', 'largest violation max |g| (m)'],
  drift_heatmap: ['alpha (1/s²)', 'beta (1/s)'],
  drift_recovery: ['beta / (2 sqrt(alpha))', 'recovery time (s)'],
  work_precision: ['time per simulated second (ms)', 'relative error', 'explicit, fixed step'],
  tolerance: ['error / tolerance', 'esdirk43'],
  bdf_order: ['relative error', 'steps', 'wall time (s)'],
  stability_limit: ['largest stable step', 'measured limit', 'composite'],
  cost_by_model: ['wall time per simulated second (ms)', 'super helix'],
  nodal_steps: ['largest stable step (µs)', 'nodes'],
  scaling: ['cost per step (µs)', 'composite / recursive', 'composite: N^2.62'],
  swing: ['wall time (ms)', 'tip error (%)', '20 ms', '50 ms'],
  force_transport: ['off the rod / length', 'elements', 'time (s)'],
  block_descent: ['off the direct step / length', 'sweeps per step', 'vbd, whole'],
  cosserat_map: ['steps per second', 'at most 1 %', '20 sweeps'],
  newest_methods: ['tip error / length', 'wall time per simulated second', 'tress'],
};

// Tags balance, attributes are quoted, no bare '&' or '<': enough to reject what a parser
// would.
function assert_well_formed(xml) {
  const open = [];
  const rest = xml.replace(
    /<(\/?)([A-Za-z][\w:-]*)((?:\s+[\w:-]+="[^"<]*")*)\s*(\/?)>/g,
    (_, closing, name, attributes, empty) => {
      if (closing) assert.equal(open.pop(), name);
      else if (!empty) open.push(name);
      return '';
    },
  );
  assert.deepEqual(open, []);
  assert.doesNotMatch(rest, /[<>]/);
  assert.doesNotMatch(xml, /&(?!(amp|lt|gt|quot|apos|#\d+|#x[\da-f]+);)/i);
}

const mark_count = (svg) => {
  const paths = [...svg.matchAll(/aria-roledescription="([^"]*)"[^>]*d="(M[^"]{4,})"/g)];
  return paths.filter(([, role]) => /point|rect|line|circle|mark/.test(role)).length;
};

test('Bundles_AreBuiltFromTheseSources', () => {
  const hash = sources_hash(report_root);
  for (const file of ['report.mjs', 'film.mjs', 'render.mjs', 'page.html']) {
    assert.ok(
      readFileSync(join(report_root, 'dist', file), 'utf8').includes(hash),
      `dist/${file} is stale: npm ci && npm run build in experiments/report`,
    );
  }
});

test('LockFile_CarriesNoDownloadAddresses', () => {
  assert.doesNotMatch(
    readFileSync(join(report_root, 'package-lock.json'), 'utf8'),
    /"resolved"|\.tgz/,
  );
});

// Packages that vega-embed brings along inside its own file are named as well.
test('Notices_NameWhatIsInsideOtherPackages', () => {
  const notices = readFileSync(join(report_root, 'dist/NOTICES.txt'), 'utf8');
  for (const name of ['d3-array', 'fast-json-patch', 'semver', 'twgl.js', 'vega-embed', 'webm-muxer'])
    assert.match(notices, new RegExp(`^(.*, )?${name}(,.*)?$`, 'm'), name);
  assert.doesNotMatch(notices, /^axe-core/m, 'a tool of the tests');
});

test('Report_WritesPageAndOneSvgPerFigure', () => {
  const { status, stderr } = run_report(
    directory,
    '--out',
    join(directory, 'report.html'),
  );
  assert.equal(status, 0, stderr);
  // One table of the fixture was made by a tree with changes.
  const [mixed, ...rest] = stderr.trim().split('\n');
  assert.match(mixed, /^report: The tables are of 2 commits, .*with changes \(work_precision\)/);
  assert.equal(rest.length, 1);
  const page = readFileSync(join(directory, 'report.html'), 'utf8');
  assert.match(page, /id="mixed-commits">The tables are of 2 commits/);
  for (const [id, titles] of Object.entries(figures)) {
    const svg = readFileSync(join(directory, `${id}.svg`), 'utf8');
    assert_well_formed(svg);
    for (const title of titles) assert.ok(svg.includes(`>${title}<`), `${id}: ${title}`);
    assert.ok(mark_count(svg) > 10, `${id}: ${mark_count(svg)} marks`);
    assert.ok(!/NaN|undefined|var\(/.test(svg), `${id}: a value is missing`);
  }
});

test('Page_LoadsNothingAndForbidsTheNetwork', () => {
  const page = readFileSync(join(directory, 'report.html'), 'utf8');
  const policy = /http-equiv="Content-Security-Policy" content="([^"]*)"/.exec(page)[1];
  assert.match(policy, /^default-src 'none';/);
  assert.match(policy, /script-src 'sha256-[\w+/=]{44}' 'sha256-[\w+/=]{44}'$/);
  assert.doesNotMatch(policy, /unsafe-eval|https?:|\*/);
  assert.doesNotMatch(
    page.slice(0, page.indexOf('<script id="program">')),
    /(src|href)="(?!#|data:)/,
  );
});

test('Data_CannotEndTheScriptThatCarriesThem', () => {
  const other = empty_directory();
  writeFileSync(
    join(other, 'hostile.csv'),
    'name,status\n</script><script>alert(1)</script>,ok\n',
  );
  assert.equal(run_report(other).status, 0);
  assert.ok(!readFileSync(join(other, 'report.html'), 'utf8').includes('<script>alert'));
  remove(other);
});

test('MissingTables_SayHowToProduceThem', () => {
  const other = empty_directory();
  assert.equal(run_report(other).status, 0);
  const page = readFileSync(join(other, 'report.html'), 'utf8');
  for (const name of [
    'constraint_drift',
    'work_precision',
    'stability_limit',
    'scaling',
    'force_transport',
    'damping',
    'cost_of_gradient',
    'divided_heads',
    'block_descent',
  ]) {
    assert.ok(page.includes(`${name}.csv is not there yet`), name);
  }
  assert.match(page, /\.\/tress run/);
  assert.ok(!existsSync(join(other, 'drift_cost.svg')));
  remove(other);
});

// The warning about one file; the page is written and says the same in its place.
function refusal(file, text) {
  const other = empty_directory();
  writeFileSync(join(other, file), text);
  writeFileSync(join(other, 'good.csv'), 'a\n1\n');
  const { status, stderr } = run_page(other);
  const page = readFileSync(join(other, 'report.html'), 'utf8');
  remove(other);
  assert.equal(status, 0, stderr);
  const [warning, summary, ...rest] = stderr.trim().split('\n');
  assert.match(summary, /1 table, 0 figures, 0 scenes, 1 warning$/);
  assert.deepEqual(rest, []);
  assert.match(warning, /^report: warning: .*; run the experiment again or remove the file$/);
  assert.match(page, /Not everything could be used/);
  if (file === 'work_precision.csv') {
    assert.match(page, /<strong>Left out\.<\/strong>[^<]*work_precision\.csv/);
  }
  return warning;
}

test('MalformedTables_AreOneLineWithFileAndLine', () => {
  const head =
    'scene,model,integrator,elements,error_kind,error_rel,wall_s,wall_s_per_sim_s,steps,status\n';
  assert.match(
    refusal('work_precision.csv', `${head}beam,beam,ida,40,time,1e-3,1,1,10,ok\nbeam,ida\n`),
    /work_precision\.csv:3: 2 fields where the header has 10/,
  );
  assert.match(
    refusal('work_precision.csv', `${head}beam,beam,ida,40,time,1e-3,1,1,many,ok\n`),
    /work_precision\.csv:2: 'many' in column 'steps' is not a number/,
  );
  assert.match(
    refusal('work_precision.csv', 'scene,integrator\n'),
    /work_precision\.csv:1: column 'model'/,
  );
  assert.match(refusal('x.csv', ''), /x\.csv:1: empty/);
  assert.match(refusal('x.csv', 'a,a\n1,2\n'), /x\.csv:1: column 'a' appears twice/);
  assert.match(refusal('x.csv', 'a,b\n1,"2\n'), /x\.csv:2: a quote is opened/);
});

test('BadArguments_ExitWithTwo', () => {
  assert.equal(run_report().status, 2);
  assert.equal(run_report('/nonexistent/results').status, 2);
  assert.equal(run_report(directory, '--nope').status, 2);
  const { status, stderr } = run_report(directory, '--out', '/nonexistent/report.html');
  assert.equal(status, 2);
  assert.match(stderr, /\/nonexistent\/report\.html: cannot write/);
});

test('Findings_FollowTheTables', () => {
  const answer = (change) => {
    const apart = tables_apart(['constraint_drift'], change);
    run_page(apart);
    const page = readFileSync(join(apart, 'report.html'), 'utf8');
    remove(apart);
    return /id="answer-drift">(.*?)<\/dd>/.exec(page)[1].replace(/<[^>]*>/g, '');
  };
  assert.match(answer(), /drift by up to 0\.68 m \(bead on helix, explicit_euler\)/);
  assert.match(
    answer((text) =>
      text.replace(
        /^(formulation,bead_on_circle,acceleration,rk4,.*?,)5e-11,/m,
        '$17.25,',
      ),
    ),
    /drift by up to 7\.25 m \(bead on circle, rk4\)/,
  );
});

test('BdfFinding_StatesTheRatioOfTheRows', () => {
  const page = readFileSync(join(directory, 'report.html'), 'utf8').replace(
    /<\/?span[^>]*>/g,
    '',
  );
  assert.match(
    page,
    /Steps at maximum order 5 against order 2: .*16800 against 231 at rtol 0\.001 \(72\.7 times\)/,
  );
});

// The page's text without tags; the fixture's numbers are what the sentences must say.
const page_text = (of = directory) =>
  readFileSync(join(of, 'report.html'), 'utf8')
    .replace(/<script[\s\S]*/, '')
    .replace(/<\/t[dh]>/g, ' | ')
    .replace(/<[^>]*>/g, '');

// A directory of the tables named, `change(text, name)` of each.
function tables_apart(names, change = (text) => text) {
  const apart = empty_directory();
  for (const name of names) {
    copyFileSync(join(directory, `${name}.meta.json`), join(apart, `${name}.meta.json`));
    const text = readFileSync(join(directory, `${name}.csv`), 'utf8');
    writeFileSync(join(apart, `${name}.csv`), change(text, name));
  }
  return apart;
}

// The page of one table that was changed, and of those that its sentences need.
const with_changed = (name, change, check, others = []) => {
  const apart = tables_apart([name, ...others], (text, of) => {
    const changed = of === name ? change(text) : text;
    assert.ok(of !== name || changed !== text, name);
    return changed;
  });
  assert.equal(run_page(apart).status, 0);
  check(page_text(apart));
  remove(apart);
};

test('StabilityFinding_CountsWhereTheSolversAgree', () => {
  assert.match(page_text(), /same largest step in 90 of 90 cases\. Whip, no damping/);
  with_changed(
    'stability_limit',
    (text) =>
      text.replace(
        /^(grid,shake,super_helix,linearly_implicit_euler,composite,elastic,bend_twist,20,none,,)[^,]*/m,
        '$10.0003',
      ),
    (page) => assert.match(page, /in 89 of 90 cases \(largest difference \d+ %\)/),
  );
});

test('StabilityTable_MarksTheEndOfTheScan', () => {
  assert.match(
    page_text(),
    /release \| no damping \| recursive \| ≥ 100 \| 41 \| 9\.9 \| 3\.38 \| 1\.16 \| 0\.394/,
  );
  assert.match(
    page_text(),
    /whip \| no damping \| local elastic[^\n]*?\| &lt; 0\.001 \|/,
  );
});

test('ScalingTable_HasTheSourcesRatioBesideOurs', () => {
  assert.match(page_text(), /straight \| 30 \| 1\.4 \| 37 \| 26\.4 \|/);
  with_changed(
    'scaling',
    (text) =>
      text.replace(
        /^(straight,super_helix,composite,elastic,bend_twist,30,)[^,]*/m,
        '$14e-3',
      ),
    (page) => assert.match(page, /costs 100 times the recursive one at 30 elements/),
  );
});

test('SwingFinding_NamesTheTargetAndTheFastestPeer', () => {
  assert.match(
    page_text(),
    /1 % time error: cvode_adams .* within the target of 20 ms; the fastest published simulator \(MuJoCo 3, universal joints, implicitfast\) 38 ms/,
  );
  with_changed(
    'work_precision',
    (text) => text.replace(/^swing,super_helix,.*,(cvode_\w+|ida),.*,20,.*,time,.*\n/gm, ''),
    (page) => assert.match(page, /1 % time error: .* not within the target of 20 ms/),
  );
});

test('Swing_IsDrawnWithoutThePublishedRows', () => {
  const apart = tables_apart(['work_precision']);
  assert.equal(run_report(apart).status, 0);
  const svg = readFileSync(join(apart, 'swing.svg'), 'utf8');
  assert.ok(!svg.includes('Published simulators'));
  assert.ok(mark_count(svg) > 10);
  assert.doesNotMatch(page_text(apart), /other_simulators_swing\.csv is not there/);
  remove(apart);
});

test('WorkPrecision_TellsFamiliesAndKindsOfErrorApart', () => {
  const svg = readFileSync(join(directory, 'work_precision.svg'), 'utf8');
  for (const text of ['family of integrators', 'implicit, adaptive', 'strand swing, total error']) {
    assert.ok(svg.includes(`>${text}<`), text);
  }
  assert.match(page_text(), /strand swing, total error, cheapest per simulated second/);
});

test('Choices_AreComparedByTheirMedian', () => {
  assert.match(page_text(), /Effect of a choice, .* median over scenes and targets/);
});

// Ticks of a figure as text.
const ticks = (svg) =>
  [...svg.matchAll(/role-axis-label[\s\S]*?<\/g>/g)].flatMap(([group]) =>
    [...group.matchAll(/>([^<>]+)<\/text>/g)].map(([, text]) => text),
  );

test('Ticks_HaveSixDigitsAtMost', () => {
  for (const id of ['swing', 'force_transport', 'drift_cost']) {
    const list = ticks(readFileSync(join(directory, `${id}.svg`), 'utf8'));
    assert.ok(list.length > 5, id);
    for (const tick of list)
      assert.ok(tick.replace(/[^0-9]/g, '').replace(/^0+/, '').length <= 7, `${id}: ${tick}`);
  }
});

test('Csv_ReadsQuotesAndSpecialNumbers', () => {
  const { columns, rows } = parse_csv(
    'a,b\r\n1e-3,"x, ""y""\nz"\nnan,\n-inf,q\n',
    'f.csv',
  );
  assert.deepEqual(
    columns.map((c) => c.numeric),
    [true, false],
  );
  assert.deepEqual(rows, [
    [1e-3, 'x, "y"\nz'],
    ['nan', ''],
    ['-inf', 'q'],
  ]);
});

test('Manifest_ThatIsNoJsonIsLeftOut', () => {
  const apart = tables_apart(['family', 'scaling']);
  const path = join(apart, 'family.meta.json');
  writeFileSync(path, '{');
  const { status, stderr } = run_page(apart);
  assert.equal(status, 0);
  assert.match(stderr, /warning: .*family\.meta\.json: not valid JSON/);
  assert.match(page_text(apart), /Without a manifest: family\.csv/);
  rmSync(path);
  assert.equal(run_page(apart).status, 0);
  remove(apart);
});
