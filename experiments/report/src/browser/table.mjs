// Sortable, filterable table; headers are buttons, so the keyboard does what the mouse
// does.
import { format_number } from '../format.mjs';

const first_rows = 100;

function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

// Numbers by size, then nan and inf, then empty; text by its own order.
function compare(a, b, numeric) {
  if (!numeric) return String(a).localeCompare(String(b), 'en', { numeric: true });
  const rank = (v) => (typeof v === 'number' ? 0 : v === null ? 2 : 1);
  if (rank(a) !== rank(b)) return rank(a) - rank(b);
  return rank(a) === 0 ? a - b : String(a).localeCompare(String(b));
}

// Empty cells stay last whichever way the column is sorted.
function sorted(rows, { column, descending }, numeric) {
  if (column === undefined) return rows;
  const empty = (v) => v === null || v === '';
  return [...rows].sort((a, b) => {
    const [x, y] = [a[column], b[column]];
    if (empty(x) !== empty(y)) return empty(x) ? 1 : -1;
    return (descending ? -1 : 1) * compare(x, y, numeric);
  });
}

// RFC 4180; numbers as short as they come back the same.
function csv_text({ columns, rows }) {
  const field = (value) => {
    const text = String(value ?? '');
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const lines = [columns.map(({ name }) => name), ...rows];
  return lines.map((line) => `${line.map(field).join(',')}\r\n`).join('');
}

function save_button(name, table) {
  const button = element('button', { type: 'button' }, 'Save as CSV');
  button.addEventListener('click', () => {
    const file = new Blob([csv_text(table)], { type: 'text/csv' });
    const link = element('a', { href: URL.createObjectURL(file), download: `${name}.csv` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
  return button;
}

export function fill_table(details, table) {
  const { columns, rows } = table;
  const shown = columns
    .map((column, i) => ({ ...column, i }))
    .filter(
      ({ i }) =>
        rows.length === 0 || rows.some((row) => row[i] !== null && row[i] !== ''),
    );
  const status = columns.findIndex(({ name }) => name === 'status');
  const state = { column: undefined, descending: false, filter: '', all: false };

  const count = element('span', { class: 'count', role: 'status' });
  const filter = element('input', {
    type: 'search',
    placeholder: 'Filter rows',
    'aria-label': 'Filter rows: every word must occur in the row',
  });
  const more = element('button', { type: 'button', class: 'more-rows' });
  const body = element('tbody');
  const heads = shown.map(({ name, numeric, i }) => {
    const button = element('button', { type: 'button' }, name);
    button.addEventListener('click', () => {
      state.descending = state.column === i && !state.descending;
      state.column = i;
      update();
    });
    return element('th', { scope: 'col', class: numeric ? 'number' : 'text' }, button);
  });

  function cell(row, { numeric, i }) {
    const value = row[i];
    const text = numeric ? format_number(value, 4) : value;
    const td = element('td', { class: numeric ? 'number' : 'text' }, text);
    if (numeric && typeof value === 'number' && String(value) !== text)
      td.title = String(value);
    return td;
  }

  function update() {
    const words = state.filter.toLowerCase().split(/\s+/).filter(Boolean);
    const kept = rows.filter((row) => {
      const text = row.join(' ').toLowerCase();
      return words.every((word) => text.includes(word));
    });
    const numeric = columns[state.column]?.numeric;
    const ordered = sorted(kept, state, numeric);
    const visible = state.all ? ordered : ordered.slice(0, first_rows);
    body.replaceChildren(
      ...visible.map((row) => {
        const failed = status >= 0 && row[status] !== 'ok';
        return element(
          'tr',
          failed ? { class: 'failed' } : {},
          ...shown.map((c) => cell(row, c)),
        );
      }),
    );
    heads.forEach((head, k) => {
      if (shown[k].i === state.column) {
        head.setAttribute('aria-sort', state.descending ? 'descending' : 'ascending');
      } else {
        head.removeAttribute('aria-sort');
      }
    });
    count.textContent =
      kept.length === rows.length
        ? `${rows.length} rows`
        : `${kept.length} of ${rows.length} rows`;
    more.hidden = visible.length === ordered.length;
    more.textContent = `Show all ${ordered.length} rows`;
  }

  filter.addEventListener('input', () => {
    state.filter = filter.value;
    update();
  });
  more.addEventListener('click', () => {
    state.all = true;
    update();
  });
  const label = details.querySelector('summary').textContent;
  details.append(
    element(
      'div',
      { class: 'table-tools' },
      filter,
      count,
      save_button(details.dataset.table, table),
    ),
    element(
      'div',
      { class: 'table-box', tabindex: '0', role: 'region', 'aria-label': label },
      element('table', {}, element('thead', {}, element('tr', {}, ...heads)), body),
    ),
    more,
  );
  update();
}
