// A comparison as a table and as a page.
import { plain_page } from '../report/plain_page.mjs';
import { escape_html, format_number } from '../report/src/format.mjs';

const columns = ['table', 'row', 'column', 'ratio', 'low', 'high', 'verdict', 'change'];

const field = (value) => {
  const text = value === undefined || value === Infinity ? '' : String(value);
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};

export const csv_of = (rows) =>
  [columns, ...rows.map((row) => columns.map((name) => row[name]))]
    .map((cells) => `${cells.map(field).join(',')}\n`)
    .join('');

const order = [
  'slower',
  'changed value',
  'only before',
  'faster',
  'only after',
  'other machine',
  'same',
];

export const counts = (rows) =>
  order
    .map((verdict) => [verdict, rows.filter((row) => row.verdict === verdict).length])
    .filter(([, count]) => count > 0);

// Ratios from 1/2 to 2 across 160 units; the line is 1.
const place = (ratio) => 80 + 80 * Math.max(-1, Math.min(1, Math.log2(ratio)));
function drawn({ ratio, low, high }) {
  if (ratio === undefined) return '';
  const [x, from, to] = [ratio, low, high].map((one) => place(one).toFixed(1));
  return (
    `<svg width="160" height="12" viewBox="0 0 160 12" role="img" aria-label="ratio and its interval">` +
    `<line x1="80" x2="80" y2="12"/><line class="interval" x1="${from}" x2="${to}" y1="6" y2="6"/>` +
    `<circle cx="${x}" cy="6" r="3"/></svg>`
  );
}

const line = (row) =>
  `<tr class="${row.verdict.replaceAll(' ', '-')}"><td>${escape_html(row.verdict)}</td>` +
  `<td>${escape_html(row.table)}</td><td>${escape_html(row.row)}</td>` +
  `<td>${escape_html(row.change ?? row.column ?? '')}</td>` +
  `<td class="number">${row.ratio === undefined ? '' : format_number(row.ratio)}</td>` +
  `<td class="number">${row.ratio === undefined ? '' : `${format_number(row.low)} to ${format_number(row.high)}`}</td>` +
  `<td>${drawn(row)}</td></tr>`;

export function page_of(a, b, rows, how) {
  const sorted = rows.toSorted(
    (one, other) =>
      order.indexOf(one.verdict) - order.indexOf(other.verdict) ||
      (other.ratio ?? 0) - (one.ratio ?? 0),
  );
  const summary = counts(rows)
    .map(([verdict, count]) => `${count} ${verdict}`)
    .join(', ');
  const more = `.number { text-align: right; white-space: nowrap; }
td:nth-child(n + 3) { overflow-wrap: anywhere; }
td:first-child { white-space: nowrap; }
:is(.slower, .changed-value, .only-before) td:first-child { font-weight: 600; }
svg line { stroke: currentColor; stroke-opacity: .4; }
svg .interval { stroke-opacity: 1; stroke-width: 2; }
svg circle { fill: currentColor; }
`;
  const body = `<h1>${escape_html(b)} beside ${escape_html(a)}</h1>
<p>${escape_html(summary || 'nothing to compare')}. ${escape_html(how)} A ratio above 1: more time after than before.
Drawn from half to twice; the upright line is 1.</p>
<table><thead><tr><th>verdict</th><th>table</th><th>row</th><th>what</th><th class="number">ratio</th>
<th class="number">interval</th><th>drawn</th></tr></thead>
<tbody>${sorted.map(line).join('\n')}</tbody></table>`;
  return plain_page(`${b} beside ${a}`, body, { width: '80rem', more });
}
