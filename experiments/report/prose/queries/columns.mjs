// What the columns of every table mean: from the manifests, where the experiments say it, and
// from here for tables that no experiment writes.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { table } from '../markdown.mjs';

const in_every_table = {
  status: 'ok, or how the row ended',
  reason: 'why, where it is not ok',
  run_id: 'of the row: a checksum of what was asked for',
};

const of_claims = {
  study: 'question of the family',
  claim: 'statement that is tested',
  family: 'hair, or rods of other materials',
  model: 'catalogue id',
  integrator: 'method',
  range: 'gravito-bending numbers of the hairs or rods that are counted',
  statement: 'the claim in words',
  value: 'what is measured of each hair',
  hairs: 'hairs or rods that give an answer',
  no_answer: 'hairs or rods without one',
  reasons: 'number of those by status',
  holds_share: 'share of the hairs or rods for which the claim is true',
  decile_1: 'of the value',
  median: 'of the value',
  decile_9: 'of the value',
  correlated_with: 'property of a hair whose ranks go most with those of the value',
  rank_correlation: "Spearman's, with that property",
  decided_by: 'property that tells best for which hairs the claim holds',
  threshold: 'of that property',
  share_below: 'of the hairs below the threshold for which it holds',
  share_above: 'of those above',
  told_right_share: 'of all hairs, by that threshold',
};

const by_hand = {
  family_summary: of_claims,
  family_tolerance_summary: of_claims,
  compare_itself: {
    beside: 'itself, or a build with a slowed kernel',
    rows: 'benchmarks compared',
    wrong: 'verdicts that are not what was built',
    verdict: 'of the kernel that is slowed',
    ratio: 'its time over that of the build itself, median of the rounds',
    ratio_low: 'lower end of its interval',
    ratio_high: 'upper end',
  },
  full_sweeps: {
    experiment: 'of `./tress run`',
    rows: 'of all that it has',
    timed_rows: 'of these, spread over all',
    cut_off_rows: 'of the timed rows, which ran into the timeout: what they take is more',
    row_s: 'processor time of a timed row, mean (s)',
    plan_s: 'the same to plan them, which each part does (s)',
    parts: 'of about a quarter of an hour',
    core_hours: 'of all rows in these parts',
    memory_mb: 'of the largest process (MB)',
  },
  mutants: {
    file: 'source that was spoilt',
    line: 'of it',
    before: 'the line',
    after: 'the line, spoilt',
    outcome: 'killed by a test, or survived',
  },
  player: {
    draw: 'by what: the canvas alone, or WebGL that a processor computes',
    colour: 'one colour a strand, or hair in light',
    hairs: 'drawn',
    points: 'of each',
    width: 'of the picture in pixels',
    height: 'the same',
    picture_ms: 'wall time of a picture (ms), median of five times ten',
  },
  peers_published: {
    name: 'of the method',
    cited_as: 'in this repository',
    source: 'publication or program',
    address: 'where it was read',
    simulated: 'what is simulated',
    hardware: 'that it ran on',
    figure: 'what was published',
    unit: 'of the figure',
    measured: 'what the figure says',
    not_measured: 'what it leaves open',
    checked: 'whether the figure was found at its source',
  },
  peers_swing: {
    peer: 'simulator and its joints',
    stable_dt_n5_s: 'largest stable step with 5 links',
    stable_dt_n20_s: 'with 20 links',
    stable_dt_n80_s: 'with 80 links',
    us_per_step_n20: 'wall time of a step with 20 links (µs)',
    wall_1pct_s: 'wall time of the run for an error of 1 %',
    dt_1pct_s: 'step of that run',
    wall_0p1pct_s: 'wall time for 0.1 %',
  },
};

// solve_ivp.csv is rows of work_precision.
const like = { solve_ivp: 'work_precision' };

// Ends of names that are units: the Python module's own.
const units = Object.fromEntries(
  Object.entries(
    JSON.parse(
      readFileSync(new URL('../../../../python/tress/units.json', import.meta.url), 'utf8'),
    ),
  ).map(([end, unit]) => [end, unit.replace('^2', '²').replace('^3', '³')]),
);

export function unit_of(column) {
  const words = column.split('_');
  const ends = words.slice(1).map((_, k) => words.slice(k + 1).join('_'));
  return units[ends.find((end) => end in units)] ?? '';
}

function help_of(name, root) {
  if (by_hand[name] !== undefined) return by_hand[name];
  const file = join(root, 'results', `${like[name] ?? name}.meta.json`);
  return JSON.parse(readFileSync(file, 'utf8')).columns;
}

function columns_of(name, root) {
  const text = readFileSync(join(root, 'results', `${name}.csv`), 'utf8');
  return text.slice(0, text.indexOf('\n')).trim().split(',');
}

// A table of every file: column, unit, meaning.
export const list = (_, root) => {
  const names = readdirSync(join(root, 'results'))
    .filter((file) => file.endsWith('.csv'))
    .map((file) => file.slice(0, -4))
    .sort();
  return names
    .map((name) => {
      const help = help_of(name, root);
      const own = columns_of(name, root).filter((column) => !(column in in_every_table));
      const rows = own.map((column) => {
        if (!help[column]) throw new Error(`${name}.csv: nothing says what ${column} is`);
        return [`\`${column}\``, unit_of(column), help[column]];
      });
      return `## ${name}.csv\n\n${table(['column', 'unit', ''], rows)}`;
    })
    .join('\n\n');
};

// Those of strands and of heads, as the sources that write them say.
export const series = (_, root) => {
  const found = (file, pattern) => {
    const rows = [...readFileSync(join(root, file), 'utf8').matchAll(pattern)];
    if (rows.length < 8) throw new Error(`${file}: no columns are found there`);
    // A number that the scene says may follow.
    return rows.map(([, column, what]) => [column, what.replace(/, of $/, '')]);
  };
  const strands = [
    ...found('simulation/run/readout.cpp', /\badd\("(\w+)",\s*"([^"]+)"/g),
    ['tip_x_m, tip_y_m, tip_z_m', 'tip, mean over the strands'],
    ['<effect>_j', "the effect's potential energy"],
  ];
  const heads = found(
    'experiments/simulate/head_series.cpp',
    /\{"(\w+)",\s*"([^"]+)"\}/g,
  ).filter(([column]) => !strands.some(([known]) => known.split(', ').includes(column)));
  const rows = [
    ...strands,
    ...heads.map(([column, what]) => [column, `of a head: ${what}`]),
  ];
  return table(
    ['column', 'unit', ''],
    rows.map(([column, what]) => [`\`${column}\``, unit_of(column.split(', ')[0]), what]),
  );
};

export const everywhere = () =>
  table(
    ['column', ''],
    Object.entries(in_every_table).map(([column, what]) => [`\`${column}\``, what]),
  );
