// Numbers and HTML text as the page prints them.

export const escape_html = (text) =>
  String(text).replace(
    /[&<>"']/g,
    (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;', "'": '&#39;' })[c],
  );

// Three significant digits by default; 1.2e-5 outside [1e-3, 1e6).
export function format_number(value, digits = 3) {
  if (typeof value !== 'number')
    return value === null || value === undefined ? '' : String(value);
  if (value === 0) return '0';
  const magnitude = Math.abs(value);
  if (Number.isInteger(value) && magnitude < 1e7) return String(value);
  if (magnitude >= 1e-3 && magnitude < 1e6)
    return String(Number(value.toPrecision(digits)));
  return value
    .toExponential(digits - 1)
    .replace(/\.?0+e/, 'e')
    .replace('e+', 'e');
}

// "3.2 times", "1.05 times": a ratio in words' company.
export function format_ratio(ratio) {
  if (ratio >= 1e4) return `${format_number(ratio, 2)} times`;
  return `${ratio < 10 ? ratio.toPrecision(2) : Number(ratio.toPrecision(3))} times`;
}

// Inline SI time; the tables keep seconds.
export function format_time(seconds) {
  if (seconds >= 1) return `${format_number(seconds)} s`;
  if (seconds >= 1e-3) return `${format_number(seconds * 1e3)} ms`;
  return `${format_number(seconds * 1e6)} µs`;
}

// The steps of a run, given or chosen with error control; a table may know their mean.
export function format_steps(row, time = format_time) {
  if (typeof row.position_tol_rel !== 'number') return time(row.dt_s);
  const mean = row.mean_step_s > 0 ? `, mean step ${format_time(row.mean_step_s)}` : '';
  return `adaptive (tolerance ${format_number(row.position_tol_rel)}${mean})`;
}

// Two numbers where the result of a run is extrapolated from them.
export const format_elements = (row) =>
  String(row.extrapolated) === 'true'
    ? `${row.elements} and ${Math.ceil(row.elements / 2)}`
    : `${row.elements}`;
