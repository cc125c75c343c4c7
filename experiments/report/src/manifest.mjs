// "How this was made": the facts a reader needs from each manifest, the rest in full below.
import { escape_html, format_number } from './format.mjs';

// [['git.commit', '0123'], ...]
function flatten(value, prefix = '') {
  if (value !== null && typeof value === 'object') {
    return Object.entries(value).flatMap(([key, inner]) =>
      flatten(inner, prefix === '' ? key : `${prefix}.${key}`));
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
  ['date', /(^|[._])(date|time|started)$/i],
];

export function manifest_html(tables) {
  const made = Object.entries(tables).filter(([, table]) => table.manifest !== undefined);
  const bare = Object.keys(tables).filter((name) => tables[name].manifest === undefined);
  const text = (value) => escape_html(typeof value === 'boolean' ? (value ? 'yes' : 'no')
    : format_number(value));
  const rows = made.map(([name, { manifest }]) => {
    const all = flatten(manifest);
    const cells = facts.map(([, pattern]) =>
      `<td>${text(all.find(([key]) => pattern.test(key))?.[1] ?? 'not recorded')}</td>`);
    return `<tr><th scope="row">${escape_html(name)}.csv</th>${cells.join('')}</tr>`;
  });
  const full = made.map(([name, { manifest }]) => `<details class="manifest"><summary>All of ` +
    `${escape_html(name)}.meta.json</summary><pre>${escape_html(JSON.stringify(manifest, null, 2))}` +
    '</pre></details>');
  return [
    made.length === 0 ? '<p>No manifest (.meta.json) lies beside the tables.</p>'
      : '<div class="table-box" tabindex="0" role="region" aria-label="How each table was made">' +
        `<table class="facts"><thead><tr><th scope="col">table</th>${facts.map(([label]) =>
          `<th scope="col">${label}</th>`).join('')}</tr></thead><tbody>${rows.join('')}</tbody>` +
        '</table></div>',
    bare.length > 0 && made.length > 0 ? `<p>Without a manifest: ${bare.map((name) =>
      `${escape_html(name)}.csv`).join(', ')}.</p>` : '',
    ...full,
  ].join('\n');
}
