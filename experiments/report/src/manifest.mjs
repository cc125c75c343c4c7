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

// What is said of claims by how they ended; those that held are only counted, of other
// words the word itself is said.
const state_words = {
  broken: 'Did not hold',
  changed: 'Changed',
  'known limit': 'Known limit',
  'not judged': 'Not judged',
  figure: 'Figure',
};
const passing = 'held';

const value_text = (value) =>
  ['number', 'string'].includes(typeof value) ? format_number(value) : '';

// Older manifests say only whether a claim held.
const state_of = ({ state, held }) =>
  typeof state === 'string' ? state.replaceAll('_', ' ') : held === true ? passing : 'broken';

// Every judged claim, claim that was not judged, and figure that is no claim.
function claims_of(manifest) {
  const list = (key) => (Array.isArray(manifest?.[key]) ? manifest[key].filter(is_object) : []);
  const named = (entry, state) => ({
    state,
    text: value_text(entry.claim ?? entry.figure) || 'without words',
    value: value_text(entry.value),
    reason: value_text(entry.reason),
  });
  return [
    ...list('checks').map((check) => named(check, state_of(check))),
    ...list('not_judged').map((claim) => named(claim, 'not judged')),
    ...list('figures').map((figure) => named(figure, 'figure')),
  ];
}

function claim_html({ state, text, value, reason }) {
  const measured = value === '' ? '' : ` (measured ${value})`;
  const why = reason === '' ? '' : `: ${reason}`;
  return `<li>${escape_html(`${state_words[state] ?? state}: ${text}${measured}${why}`)}</li>`;
}

// Claims the experiment itself checked: how many held, and each of the others, what did not
// hold first.
export function checks_html(name, manifest) {
  const claims = claims_of(manifest);
  if (claims.length === 0) return '';
  const of = (state) => claims.filter((claim) => claim.state === state);
  const states = [...new Set([...Object.keys(state_words), ...claims.map((c) => c.state)])];
  const others = states.filter((state) => state !== passing && of(state).length > 0);
  const judged = claims.length - of('not judged').length - of('figure').length;
  const counts = [
    `${of(passing).length} of ${judged} claims checked by the experiment held`,
    ...others
      .filter((state) => state !== 'broken')
      .map((state) => `${state}: ${of(state).length}`),
  ];
  const items = others.flatMap(of).map(claim_html);
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
      ? '<p>No manifest (.meta.json) lies next to the tables.</p>'
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
