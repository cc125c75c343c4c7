// What the columns of every table mean: from the manifests, where the experiments say it, and
// from here for tables that no experiment writes.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { table } from '../markdown.mjs';

const in_every_table = {
  status: 'ok, or how the row ended',
  reason: 'reason for a status that is not ok',
  run_id: 'checksum of the settings of the row',
};

const of_claims = {
  study: 'question of the family',
  claim: 'statement that is tested',
  family: 'hair, or rods of other materials',
  model: 'catalogue id',
  integrator: 'method',
  range: 'gravito-bending numbers of the hairs or rods that are counted',
  statement: 'the claim in words',
  value: 'quantity measured for each hair',
  hairs: 'hairs or rods that give an answer',
  no_answer: 'hairs or rods without an answer',
  reasons: 'number of hairs or rods without an answer, by status',
  holds_share: 'share of the hairs or rods for which the claim is true',
  decile_1: 'first decile of the value',
  median: 'median of the value',
  decile_9: 'ninth decile of the value',
  correlated_with: 'property of a hair with the largest rank correlation with the value',
  rank_correlation: "Spearman's rank correlation with that property",
  decided_by: 'property that best predicts for which hairs the claim is true',
  threshold: 'threshold of that property',
  share_below: 'share of the hairs below the threshold for which the claim is true',
  share_above: 'share of the hairs above the threshold for which the claim is true',
  told_right_share: 'share of all hairs that the threshold predicts correctly',
};

const by_hand = {
  family_summary: of_claims,
  family_tolerance_summary: of_claims,
  compare_itself: {
    beside: 'itself, or a build with a slowed kernel',
    rows: 'benchmarks compared',
    wrong: 'verdicts that contradict the build',
    verdict: 'verdict on the slowed kernel',
    ratio: 'time of that kernel over its time in the build itself, median of the rounds',
    ratio_low: 'lower end of the interval of the ratio',
    ratio_high: 'upper end of the interval of the ratio',
  },
  full_sweeps: {
    experiment: 'experiment of `./tress run`',
    rows: 'number of rows of the experiment',
    timed_rows: 'rows timed, spread over all',
    cut_off_rows: 'timed rows that reached the timeout: their time is a lower bound',
    row_s: 'processor time of a timed row, mean (s)',
    plan_s: 'processor time to plan the rows, in each part (s)',
    parts: 'number of parts of about a quarter of an hour',
    core_hours: 'core hours of all rows in these parts',
    memory_mb: 'memory of the largest process (MB)',
  },
  mutants: {
    file: 'mutated source file',
    line: 'number of the mutated line',
    before: 'original line',
    after: 'mutated line',
    outcome: 'killed by a test, or survived',
  },
  player: {
    draw: 'renderer: the canvas alone, or WebGL computed by a processor',
    colour: 'one colour a strand, or hair in light',
    hairs: 'number of hairs drawn',
    points: 'number of points of each hair',
    width: 'width of the picture in pixels',
    height: 'height of the picture in pixels',
    picture_ms: 'wall time of a picture (ms), median of five times ten',
  },
  peers_published: {
    name: 'name of the method',
    cited_as: 'citation in this repository',
    source: 'publication or program',
    address: 'address of the source',
    simulated: 'simulated system',
    hardware: 'hardware of the run',
    figure: 'published figure',
    unit: 'unit of the figure',
    measured: 'quantity that the figure gives',
    not_measured: 'questions that the figure leaves open',
    checked: 'whether the figure was found at its source',
  },
  peers_swing: {
    peer: 'simulator and its joints',
    stable_dt_n5_s: 'largest stable step with 5 links',
    stable_dt_n20_s: 'largest stable step with 20 links',
    stable_dt_n80_s: 'largest stable step with 80 links',
    us_per_step_n20: 'wall time of a step with 20 links (µs)',
    wall_1pct_s: 'wall time of the run for an error of 1 %',
    dt_1pct_s: 'step of that run',
    wall_0p1pct_s: 'wall time of the run for an error of 0.1 %',
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
        if (!help[column]) throw new Error(`${name}.csv: column ${column} has no text`);
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
    ...heads.map(([column, what]) => [column, `${what} (batches of strands)`]),
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
