// compare.mjs A B [--threshold 1.05] [--rounds 10] [--filter regex] [--min-time s] [--out name]
// See docs/compare.md. Exit codes as of ./tress; 3: slower, another value, or a row less.
import { mkdirSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { InputError } from '../report/src/input.mjs';
import { compare_benchmarks, fewest_rounds, more_rounds } from './benchmarks.mjs';
import { counts, csv_of, page_of } from './page.mjs';
import { build, side_of } from './sides.mjs';
import { compare_results } from './tables.mjs';

const repository = resolve(import.meta.dirname ?? '.', '../..');
const say = (text) => console.error(`tress: ${text}`);
const defaults = {
  '--threshold': '1.05',
  '--rounds': '10',
  '--filter': '.',
  '--min-time': '0.01',
  '--out': '',
};

function number(name, text, least, most) {
  const value = Number(text);
  if (!(value >= least && value <= most) || text.trim() === '')
    throw new InputError(`${name} ${text}: give a number from ${least} to ${most}`);
  return value;
}

function options_of(words) {
  const sides = [];
  const given = { ...defaults };
  for (let i = 0; i < words.length; ++i) {
    if (!words[i].startsWith('-')) {
      sides.push(words[i]);
      continue;
    }
    if (!(words[i] in defaults))
      throw new InputError(
        `unknown option '${words[i]}'; there are ${Object.keys(defaults).join(', ')}`,
      );
    if (words[i + 1] === undefined)
      throw new InputError(`${words[i]} without a value; give one`);
    given[words[i]] = words[++i];
  }
  if (sides.length !== 2)
    throw new InputError(
      'give two: results, builds or commits, as in ./tress compare HEAD~1 HEAD',
    );
  const rounds = number('--rounds', given['--rounds'], fewest_rounds, 1000);
  return {
    sides,
    threshold: number('--threshold', given['--threshold'], 1.001, 100),
    rounds: Math.round(rounds),
    filter: given['--filter'],
    min_time: number('--min-time', given['--min-time'], 1e-4, 100),
    out: given['--out'],
  };
}

/// A name for files: without folders and signs.
const short = (name) => basename(resolve(name)).replace(/[^\w.-]+/g, '_') || 'results';

function compare(options) {
  const sides = options.sides.map((text) => side_of(text, repository));
  const results = sides.map((side) => side.kind === 'results');
  if (results[0] !== results[1])
    throw new InputError(
      `${sides[0].name} and ${sides[1].name}: one is a folder of results, the other is built and timed; give two of one kind`,
    );
  if (results[0]) {
    const { rows, lines } = compare_results(sides[0].folder, sides[1].folder, options);
    for (const one of lines) console.log(one);
    const how =
      'Values agree to five digits. Times are of single rows: their median over a table is judged, where both are of one kind of processor.';
    return { sides, rows, how };
  }
  const [a, b] = sides.map((side) =>
    side.kind === 'commit' ? build(side, repository, say) : side,
  );
  const rows = compare_benchmarks(a.folder, b.folder, options, say);
  const how = `Processor time of ${options.rounds} rounds in turns; median ratio and an interval that encloses it with 99 %, whatever the noise. What was off by half of ${options.threshold} was timed again, in ${more_rounds} times the rounds, and the second time counts.`;
  return { sides: [a, b], rows, how };
}

try {
  const options = options_of(process.argv.slice(2));
  const { sides, rows, how } = compare(options);
  const [a, b] = sides.map((side) => side.name);
  const stem =
    options.out || join(repository, 'results/compare', `${short(a)}--${short(b)}`);
  mkdirSync(resolve(stem, '..'), { recursive: true });
  writeFileSync(`${stem}.csv`, csv_of(rows));
  writeFileSync(`${stem}.html`, page_of(a, b, rows, how));
  for (const row of rows.filter((one) => one.verdict === 'slower'))
    console.log(
      `slower: ${row.table} ${row.row} ${row.column}: ${row.ratio.toFixed(3)} times (${row.low.toFixed(3)} to ${row.high.toFixed(3)})`,
    );
  const all = counts(rows);
  console.log(
    `${all.map(([verdict, count]) => `${count} ${verdict}`).join(', ') || 'nothing to compare'} -> ${stem}.html`,
  );
  const bad = ['slower', 'changed value', 'only before'];
  process.exitCode = all.some(([verdict]) => bad.includes(verdict)) ? 3 : 0;
} catch (error) {
  if (!(error instanceof InputError) && error.code === undefined) throw error;
  console.error(`compare: ${error.message.split('\n')[0]}`);
  process.exitCode = 2;
}
