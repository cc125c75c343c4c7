// The figures in reading order.
import { calibrate_points } from './calibrate_points.mjs';
import { cost_by_model } from './cost_by_model.mjs';
import { cost_choices } from './cost_choices.mjs';
import { cost_of_accuracy } from './cost_of_accuracy.mjs';
import { hard_cases } from './hard_cases.mjs';
import { hard_cases_summary } from './hard_cases_summary.mjs';
import { validation } from './validation.mjs';
import { validation_orders } from './validation_orders.mjs';
import { validation_tests } from './validation_tests.mjs';
import { bdf_order } from './bdf_order.mjs';
import { block_descent } from './block_descent.mjs';
import { cosserat_map } from './cosserat_map.mjs';
import { cost_of_gradient } from './cost_of_gradient.mjs';
import { damping } from './damping.mjs';
import { divided_heads } from './divided_heads.mjs';
import { figure_title } from './common.mjs';
import { drift_cost } from './drift_cost.mjs';
import { drift_heatmap } from './drift_heatmap.mjs';
import { drift_recovery } from './drift_recovery.mjs';
import { family } from './family.mjs';
import { force_transport } from './force_transport.mjs';
import { head_accuracy } from './head_accuracy.mjs';
import { model_steps } from './model_steps.mjs';
import { newest_methods } from './newest_methods.mjs';
import { nodal_steps } from './nodal_steps.mjs';
import { scaling } from './scaling.mjs';
import { stability_limit } from './stability_limit.mjs';
import { swing } from './swing.mjs';
import { tolerance } from './tolerance.mjs';
import { work_models } from './work_models.mjs';
import { work_precision } from './work_precision.mjs';

export const figures = [
  validation,
  validation_tests,
  validation_orders,
  hard_cases_summary,
  hard_cases,
  cost_of_accuracy,
  cost_choices,
  cost_by_model,
  family,
  drift_cost,
  drift_heatmap,
  drift_recovery,
  work_precision,
  work_models,
  tolerance,
  bdf_order,
  stability_limit,
  model_steps,
  nodal_steps,
  scaling,
  head_accuracy,
  swing,
  force_transport,
  damping,
  cost_of_gradient,
  calibrate_points,
  divided_heads,
  block_descent,
  cosserat_map,
  newest_methods,
];

// A Vega-Lite spec for `width` pixels, or undefined when the tables hold nothing to draw. Its
// title is the finding that the figure shows, computed from the tables.
export function figure_spec(figure, tables, options) {
  if (figure.rows(tables).length === 0) return undefined;
  const headline = figure.headline(tables);
  const reading =
    typeof figure.reading === 'function' ? figure.reading(tables) : figure.reading;
  const spec = figure.spec(tables, options);
  return {
    $schema: 'https://vega.github.io/schema/vega-lite/v6.json',
    description: `${headline}. ${figure.describe(tables)}`.replace(/\s+/g, ' '),
    padding: 4,
    autosize: { type: 'pad', contains: 'padding' },
    ...spec,
    title: figure_title(headline, reading, options),
  };
}
