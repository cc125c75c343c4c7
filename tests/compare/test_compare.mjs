// ./tress compare: what is equal, changed, lost, slower; and that noise alone is nothing.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { parse_csv } from '../../experiments/report/src/csv.mjs';
import { fewest, spread } from '../../experiments/compare/statistics.mjs';

const program = fileURLToPath(
  new URL('../../experiments/compare/compare.mjs', import.meta.url),
);
const scratch = mkdtempSync(join(tmpdir(), 'tress-compare-'));
let made = 0;

function folder(tables) {
  const path = join(scratch, `folder${++made}`);
  mkdirSync(path);
  for (const [name, text] of Object.entries(tables))
    writeFileSync(join(path, name), text);
  return path;
}
function compare(...args) {
  const stem = join(scratch, `out${++made}`);
  const run = spawnSync(process.execPath, [program, ...args, '--out', stem], {
    encoding: 'utf8',
  });
  const rows = () => {
    const { columns, rows } = parse_csv(readFileSync(`${stem}.csv`, 'utf8'), stem);
    return rows.map((row) => Object.fromEntries(columns.map((c, i) => [c.name, row[i]])));
  };
  return { ...run, rows, page: () => readFileSync(`${stem}.html`, 'utf8') };
}

const manifest = (cpu = 'one') =>
  JSON.stringify({ timings: ['wall_s'], machine: { cpu, simd: 'avx2' } });
const table = (rows, cpu) => ({
  'swing.csv': `model,elements,error,wall_s\n${rows.join('\n')}\n`,
  'swing.meta.json': manifest(cpu),
});
const models = ['der', 'corde', 'super_helix', 'mass_spring', 'a', 'b', 'c', 'd'];
const rows = (error, time) => models.map((m, i) => `${m},5,${error(i)},${time(i)}`);
const before = folder(
  table(
    rows(
      () => 0.25,
      (i) => i + 1,
    ),
  ),
);

test('timings, new columns and the sixth digit do not count; another value does', () => {
  const equal = compare(
    before,
    folder(
      table(
        rows(
          () => 0.2500001,
          (i) => (i + 1) * 1.01,
        ),
      ),
    ),
  );
  assert.match(equal.stdout, /swing: 8 of 8 rows agree/);
  assert.equal(equal.status, 0);
  const other = compare(
    before,
    folder(
      table(
        rows(
          (i) => (i === 1 ? 0.251 : 0.25),
          () => 1,
        ),
      ),
    ),
  );
  assert.match(other.stdout, /swing: 7 of 8 rows agree/);
  const [changed] = other.rows().filter((row) => row.verdict === 'changed value');
  assert.equal(changed.row, 'corde');
  assert.equal(changed.change, 'error: 0.25 -> 0.251');
  assert.equal(other.status, 3);
  assert.match(other.page(), /error: 0\.25 -&gt; 0\.251/);
});

test('a row or a table less is told; more of them are no fault', () => {
  const less = compare(
    before,
    folder(
      table(
        rows(
          () => 0.25,
          (i) => i + 1,
        ).slice(1),
      ),
    ),
  );
  assert.equal(less.rows().find((row) => row.verdict === 'only before').row, 'der');
  assert.equal(less.status, 3);
  const more = [
    ...rows(
      () => 0.25,
      (i) => i + 1,
    ),
    'new,5,1,1',
  ];
  assert.equal(compare(before, folder(table(more))).status, 0);
  assert.equal(compare(before, folder({ 'other.csv': 'x\n1\n' })).status, 3);
});

test('a table as a whole is slower, on one kind of machine alone', () => {
  const slow = rows(
    () => 0.25,
    (i) => (i + 1) * 1.3,
  );
  const slower = compare(before, folder(table(slow)));
  assert.match(slower.stdout, /slower: swing median of 8 rows wall_s: 1\.300 times/);
  assert.equal(slower.status, 3);
  assert.equal(compare(before, folder(table(slow)), '--threshold', '1.4').status, 0);
  const elsewhere = compare(before, folder(table(slow, 'two')));
  assert.equal(elsewhere.rows()[0].verdict, 'other machine');
  assert.equal(elsewhere.status, 0);
});

// Google Benchmark's options and file; times with the noise of a shared machine: 3 % either
// way, and one in ten is half as long again.
function build(slowed = '') {
  const path = join(scratch, `build${++made}`);
  mkdirSync(join(path, 'experiments/benchmarks'), { recursive: true });
  const runs = join(path, 'runs');
  writeFileSync(runs, '0');
  // Every run has other noise, and every test the same.
  const script = `#!/bin/bash
runs=$(<${runs})
echo $((runs + 1)) >${runs}
RANDOM=$((7919 * runs + ${made}))
for word in "$@"; do
  case $word in
    --benchmark_out=*) out=\${word#*=} ;;
    --benchmark_filter=*) filter=\${word#*=} ;;
  esac
done
comma=
{
  echo '{"context": {}, "benchmarks": ['
  for name in solve/{1..6}{,,} step/{1..6}{,,}; do
    [[ $name =~ $filter ]] || continue
    time=$((9700 + RANDOM % 600))
    ((RANDOM % 10)) || time=$((time * 3 / 2))
    [[ $name != '${slowed}' ]] || time=$((time * 11 / 10))
    printf '%s{"name": "%s", "run_type": "iteration", "cpu_time": %d}\\n' "$comma" "$name" "$time"
    comma=,
  done
  echo ']}'
} >"$out"
`;
  writeFileSync(join(path, 'experiments/benchmarks/bench_toy'), script, { mode: 0o755 });
  return path;
}

test('a build beside itself: noise is no verdict', () => {
  for (let i = 0; i < 4; ++i) {
    const same = compare(build(), build());
    assert.equal(same.status, 0, same.stdout);
    assert.equal(same.rows().length, 12);
  }
});

test('one kernel that is a tenth slower is found, and no other', () => {
  const slower = compare(build(), build('step/3'));
  const verdicts = slower.rows().filter((row) => row.verdict !== 'same');
  assert.deepEqual(
    verdicts.map((row) => [row.row, row.verdict]),
    [['step/3', 'slower']],
  );
  assert.equal(slower.status, 3);
  const faster = compare(build('step/3'), build());
  assert.equal(faster.rows().find((row) => row.row === 'step/3').verdict, 'faster');
  assert.equal(faster.status, 0);
});

test('intervals of the median are those of the sign test', () => {
  // 2/2^7 > 1 % > 2/2^8; of 10 values the outermost, of 12 the next ones: 2 (1 + 12)/2^12.
  assert.equal(fewest(0.99), 8);
  const count = (n) =>
    spread(
      Array.from({ length: n }, (_, i) => i),
      0.99,
    );
  assert.deepEqual(count(7), { ratio: 3, low: 0, high: Infinity });
  assert.deepEqual(count(10), { ratio: 4.5, low: 0, high: 9 });
  assert.deepEqual(count(12), { ratio: 5.5, low: 1, high: 10 });
  // 2.576 sqrt(n)/2 about the middle, where there are many.
  const { low, high } = count(10000);
  assert.ok(Math.abs(low - (4999.5 - 128.8)) < 2 && low + high === 9999);
});

test('what cannot be compared is one line and exit code 2', () => {
  for (const args of [
    [before, '/nowhere'],
    [before],
    [before, before, '--threshold', 'x'],
    [before, before, '--fast', '1'],
    [before, build()],
    [before, folder({})],
  ]) {
    const run = compare(...args);
    assert.equal(run.status, 2, args.join(' '));
    assert.equal(run.stderr.trim().split('\n').length, 1);
  }
});
