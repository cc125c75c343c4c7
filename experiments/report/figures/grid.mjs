// A scan over (alpha, beta) as cells with edges half-way between the scanned values.
import { is_number } from '../src/tables.mjs';

const sorted_unique = (values) => [...new Set(values.filter(is_number))].sort((a, b) => a - b);

// {log, edges(value) -> [low, high], domain, ticks, zero}; `zero` is where 0 is drawn on a log
// axis (one cell below the smallest positive value), undefined when there is none.
export function cell_axis(raw) {
  const values = sorted_unique(raw);
  const positive = values.filter((v) => v > 0);
  const log = positive.length > 1 && values[0] >= 0 &&
    positive.at(-1) / positive[0] > 20;
  const zero = log && values[0] === 0 ? positive[0] ** 2 / positive[1] : undefined;
  const place = (v) => (log ? Math.log10(v === 0 ? zero : v) : v);
  const at = values.map(place);
  const back = (v) => (log ? 10 ** v : v);
  const edge = (i) => {
    if (at.length === 1) return at[0] + (i === 0 ? -0.5 : 0.5);
    if (i === 0) return at[0] - (at[1] - at[0]) / 2;
    if (i === at.length) return at[i - 1] + (at[i - 1] - at[i - 2]) / 2;
    return (at[i - 1] + at[i]) / 2;
  };
  return {
    log, zero,
    shown: (v) => back(place(v)),
    edges: (v) => [back(edge(values.indexOf(v))), back(edge(values.indexOf(v) + 1))],
    domain: [back(edge(0)), back(edge(at.length))],
  };
}
