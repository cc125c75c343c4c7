// quoted.mjs RESULTS: sentences and rows that the report page computes and other pages quote, as
// JSON {name: {tables, value}}, or {name: {tables, error}} where the tables do not allow it.
import { figures } from './figures/all.mjs';
import { descent_findings } from './figures/block_descent.mjs';
import { map_findings } from './figures/cosserat_map.mjs';
import { transport_findings } from './figures/force_transport.mjs';
import { hard_findings } from './figures/hard_cases.mjs';
import { family_runs, newest } from './figures/newest_methods.mjs';
import { nodal_step_findings } from './figures/nodal_steps.mjs';
import { validation_cells } from './figures/validation.mjs';
import { validation_orders } from './figures/validation_orders.mjs';
import { boundary_sentences, drift_findings, recovery_sentences } from './src/findings/drift.mjs';
import { scaling_findings } from './src/findings/scaling.mjs';
import { stability_findings } from './src/findings/stability.mjs';
import { swing_findings } from './src/findings/swing.mjs';
import { control_findings } from './src/findings/tolerance.mjs';
import {
  bdf_findings,
  bdf_table,
  cheapest_table,
  field_table,
  levels,
  order_table,
  work_findings,
} from './src/findings/work.mjs';
import { hard_rows, judged, not_compared, rank, survives } from './src/hard.mjs';
import { InputError } from './src/input.mjs';
import { load_results } from './src/load.mjs';
import { all_objects } from './src/objects.mjs';
import { by_tolerance, pace } from './src/pace.mjs';
import { solver_pairs, swing_levels, swing_runs } from './src/strand.mjs';
import { swing_rows } from './src/tables.mjs';

const as_counted = (row) => ({
  ...row,
  pace: pace(row),
  by_tolerance: by_tolerance(row),
  rank: rank(row),
  survives: survives(row),
  compared: row.outcome !== not_compared,
});

// The tables that each figure is drawn from.
const figure_tables = (tables) =>
  Object.fromEntries(
    figures.map((figure) => [figure.id, answer((all) => figure.rows(all), tables).tables]),
  );

const quoted = {
  bdf: bdf_findings,
  bdf_steps: bdf_table,
  boundary: boundary_sentences,
  control: control_findings,
  descent: descent_findings,
  cheapest: cheapest_table,
  drift: drift_findings,
  fields: field_table,
  figures: figure_tables,
  orders: order_table,
  hard: hard_findings,
  map: map_findings,
  nodal: nodal_step_findings,
  recovery: ({ constraint_drift = [] }) => recovery_sentences(constraint_drift),
  scaling: scaling_findings,
  stability: stability_findings,
  swing: swing_findings,
  transport: transport_findings,
  work: work_findings,
  work_levels: () => levels,
  hard_judged: (tables) => judged(tables).map(as_counted),
  hard_rows: (tables) => hard_rows(tables).map(as_counted),
  newest_methods: () => newest,
  runs_by_time_error: (tables) => family_runs(tables, 'time'),
  runs_by_total_error: (tables) => family_runs(tables, 'total'),
  solver_pairs: ({ scaling = [] }) => solver_pairs(scaling),
  swing_levels: () => swing_levels,
  swing_by_time_error: (tables) => swing_runs(swing_rows(tables), 'time'),
  swing_by_total_error: (tables) => swing_runs(swing_rows(tables), 'total'),
  validation_cells,
  validation_orders: validation_orders.rows,
};

// The same tables; the name of each that is read goes into `read`.
const watched = (tables, read) =>
  new Proxy(tables, {
    get(all, name) {
      if (typeof name === 'string' && Object.hasOwn(all, name)) read.add(name);
      return all[name];
    },
  });

function answer(compute, tables) {
  const read = new Set();
  try {
    const value = compute(watched(tables, read));
    return { tables: [...read], value };
  } catch (error) {
    return { tables: [...read], error: error.message };
  }
}

try {
  const warnings = [];
  const tables = all_objects(load_results(process.argv[2], (text) => warnings.push(text)));
  if (warnings.length > 0) throw new InputError(warnings[0]);
  const all = Object.entries(quoted).map(([name, compute]) => [name, answer(compute, tables)]);
  process.stdout.write(JSON.stringify(Object.fromEntries(all)));
} catch (error) {
  if (!(error instanceof InputError)) throw error;
  console.error(error.message);
  process.exitCode = 2;
}
