const of_family_by_tolerance = {
  command:
    'family --set study=tolerance --set family=hair --models super_helix,articulated_chain,der ' +
    '--out results/family_tolerance.csv',
  program: 'family',
  optional: true,
};

// The tables the page knows: which columns must exist, which hold numbers, how to make
// the file.
export const known_tables = {
  validation: {
    title: 'Validation',
    required: ['test', 'model', 'elements', 'parameter', 'measured', 'reference', 'status'],
    numeric: [
      'elements',
      'parameter',
      'measured',
      'reference',
      'error_rel',
      'accepted_error_rel',
      'order',
      'dt_s',
      'rtol',
      't_end_s',
      'linear_error_rel',
      'angular_error_rel',
      'angular_change_rel',
      'energy_change_rel',
      'steps',
    ],
    command: './tress run',
    program: 'validation',
  },
  hard_cases: {
    title: 'Hard cases',
    required: ['case', 'model', 'integrator', 'dt_s', 'outcome'],
    numeric: [
      'dt_s',
      'position_tol_rel',
      'measure',
      'limit',
      'error_rel',
      'error_limit',
      'reference_gap',
      't_s',
      'steps',
      'newton_iterations',
      'wall_s',
    ],
    command: './tress run',
    program: 'hard_cases',
  },
  cost_of_accuracy: {
    title: 'Cost of accuracy',
    required: ['scene', 'kind', 'model', 'integrator', 'elements', 'wall_s_per_sim_s', 'status'],
    numeric: [
      'target_error_rel',
      'budget_ms',
      'rank',
      'elements',
      'dt_s',
      'position_tol_rel',
      'error_rel',
      'error_refined_rel',
      'reference_gap',
      'refined_gap',
      'horizon_s',
      'wall_s_per_sim_s',
      'ms_per_frame',
      'cost_per_step_s',
      'length_error_rel',
      'linear_error_rel',
      'angular_error_rel',
      'energy_error_rel',
      'unknowns',
      'nonzeros',
      'cost_factor',
      'margin',
      'runs',
    ],
    command: './tress run',
    program: 'cost_of_accuracy',
  },
  family: {
    title: 'Statements on a family of hairs',
    required: ['study', 'claim', 'family', 'hair', 'gravito_bending', 'value', 'holds', 'status'],
    numeric: ['hair', 'gravito_bending', 'value', 'reduced', 'maximal', 'gap'],
    command: './tress run',
    program: 'family',
  },
  family_summary: {
    title: 'Statements on a family of hairs, distribution',
    required: ['claim', 'family', 'range', 'statement', 'hairs', 'holds_share', 'median'],
    numeric: ['hairs', 'no_answer', 'holds_share', 'decile_1', 'median', 'decile_9'],
    command: './tress run',
    program: 'family',
    optional: true,
  },
  family_tolerance: {
    title: 'Adaptive runs on a family of hairs',
    required: ['claim', 'hair', 'model', 'position_tol_rel', 'value', 'holds', 'status'],
    numeric: ['hair', 'position_tol_rel', 'value', 'growth', 'horizon_s', 'gap', 'work', 'fixed_work'],
    ...of_family_by_tolerance,
  },
  family_tolerance_summary: {
    title: 'Adaptive runs on a family of hairs, distribution',
    required: ['claim', 'family', 'range', 'model', 'integrator', 'hairs', 'holds_share', 'median'],
    numeric: ['hairs', 'no_answer', 'holds_share', 'decile_1', 'median', 'decile_9'],
    ...of_family_by_tolerance,
  },
  constraint_drift: {
    title: 'Constraint drift',
    required: [
      'study',
      'system',
      'formulation',
      'integrator',
      'alpha',
      'beta',
      'zeta',
      'dt_s',
      'g_max',
      'wall_s',
      'omega_h_predicted',
      'omega_h_measured',
      'rel_gap',
      'status',
    ],
    numeric: [
      'alpha',
      'beta',
      'zeta',
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
      'omega_h_predicted',
      'omega_h_measured',
      'rel_gap',
    ],
    command: './tress run',
    program: 'constraint_drift',
  },
  work_precision: {
    title: 'Work and precision',
    required: [
      'scene',
      'model',
      'integrator',
      'elements',
      'error_kind',
      'error_rel',
      'wall_s',
      'wall_s_per_sim_s',
      'steps',
      'status',
    ],
    numeric: [
      'elements',
      'dt_s',
      'rtol',
      'position_tol_rel',
      'max_order',
      'error_rel',
      'error_over_tolerance',
      'scd',
      'wall_s_per_sim_s',
      'wall_s',
      'steps',
      'rejected',
      'rejected_by_error',
      'rejected_by_newton',
      'smallest_step_s',
      'residuals',
      'linearizations',
      'solves',
      'order_fit',
    ],
    command: './tress run',
    program: 'work_precision',
  },
  stability_limit: {
    title: 'Largest stable time step',
    required: [
      'study',
      'scene',
      'model',
      'integrator',
      'solver',
      'jacobian',
      'elements',
      'damping',
      'dt_max_s',
      'status',
    ],
    numeric: [
      'elements',
      'dt_max_s',
      'dt_first_unstable_s',
      'tolerance_loosest',
      'tolerance_tightest',
      'steps_usual',
      'work_usual',
      'cost_per_step_s',
      'realtime_factor',
      't_claim_s',
      'energy_gain_claim_j',
      'dt_theory_s',
      'dt_bending_s',
    ],
    command: './tress run',
    program: 'stability_limit',
  },
  scaling: {
    title: 'Cost against elements',
    required: ['structure', 'model', 'solver', 'elements', 'cost_per_step_s', 'status'],
    numeric: [
      'elements',
      'cost_per_step_s',
      'cost_per_element_step_s',
      'exponent',
      'dt_max_s',
      'fps',
      'published_fps',
    ],
    command: './tress run',
    program: 'scaling',
  },
  force_transport: {
    title: 'Force transport compared with CORDE',
    required: ['comparison', 'scene', 'model', 'elements', 'youngs_modulus_pa', 'status'],
    numeric: [
      'elements',
      'youngs_modulus_pa',
      'dt_s',
      't_s',
      'corde_difference_rel',
      'rod_difference_rel',
      'deflection_error_rel',
      'lowest_t_s',
      'lowest_rel',
      'lowest_t_ratio',
      'chord_rel',
      'slowest_rad_s',
      'slowest_ratio',
      'growth_per_s',
      'complex_modes',
      'energy_growth',
      'energy_gain_rel',
      'cost_per_element_step_s',
      'cost_ratio',
    ],
    command: './tress run',
    program: 'force_transport',
  },
  damping: {
    title: 'Energy that a method takes',
    required: ['model', 'integrator', 'elements', 'dt_s', 'energy_lost_rel', 'status'],
    numeric: ['elements', 'dt_s', 'energy_lost_rel', 'steps'],
    command: './tress run',
    program: 'damping',
  },
  cost_of_gradient: {
    title: 'Error and cost of gradients',
    required: ['part', 'model', 'integrator', 'start', 'steps', 'gradient_error_rel', 'status'],
    numeric: [
      'elements',
      'steps',
      'tip_error_rel',
      'gradient_error_rel',
      'modulus_error_rel',
      'friction_error_rel',
      'drag_error_rel',
      'curvature_error_rel',
      'reference_gap',
      'tip_order',
      'gradient_order',
      'linearizations_1_percent',
      'linearizations_001_percent',
      'linearizations',
      'time_s',
    ],
    command: './tress run',
    program: 'cost_of_gradient',
  },
  calibrate_points: {
    title: 'Measured and fitted points',
    required: ['record', 'strand', 'point', 'time_s', 'component', 'measured_m', 'fitted_m'],
    numeric: ['strand', 'time_s', 'measured_m', 'sigma_m', 'fitted_m'],
    command: 'calibrate --scene scene.toml --set data=record.csv --out results/calibrate.csv',
    program: 'calibrate',
    optional: true,
  },
  divided_heads: {
    title: 'A head that processes divide',
    required: ['kind', 'effects', 'strands', 'ranks', 'cost_per_step_s', 'status'],
    numeric: [
      'strands',
      'ranks',
      'cores',
      'cost_per_step_s',
      'ghosts_per_strand',
      'ghost_search_per_element_s',
      'halo_exchange_per_element_s',
      'ghost_contact_per_element_s',
      'beside',
      'memory_mb',
      'model_cost_per_step_s',
      'model_off_rel',
      'held_out_off_rel',
      'model_ghosts_per_strand',
      'efficiency',
    ],
    command: './tress run',
    program: 'divided_heads',
  },
  block_descent: {
    title: 'Sweeps of block descent',
    required: ['part', 'scene', 'model', 'integrator', 'dt_s', 'sweeps', 'status'],
    numeric: [
      'elements',
      'stretch_over_bending',
      'dt_s',
      'sweeps',
      'block',
      'chebyshev',
      'anderson',
      'penalty_per_s2',
      'primal_sweeps',
      'direct_distance_rel',
      'direct_error_rel',
      'error_rel',
      'reference_gap_rel',
      'energy_distance_rel',
      'steps',
      'wall_s_per_sim_s',
    ],
    command: './tress run',
    program: 'block_descent',
  },
  other_simulators_swing: {
    title: 'Published rows of other simulators on the swinging strand',
    required: ['simulator', 'wall_1pct_s', 'wall_0p1pct_s'],
    numeric: [
      'stable_dt_n5_s',
      'stable_dt_n20_s',
      'stable_dt_n80_s',
      'us_per_step_n20',
      'wall_1pct_s',
      'dt_1pct_s',
      'wall_0p1pct_s',
    ],
    command: 'git checkout -- results/other_simulators_swing.csv',
    program: 'work_precision',
    optional: true,
  },
};

// The rows of one study of a table that has several.
export const study_rows = (tables, name, study) =>
  (tables[name] ?? []).filter((row) => row.study === study);

export const is_known = (name) => Object.hasOwn(known_tables, name);
export const table_rules = (name) => (is_known(name) ? known_tables[name] : {});

// Row predicates shared by figures and findings.
export const is_number = (value) => typeof value === 'number' && Number.isFinite(value);
export const is_positive = (value) => is_number(value) && value > 0;
export const succeeded = (row) => row.status === 'ok';
export const is_set = (flag) => /^(1|true|yes)$/i.test(String(flag ?? ''));
export const distinct = (values) => [...new Set(values)];

// Rows of work_precision.csv by their question. First the swinging strand on which other
// simulators were measured.
export const swing_rows = ({ work_precision = [] }) =>
  work_precision.filter((row) => row.scene === 'swing');

// The maximum order of BDF on the Beam, compared with methods that are stable on the imaginary
// axis and Adams.
const beside_bdf = [
  'arkode_dirk',
  'cvode_adams',
  'generalized_alpha',
  'implicit_midpoint',
  'bdf2',
];
export const order_rows = ({ work_precision = [] }) =>
  work_precision
    .filter(
      (row) =>
        row.scene === 'beam' &&
        (is_positive(row.max_order) || beside_bdf.includes(row.integrator)),
    )
    .map((row) => ({
      ...row,
      label: is_positive(row.max_order)
        ? `${row.integrator} <= ${row.max_order}`
        : row.integrator,
    }));

// Every integrator on every other problem, BDF with its default order.
const usual_order = 2;
export const problem_rows = ({ work_precision = [] }) =>
  work_precision.filter(
    (row) =>
      row.scene !== 'swing' && (!is_positive(row.max_order) || row.max_order === usual_order),
  );

// The problem a row of work_precision.csv belongs to: total errors apart from time errors.
export const problem_name = (row) =>
  row.scene.replaceAll('_', ' ') + (row.error_kind === 'total' ? ', total error' : '');

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
