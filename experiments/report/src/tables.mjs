// The tables the page knows: which columns must exist, which hold numbers, how to make
// the file.

export const known_tables = {
  constraint_drift: {
    title: 'Constraint drift',
    required: [
      'study',
      'system',
      'formulation',
      'integrator',
      'alpha',
      'beta',
      'dt_s',
      'g_max',
      'wall_s',
      'status',
    ],
    numeric: [
      'alpha',
      'beta',
      'dt_s',
      't_end_s',
      'violation',
      'g_max',
      'g_final',
      'g_rate_max',
      'energy_drift_rel',
      'recovery_time_s',
      'overshoot',
      'steps',
      'wall_s',
    ],
    command: './tress run',
    program: 'constraint_drift',
  },
  baumgarte_limit: {
    title: 'Measured and predicted stability boundary',
    required: [
      'integrator',
      'zeta',
      'omega_h_predicted',
      'omega_h_measured',
      'rel_gap',
      'dt_s',
      'status',
    ],
    numeric: ['zeta', 'omega_h_predicted', 'omega_h_measured', 'rel_gap', 'dt_s'],
    command: './tress run',
    program: 'baumgarte_limit',
  },
  drift_region: {
    title: 'Predicted stability region',
    required: ['integrator', 'dt_s', 'alpha', 'beta', 'i'],
    numeric: ['dt_s', 'alpha', 'beta', 'i'],
    command: './tress run',
    program: 'constraint_drift',
    optional: true,
  },
  work_precision: {
    title: 'Work and precision',
    required: ['scene', 'integrator', 'error_rel', 'wall_s_per_sim_s', 'status'],
    numeric: [
      'elements',
      'dt_s',
      'rtol',
      'max_order',
      'error_rel',
      'scd',
      'wall_s_per_sim_s',
      'wall_s',
      'steps',
      'rejected',
      'residuals',
      'linearizations',
      'solves',
      'order_fit',
    ],
    command: './tress run',
    program: 'work_precision',
  },
  bdf_order: {
    title: 'BDF order on a rod',
    required: ['scene', 'integrator', 'label', 'error_rel', 'steps', 'wall_s', 'status'],
    numeric: ['max_order', 'rtol', 'error_rel', 'scd', 'steps', 'wall_s'],
    command: './tress run',
    program: 'work_precision',
  },
};

// Row predicates shared by figures and findings.
export const is_number = (value) => typeof value === 'number' && Number.isFinite(value);
export const is_positive = (value) => is_number(value) && value > 0;
export const succeeded = (row) => row.status === 'ok';
export const is_set = (flag) => /^(1|true|yes)$/i.test(String(flag ?? ''));
export const distinct = (values) => [...new Set(values)];

export function group_by(rows, key) {
  const groups = new Map();
  for (const row of rows) {
    const k = key(row);
    if (!groups.has(k)) groups.set(k, []);
    groups.get(k).push(row);
  }
  return groups;
}

export const minimum_by = (rows, value) =>
  rows.reduce(
    (best, row) => (best === undefined || value(row) < value(best) ? row : best),
    undefined,
  );
