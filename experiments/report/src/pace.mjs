// How a run takes its steps: of one length, or so that its error keeps a tolerance.
import { format_time } from './format.mjs';
import { is_number } from './tables.mjs';

export const by_tolerance = (row) => is_number(row.position_tol_rel);

export const pace = (row) =>
  by_tolerance(row)
    ? `tolerance ${row.position_tol_rel.toExponential()}`
    : format_time(row.dt_s);

// Steps from short to long, then tolerances from tight to loose.
export const by_pace = (a, b) =>
  by_tolerance(a) - by_tolerance(b) ||
  (a.position_tol_rel || 0) - (b.position_tol_rel || 0) ||
  a.dt_s - b.dt_s;
