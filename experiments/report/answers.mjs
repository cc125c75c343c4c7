// answers.mjs FOLDER: what stability_limit, hard_cases, effect_audit and cost_of_accuracy found
// about one scene, whose tables lie in FOLDER, on one page -> FOLDER/answers.html.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { plain_page } from './plain_page.mjs';
import { parse_csv } from './src/csv.mjs';
import { escape_html, format_number, format_time } from './src/format.mjs';
import { by_pace, by_tolerance, pace } from './src/pace.mjs';
import { distinct, group_by, is_set } from './src/tables.mjs';

const folder = process.argv[2];

/// Rows as objects; none where there is no such table.
function rows_of(name) {
  const file = join(folder, `${name}.csv`);
  if (!existsSync(file)) return [];
  const { columns, rows } = parse_csv(readFileSync(file, 'utf8'), file);
  return rows.map((row) => Object.fromEntries(columns.map((c, i) => [c.name, row[i]])));
}

const percent = (part) =>
  typeof part === 'number' ? `${format_number(100 * part, 2)} %` : '';
const seconds = (s) => (typeof s === 'number' ? format_time(s) : '');

function table(heads, body) {
  if (body.length === 0) return '<p>No row: see the table next to this page.</p>';
  const line = (cells, tag) =>
    `<tr>${cells.map((c) => `<${tag}>${escape_html(c)}</${tag}>`).join('')}</tr>`;
  return `<table><thead>${line(heads, 'th')}</thead>
<tbody>${body.map((cells) => line(cells, 'td')).join('\n')}</tbody></table>`;
}

const method = (row) => `${row.integrator}${row.jacobian ? `, jacobian ${row.jacobian}` : ''}`;

/// What stands for a limit that was not found.
const no_limit = (row) =>
  ['inconclusive', 'timeout', 'crashed'].includes(row.status) ? 'inconclusive' : 'none';

function stable_steps() {
  const rows = rows_of('stability_limit').filter((row) => row.study !== 'tolerance');
  const size = (row) => (typeof row.dt_max_s === 'number' ? row.dt_max_s : 0);
  return table(
    ['method', 'largest stable step', 'beyond it', 'time of a simulated second'],
    [...rows]
      .sort((a, b) => size(b) - size(a))
      .map((row) =>
        size(row) > 0
          ? [method(row),
             `${row.limited_by === 'cap' ? '≥ ' : ''}${seconds(row.dt_max_s)}`,
             row.limited_by === 'cap' ? 'not tried' : row.limited_by,
             seconds(1 / row.realtime_factor)]
          : [method(row), no_limit(row), row.reason, '']),
  );
}

function tolerances() {
  const asked = (x) => (typeof x === 'number' ? x.toExponential() : '');
  return table(
    ['method', 'loosest', 'tightest within the work', 'steps at 1e-3'],
    rows_of('stability_limit')
      .filter((row) => row.study === 'tolerance')
      .map((row) =>
        typeof row.tolerance_loosest === 'number'
          ? [method(row), asked(row.tolerance_loosest), asked(row.tolerance_tightest),
             row.steps_usual]
          : [method(row), no_limit(row), row.reason, '']),
  );
}

/// A line for each model and integrator, a column for each step or tolerance; what is not
/// stable says why.
function survival() {
  const rows = rows_of('hard_cases');
  const head = (row) => `${by_tolerance(row) ? '' : 'step '}${pace(row)}`;
  const heads = distinct([...rows].sort(by_pace).map(head));
  const whose = (row) =>
    [row.model, row.variant, row.integrator].filter(Boolean).join(', ');
  // The guard's words begin with the outcome.
  const reason = ({ outcome, why }) =>
    why.startsWith(outcome) ? why : `${outcome}: ${why}`;
  const lines = [...group_by(rows, whose)].map(([subject, members]) => [
    subject,
    ...heads.map((wanted) => {
      const row = members.find((one) => head(one) === wanted);
      return !row ? '' : is_set(row.passed) ? row.outcome : reason(row);
    }),
  ]);
  return table(['model, integrator', ...heads], lines);
}

function effects() {
  return table(
    ['left out', 'tips move by', 'share of the time', 'verdict'],
    rows_of('effect_audit')
      .filter((row) => row.effect !== 'none')
      .map((row) => [row.effect, percent(row.error_without_rel), percent(row.cost_share),
        row.verdict || row.reason]),
  );
}

const configuration = (row) =>
  [row.model, row.modes, row.jacobian && `jacobian ${row.jacobian}`, row.options,
    row.elements && `${row.elements} elements`, row.integrator,
    typeof row.position_tol_rel === 'number' && `tolerance ${row.position_tol_rel}`,
    typeof row.dt_s === 'number' && `dt ${seconds(row.dt_s)}`].filter(Boolean).join(', ');

/// Time for which a row's error is known.
function validity({ horizon_s, duration_s }) {
  if (typeof horizon_s !== 'number') return '';
  return horizon_s < duration_s
    ? `the first ${seconds(horizon_s)} of ${seconds(duration_s)}`
    : `the whole ${seconds(duration_s)}`;
}

/// What the program printed of a row: a run is taken where it is an answer only.
function standing(row) {
  if (row.kind === 'runner_up') return 'next best';
  if (row.kind === 'as_given') return 'your file';
  if (['ok', 'valid_in_part', undefined].includes(row.status)) return 'take';
  if (row.status === 'file_differs' || !row.model) return `no answer: ${row.reason}`;
  const tried = `${row.search}`.includes('cut') ? 'so far' : 'with any method tried';
  const holds = row.error_rel <= row.target_error_rel ? ' with neighbours that hold' : '';
  return `no run within ${percent(row.target_error_rel)}${holds} ${tried}; best so far`;
}

function accuracy() {
  const rows = rows_of('cost_of_accuracy');
  // A row of a scene without a reference has no kind.
  const answers = rows.filter(({ kind }) =>
    !kind || ['winner', 'runner_up', 'as_given'].includes(kind));
  const line = (row) => [configuration(row), percent(row.error_rel),
    typeof row.ms_per_frame === 'number' ? seconds(row.ms_per_frame / 1e3) : row.reason];
  const heads = ['configuration', 'error, of the length', 'time a frame'];
  return `${table(['', ...heads, 'valid for'],
    answers.map((row) => [standing(row), ...line(row), validity(row)]))}
<h2>Error against time</h2>
<p>What nothing else that was tried beats in both.</p>
${table(heads, rows.filter((row) => row.kind === 'front').map(line))}`;
}

const name = rows_of('stability_limit')[0]?.scene ?? 'scene';
writeFileSync(join(folder, 'answers.html'), plain_page(`${name}: what the experiments say`, `<h1>${escape_html(name)}</h1>
<h2>Which steps are stable</h2>
<p>The largest step of each method such that the scene as a whole keeps what physics allows, and no step
needs shorter ones in its place.</p>
${stable_steps()}
<p>Adaptive runs (position_tol_rel: error over the length): the loosest such that it and all tighter ones tried were stable.</p>
${tolerances()}
<h2>Which models survive it</h2>
<p>Every model, at the scene's step and at those of the hard cases: each step has a solution, the guard of simulations
finds nothing, no piece is stretched and no body entered too far.</p>
${survival()}
<h2>Which effects matter</h2>
<p>Root mean square over frames and strands, over their length; the verdict is for 1 %.</p>
${effects()}
<h2>What is the cheapest way to 1 %</h2>
${accuracy()}`));
console.log(`${folder}/answers.html`);
