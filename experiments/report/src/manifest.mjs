// "How this was made": the facts a reader needs from each manifest, the rest in full
// below.
import { escape_html, format_number } from './format.mjs';
import { is_object } from './objects.mjs';

// [['git.commit', '0123'], ...]
function flatten(value, prefix = '') {
  if (value !== null && typeof value === 'object') {
    return Object.entries(value).flatMap(([key, inner]) =>
      flatten(inner, prefix === '' ? key : `${prefix}.${key}`),
    );
  }
  return [[prefix, value]];
}

const facts = [
  ['machine', /(^|[._])(cpu|machine|processor)([._](name|model))?$/i],
  ['commit', /(^|[._])(commit|revision)$/i],
  ['uncommitted changes', /dirty/i],
  ['compiler', /(^|[._])compiler([._](name|version|id))?$/i],
  ['flags', /flags$/i],
  ['SUNDIALS speed ratio', /sundials.*ratio|ratio.*sundials/i],
  ['date', /(^|[._])(date|start)$/i],
];

// How a claim ended: its `state`, or as older manifests have it, whether it held.
function state_of({ state, held }) {
  if (typeof state === 'string') return state.replaceAll('_', ' ');
  return held === true ? 'passed' : held === false ? 'failed' : 'not judged';
}

// What is said of claims that did not simply pass, by state; other states by their name.
const state_words = {
  failed: 'Did not hold',
  finding: 'Known limit',
  figure: 'Figure, not judged',
  'not judged': 'Not judged',
};
const worst_first = Object.keys(state_words);

const value_text = (value) =>
  ['number', 'string', 'boolean'].includes(typeof value) ? format_number(value) : '';

function check_html({ claim, value, expected, state }) {
  const numbers = [
    value_text(value) === '' ? '' : `measured ${value_text(value)}`,
    value_text(expected) === '' ? '' : `expected ${value_text(expected)}`,
  ].filter(Boolean);
  return (
    `<li>${escape_html(state_words[state] ?? state)}: ${escape_html(claim)}` +
    `${numbers.length > 0 ? ` (${escape_html(numbers.join(', '))})` : ''}</li>`
  );
}

// Claims the experiment itself checked: how many passed, and each of the others.
export function checks_html(name, manifest) {
  const list = Array.isArray(manifest?.checks) ? manifest.checks.filter(is_object) : [];
  const checks = list.map((check) => ({
    ...check,
    claim: value_text(check.claim) || 'a claim without words',
    state: state_of(check),
  }));
  if (checks.length === 0) return '';
  const others = checks.filter(({ state }) => state !== 'passed');
  const states = [...new Set([...worst_first, ...others.map(({ state }) => state)])];
  const groups = states
    .map((state) => others.filter((check) => check.state === state))
    .filter((members) => members.length > 0);
  const judged = checks.filter(({ state }) => ['passed', 'failed'].includes(state)).length;
  const counts = [
    `${checks.length - others.length} of ${judged} judged claims passed`,
    ...groups
      .filter(([{ state }]) => state !== 'failed')
      .map((members) => `${members.length} ${members[0].state}`),
  ];
  const items = groups.flat().map(check_html);
  return (
    `<p>${escape_html(name)}: ${escape_html(counts.join(', '))}.</p>` +
    (items.length > 0 ? `<ul class="findings">${items.join('')}</ul>` : '')
  );
}

const fact_text = (value) =>
  escape_html(
    typeof value === 'boolean' ? (value ? 'yes' : 'no') : format_number(value),
  );

// A row of facts, and the manifest in full.
function made_html(name, manifest) {
  const all = flatten(manifest);
  const cells = facts.map(
    ([, pattern]) =>
      `<td>${fact_text(all.find(([key]) => pattern.test(key))?.[1] ?? 'not recorded')}</td>`,
  );
  return {
    row: `<tr><th scope="row">${escape_html(name)}.csv</th>${cells.join('')}</tr>`,
    checks: checks_html(name, manifest),
    full:
      `<details class="manifest"><summary>All of ${escape_html(name)}.meta.json</summary>` +
      `<pre tabindex="0">${escape_html(JSON.stringify(manifest, null, 2))}</pre></details>`,
  };
}

export function manifest_html(tables, warnings) {
  const made = Object.entries(tables).flatMap(([name, { manifest }]) =>
    manifest === undefined
      ? []
      : warnings.guard(
          `${name}.meta.json`,
          'how it was made',
          () => [made_html(name, manifest)],
          [],
        ),
  );
  const bare = Object.keys(tables).filter((name) => tables[name].manifest === undefined);
  return [
    made.length === 0
      ? '<p>No manifest (.meta.json) lies beside the tables.</p>'
      : '<div class="table-box" tabindex="0" role="region" aria-label="How each table was made">' +
        `<table class="facts"><thead><tr><th scope="col">table</th>${facts
          .map(([label]) => `<th scope="col">${label}</th>`)
          .join('')}</tr></thead><tbody>${made.map(({ row }) => row).join('')}</tbody>` +
        '</table></div>',
    bare.length > 0 && made.length > 0
      ? `<p>Without a manifest: ${bare
          .map((name) => `${escape_html(name)}.csv`)
          .join(', ')}.</p>`
      : '',
    ...made.map(({ checks }) => checks),
    ...made.map(({ full }) => full),
  ].join('\n');
}
