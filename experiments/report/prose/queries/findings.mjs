// The sentences of the report page, as lists.
import { hard_findings } from '../../figures/hard_cases.mjs';
import { model_step_findings } from '../../figures/model_steps.mjs';
import { nodal_step_findings } from '../../figures/nodal_steps.mjs';
import { descent_findings, map_findings } from '../../figures/block_descent.mjs';
import { transport_findings } from '../../figures/force_transport.mjs';
import { validation_findings } from '../../figures/validation.mjs';
import { boundary_sentences, drift_findings, recovery_sentences } from '../../src/findings/drift.mjs';
import { scaling_findings } from '../../src/findings/scaling.mjs';
import { stability_findings } from '../../src/findings/stability.mjs';
import { control_findings } from '../../src/findings/tolerance.mjs';
import { swing_findings } from '../../src/findings/swing.mjs';
import { bdf_findings, field_table, order_table, work_findings } from '../../src/findings/work.mjs';
import { bullets, table } from '../markdown.mjs';

const usual_most = 12; // the report page has the rest

const listed = (sentences, most = usual_most) => (tables) => {
  const all = sentences(tables);
  if (all.length === 0) throw new Error('the tables hold no rows for these sentences');
  const rest = all.length - most;
  return bullets(
    rest > 0 ? [...all.slice(0, most), `${rest} more sentences are on the report page.`] : all,
  );
};

// With the figure, which there is only where the table has such rows.
export const control = (tables) => {
  const found = control_findings(tables);
  return found.length === 0
    ? 'The table has no adaptive run yet.'
    : `![Error over tolerance](../../results/tolerance.svg)\n\n${bullets(found)}`;
};
export const bdf = listed(bdf_findings);
export const boundary = listed(boundary_sentences);
export const descent = listed(descent_findings);
export const drift = listed(drift_findings);
export const fields = (tables) =>
  table(['problem', 'error', 'integrators', 'runs'], field_table(tables));
export const orders = (tables) =>
  table(['integrator', 'problems', 'median order', 'lowest', 'highest'], order_table(tables));
export const hard = listed(hard_findings);
export const map = listed(map_findings);
export const models = listed(model_step_findings);
export const nodal = listed(nodal_step_findings);
export const recovery = listed(({ constraint_drift }) => recovery_sentences(constraint_drift));
export const scaling = listed(scaling_findings);
export const stability = listed(stability_findings);
export const swing = listed(swing_findings);
export const transport = listed(transport_findings);
// Sorted by success: without its end the list would leave out the models that fail.
export const validation = listed(validation_findings, Infinity);
export const work = listed(work_findings);
