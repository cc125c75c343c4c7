// Benchmarks of two builds, timed in turns, so that both see the same machine.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { InputError } from '../report/src/input.mjs';
import { fewest, spread, verdict } from './statistics.mjs';

const confidence = 0.99;
// Of what is timed again, alone, over those of the first look: there are few such rows.
export const more_rounds = 3;
export const fewest_rounds = fewest(confidence);

const programs_in = (folder) =>
  readdirSync(folder)
    .filter((name) => /^bench_\w+$/.test(name))
    .sort();

/// Processor time of each benchmark, by name, of one run of a program: the shortest of
/// three, for what else a machine does only adds time, and not often.
function run(program, { filter, min_time }) {
  const folder = mkdtempSync(join(tmpdir(), 'tress-compare-'));
  const out = join(folder, 'out.json');
  try {
    const { error, signal } = spawnSync(
      program,
      [
        `--benchmark_filter=${filter}`,
        `--benchmark_min_time=${min_time}`,
        '--benchmark_repetitions=3',
        `--benchmark_out=${out}`,
        '--benchmark_out_format=json',
      ],
      { stdio: 'ignore' },
    );
    if (signal === 'SIGINT') throw new InputError('interrupted');
    if (error || !existsSync(out))
      throw new InputError(
        `${program}: wrote no timings (${error?.code ?? signal ?? 'no file'}); run it by hand`,
      );
    const text = readFileSync(out, 'utf8');
    // Of a filter that nothing matches the file is empty.
    const { benchmarks } = text === '' ? { benchmarks: [] } : JSON.parse(text);
    const times = new Map();
    for (const one of benchmarks) {
      if (one.run_type !== 'iteration' || one.error_occurred) continue;
      times.set(one.name, Math.min(one.cpu_time, times.get(one.name) ?? Infinity));
    }
    return times;
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/// Ratios b/a by benchmark. The two take turns, and who begins alternates.
function ratios(a, b, options, say) {
  const found = new Map();
  const only = { a: new Set(), b: new Set() };
  for (let round = 0; round < options.rounds; ++round) {
    say(round);
    const b_first = round % 2 === 1;
    const first = run(b_first ? b : a, options);
    const second = run(b_first ? a : b, options);
    const [of_a, of_b] = b_first ? [second, first] : [first, second];
    for (const [name, time] of of_b) {
      if (!of_a.has(name)) only.b.add(name);
      else found.set(name, [...(found.get(name) ?? []), time / of_a.get(name)]);
    }
    for (const name of of_a.keys()) if (!of_b.has(name)) only.a.add(name);
  }
  return { found, only };
}

const exactly = (names) =>
  `^(${names.map((name) => name.replace(/[.*+?^${}()|[\]\\]/g, '\\$&')).join('|')})$`;

/// Rows of all benchmarks of the two folders. The first rounds only look: of ten ratios the
/// interval goes from the least to the largest, so that a single disturbed round would hide
/// what is slower. Whatever is off by half the threshold is measured once more, alone and
/// in more rounds, and the second measurement is what counts: with hundreds of rows some
/// are off by chance.
export function compare_benchmarks(a, b, options, say) {
  const rows = [];
  for (const name of programs_in(a)) {
    if (!programs_in(b).includes(name)) {
      rows.push({ table: name, row: '', verdict: 'only before' });
      continue;
    }
    const measure = (what, filter, rounds) =>
      ratios(join(a, name), join(b, name), { ...options, filter, rounds }, (round) =>
        say(`${name}, ${what}: round ${round + 1} of ${rounds}`),
      );
    const { found, only } = measure('timings', options.filter, options.rounds);
    const judged = new Map(
      [...found].map(([row, values]) => [
        row,
        { ...spread(values, confidence), verdict: 'same' },
      ]),
    );
    const half = Math.sqrt(options.threshold);
    const suspected = [...judged.keys()].filter(
      (row) => judged.get(row).ratio > half || judged.get(row).ratio < 1 / half,
    );
    if (suspected.length > 0) {
      const again = measure(
        `${suspected.length} again`,
        exactly(suspected),
        more_rounds * options.rounds,
      );
      for (const row of suspected) {
        const interval = spread(again.found.get(row), confidence);
        judged.set(row, { ...interval, verdict: verdict(interval, options.threshold) });
      }
    }
    for (const [row, found] of judged)
      rows.push({ table: name, row, column: 'cpu_time', ...found });
    for (const row of only.a) rows.push({ table: name, row, verdict: 'only before' });
    for (const row of only.b) rows.push({ table: name, row, verdict: 'only after' });
  }
  for (const name of programs_in(b))
    if (!programs_in(a).includes(name))
      rows.push({ table: name, row: '', verdict: 'only after' });
  return rows;
}
