// "How this was made": the facts a reader needs from each manifest, the rest in full
// below.
import { escape_html, format_number } from './format.mjs';

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

// Claims the experiment itself checked, the ones that did not hold spelled out.
export function checks_html(name, { checks }) {
  if (!Array.isArray(checks) || checks.length === 0) return '';
  const failed = checks.filter(({ held }) => !held);
  const items = failed.map(
    ({ claim, value }) =>
      `<li>Did not hold: ${escape_html(claim)} (measured ${format_number(value)})</li>`,
  );
  return (
    `<p>${escape_html(name)}: ${checks.length - failed.length} of ${checks.length} ` +
    `claims checked by the experiment held.</p>` +
    (items.length > 0 ? `<ul class="findings">${items.join('')}</ul>` : '')
  );
}

export function manifest_html(tables) {
  const made = Object.entries(tables).filter(([, table]) => table.manifest !== undefined);
  const bare = Object.keys(tables).filter((name) => tables[name].manifest === undefined);
  const text = (value) =>
    escape_html(
      typeof value === 'boolean' ? (value ? 'yes' : 'no') : format_number(value),
    );
  const rows = made.map(([name, { manifest }]) => {
    const all = flatten(manifest);
    const cells = facts.map(
      ([, pattern]) =>
        `<td>${text(all.find(([key]) => pattern.test(key))?.[1] ?? 'not recorded')}</td>`,
    );
    return `<tr><th scope="row">${escape_html(name)}.csv</th>${cells.join('')}</tr>`;
  });
  const full = made.map(
    ([name, { manifest }]) =>
      `<details class="manifest"><summary>All of ` +
      `${escape_html(name)}.meta.json</summary><pre>${escape_html(JSON.stringify(manifest, null, 2))}` +
      '</pre></details>',
  );
  return [
    made.length === 0
      ? '<p>No manifest (.meta.json) lies beside the tables.</p>'
      : '<div class="table-box" tabindex="0" role="region" aria-label="How each table was made">' +
        `<table class="facts"><thead><tr><th scope="col">table</th>${facts
          .map(([label]) => `<th scope="col">${label}</th>`)
          .join('')}</tr></thead><tbody>${rows.join('')}</tbody>` +
        '</table></div>',
    bare.length > 0 && made.length > 0
      ? `<p>Without a manifest: ${bare
          .map((name) => `${escape_html(name)}.csv`)
          .join(', ')}.</p>`
      : '',
    ...made.map(([name, { manifest }]) => checks_html(name, manifest)),
    ...full,
  ].join('\n');
}
