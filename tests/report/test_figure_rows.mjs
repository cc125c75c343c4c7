// What figures draw and findings state, without drawing: `node --test tests/report/test_figure_rows.mjs`.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { paper_theme, spread } from '../../experiments/report/figures/common.mjs';
import { model_steps } from '../../experiments/report/figures/model_steps.mjs';
import { nodal_steps } from '../../experiments/report/figures/nodal_steps.mjs';
import {
  limit_headline,
  limit_spec,
  stability_limit,
} from '../../experiments/report/figures/stability_limit.mjs';
import {
  validation_cells,
  validation_findings,
} from '../../experiments/report/figures/validation.mjs';
import {
  orders_of,
  validation_orders,
} from '../../experiments/report/figures/validation_orders.mjs';
import { drift_findings } from '../../experiments/report/src/findings/drift.mjs';
import { control_findings } from '../../experiments/report/src/findings/tolerance.mjs';
import { hard_cases, hard_findings } from '../../experiments/report/figures/hard_cases.mjs';
import { calibrate_points } from '../../experiments/report/figures/calibrate_points.mjs';
import { divided_heads } from '../../experiments/report/figures/divided_heads.mjs';
import { damping } from '../../experiments/report/figures/damping.mjs';
import { hard_rows, judged, not_compared } from '../../experiments/report/src/hard.mjs';
import { order_table, work_findings } from '../../experiments/report/src/findings/work.mjs';
import { outcome_text } from '../../experiments/report/src/outcome.mjs';
import { stability_findings } from '../../experiments/report/src/findings/stability.mjs';

const by_tolerance = (integrator, tolerance, error_over_tolerance, more = {}) => ({
  scene: 'swing',
  model: 'super_helix',
  error_kind: 'time',
  status: 'ok',
  integrator,
  position_tol_rel: tolerance,
  error_over_tolerance,
  ...more,
});

test('ControlFindings_CountTheRunsWithinTheBoundsAndNameTheWorst', () => {
  const work_precision = [
    by_tolerance('tr_bdf2', 1e-2, 0.04),
    by_tolerance('tr_bdf2', 1e-3, 0.5),
    by_tolerance('tr_bdf2', 1e-4, 2),
    by_tolerance('tr_bdf2', 1e-5, 90, { below_reference: 'true' }),
    by_tolerance('esdirk43', 1e-2, 0.1),
    by_tolerance('esdirk43', 1e-3, null, { status: 'solver_error' }),
  ];
  assert.deepEqual(control_findings({ work_precision }), [
    '`tr_bdf2`: error over tolerance 0.04 to 2, between 0.05 and 1 in 1 of 3 runs. It is above the ' +
      'tolerance in 1 run, with the largest value on `super_helix` (swing, 1e-4: 2).',
    '`esdirk43`: error over tolerance 0.1 to 0.1, between 0.05 and 1 in 1 of 1 runs.',
  ]);
  assert.deepEqual(control_findings({}), []);
});

test('Outcome_SaysErrorsWithTheirHorizonOrWhyThereAreNone', () => {
  assert.equal(outcome_text({}), '');
  assert.equal(outcome_text(undefined), '');
  const text = outcome_text({
    steps: 50,
    rejected_steps: 3,
    time_error_max_rel: 0.02,
    time_error_rms_rel: 0.01,
    time_horizon_s: 0.5,
    space_error_missing: 'the model brings its own elements',
  });
  assert.equal(
    text,
    '50 steps, 3 rejected. Estimated error in time, over the length: at most 0.02, root mean ' +
      'square 0.01, until 0.5 s, from where the run and a finer one are different motions. ' +
      'No error in space: the model brings its own elements.',
  );
});

test('Spread_KeepsTheOrderAndTheGap', () => {
  assert.deepEqual(spread([50, 10, 52], 13, 330), [50, 10, 63]);
  assert.deepEqual(spread([329, 330, 5], 10, 330), [320, 330, 5]);
});

test('OrdersOfTwoPoints_AreMarked', () => {
  const rows = [10, 20, 40].map((elements) => ({
    test: 'cantilever',
    model: 'der',
    elements,
    parameter: 1,
    error_rel: 1 / elements ** 2,
  }));
  const two = rows.slice(0, 2).map((row) => ({ ...row, model: 'corde' }));
  const drawn = validation_orders.rows({ validation: [...rows, ...two] });
  assert.deepEqual(
    drawn.map(({ points }) => points),
    [3, 3, 3, 2, 2],
  );
  assert.deepEqual(
    orders_of({ validation: [...rows, ...two] }).map(({ order, fit }) => [Math.round(order), fit]),
    [
      [2, 'three or more'],
      [2, 'two numbers of elements'],
    ],
  );
});

test('Studies_OfOneTableAreDrawnApart', () => {
  const row = {
    scene: 'release',
    model: 'super_helix',
    integrator: 'linearly_implicit_euler',
    solver: 'recursive',
    jacobian: 'elastic',
    modes: 'bend_twist',
    damping: 'none',
    elements: 20,
    dt_max_s: 1e-3,
    status: 'ok',
  };
  const drawn = (study, figure) => figure.rows({ stability_limit: [{ ...row, study }] }).length;
  assert.deepEqual(
    [stability_limit, model_steps, nodal_steps].map((figure) => drawn('grid', figure)),
    [1, 1, 0],
  );
  assert.deepEqual(
    [stability_limit, model_steps, nodal_steps].map((figure) => drawn('nodal', figure)),
    [0, 0, 1],
  );
  const nodal = { ...row, study: 'nodal', status: 'gave_up' };
  assert.deepEqual(stability_findings({ stability_limit: [nodal] }), []);
  const limit = { study: 'limit', status: 'unstable' };
  assert.deepEqual(drift_findings({ constraint_drift: [limit] }), []);
});

test('FreeFlight_IsNoTestOfAModel', () => {
  const row = { model: 'der', elements: 10, status: 'ok' };
  const cells = validation_cells({
    validation: [
      { ...row, test: 'cantilever', error_rel: 0.001, accepted_error_rel: 0.01, judged: 'true', passed: 'true' },
      { ...row, test: 'free_flight', integrator: 'rk4', status: 'diverged' },
    ],
  });
  assert.deepEqual(
    cells.map(({ test: name }) => name),
    ['cantilever'],
  );
});

test('TestLeftOut_IsNeitherMetNorRefused', () => {
  const row = { model: 'der', elements: 10, status: 'ok' };
  const refused = { model: 'der', status: 'refused' };
  const met = { error_rel: 0.001, accepted_error_rel: 0.01, judged: 'true', passed: 'true' };
  const tables = {
    validation: [
      { ...row, ...met, test: 'cantilever' },
      { ...refused, test: 'plectoneme', reason: 'takes minutes: left out by --quick' },
      { ...refused, test: 'ring', reason: 'without twist' },
    ],
  };
  assert.deepEqual(
    validation_cells(tables).map(({ outcome }) => outcome),
    ['within', 'left out', 'does not apply'],
  );
  assert.deepEqual(validation_findings(tables), ['`der` meets 1 of 1 tests (1 left out).']);
});

test('LowerBounds_AreNoLimits', () => {
  const row = (elements, dt_max_s, limited_by) => ({
    scene: 'shake',
    model: 'der',
    integrator: 'linearly_implicit_euler',
    damping: 'none',
    method: 'der',
    elements,
    dt_max_s,
    limited_by,
    status: 'ok',
  });
  const rows = [row(5, 0.01, 'energy'), row(10, 0.1, 'cap'), row(20, 0.02, 'energy')];
  const { concat } = limit_spec(rows, { width: 1000, theme: paper_theme });
  const [limits, bounds] = concat[0].layer.map(({ data }) => data.values);
  assert.deepEqual(limits.map(({ elements }) => elements), [5, 20]);
  assert.deepEqual(bounds.map(({ elements, dt_ms }) => [elements, dt_ms]), [[10, 100]]);
  assert.match(limit_headline(rows), /“der” is stable up to the longest step tried in 0 of 1 cases/);
});

const hard_run = (more) => ({
  case: 'cone',
  model: 'der',
  variant: '',
  integrator: 'backward_euler',
  dt_s: 1e-3,
  outcome: 'stable',
  error_rel: null,
  ...more,
});

test('StableWithoutAReference_HasAMarkOfItsOwn', () => {
  const tables = {
    hard_cases: [
      hard_run({ model: 'der' }),
      hard_run({ model: 'corde', error_rel: 0.2 }),
      hard_run({ model: 'xpbd', error_rel: 0.01, outcome: 'stable and accurate' }),
    ],
  };
  assert.deepEqual(
    hard_rows(tables).map((row) => row.outcome),
    [not_compared, 'stable', 'stable and accurate'],
  );
  assert.deepEqual(hard_cases.rows(tables).map((row) => row.letter), ['N', 'S', 'A']);
});

test('AShortenedCase_CountsWhereItWasRunWholeOrFails', () => {
  const long = (more) => hard_run({ case: 'million_steps', steps: 5000, error_rel: 0.2, ...more });
  const tables = {
    hard_cases: [long(), long({ dt_s: 1 / 30 }), hard_run({ error_rel: 0.1 }), hard_run({ dt_s: 1 / 30, error_rel: 0.1 })],
    hard_cases_million_steps: [long({ steps: 1e6, outcome: 'unstable' })],
  };
  assert.deepEqual(
    judged(tables).map((row) => [row.case, row.dt_s, row.outcome]),
    [['cone', 1e-3, 'stable'], ['cone', 1 / 30, 'stable'], ['million_steps', 1e-3, 'unstable']],
  );
  assert.match(hard_findings(tables)[0], /survives 1 of the 1 cases/);
  assert.ok(hard_cases.rows(tables).some((row) => row.situation === 'million steps, cut to 5000'));
  const failed = { ...tables, hard_cases: tables.hard_cases.map((row) => ({ ...row, outcome: 'unstable' })) };
  assert.deepEqual(
    judged(failed).filter((row) => row.case === 'million_steps').map((row) => [row.dt_s, row.cut]).sort((a, b) => a[0] - b[0]),
    [[1e-3, 0], [1 / 30, 5000]],
    'a run that fails within its first 5000 steps counts, once',
  );
  assert.match(hard_findings(failed)[0], /survives 0 of the 2 cases/);
  const whole = { hard_cases: [long({ steps: 1e6 })] };
  assert.equal(judged(whole).length, 1, 'a table that was run whole is not cut');
});

test('HardCases_StateWhichHalfIsWhichStep', () => {
  const rows = [1e-3, 1 / 30].map((dt_s) => hard_run({ dt_s }));
  assert.match(
    hard_cases.reading({ hard_cases: rows }),
    /^In each cell, from left to right: 1 ms, 33\.3 ms\./,
  );
});

test('DividedHeads_DrawWhatWasMeasured', () => {
  const row = { effects: 'drag', status: 'ok', beside: 1, strands: 1000, ranks: 2 };
  const tables = {
    divided_heads: [
      { ...row, kind: 'measured', cost_per_step_s: 2e-3, model_cost_per_step_s: 1.9e-3 },
      { ...row, kind: 'measured', beside: 2, cost_per_step_s: 3e-3 },
      { ...row, kind: 'predicted', beside: null, ranks: 64, strands: 1e6, model_cost_per_step_s: 1e-3 },
    ],
  };
  const { concat } = divided_heads.spec(tables, { width: 1000, theme: paper_theme });
  const points = concat[0].layer.find(({ mark }) => mark.type === 'point');
  assert.deepEqual(points.data.values.map((one) => one.cost_ms), [2]);
});

test('Damping_KeepsTheSign', () => {
  const row = { model: 'der', integrator: 'bdf2', dt_s: 1e-3, status: 'ok' };
  const tables = { damping: [{ ...row, energy_lost_rel: 0.1 }, { ...row, energy_lost_rel: -0.2 }] };
  assert.deepEqual(damping.rows(tables).map(({ sign }) => sign), ['lost', 'gained']);
  const { concat } = damping.spec(tables, { width: 1000, theme: paper_theme });
  assert.deepEqual(concat.map(({ title }) => title), ['der: energy lost', 'der: energy gained']);
});

test('Orders_IncludeNegativeOnes', () => {
  const row = { error_kind: 'time', integrator: 'tr_bdf2', status: 'ok', wall_s_per_sim_s: 1, error_rel: 1e-3 };
  const tables = {
    work_precision: [['beam', 2], ['crank', -0.56], ['dahlquist', 1.9], ['oregonator', 1]].map(([scene, order_fit]) => ({
      ...row,
      scene,
      order_fit,
    })),
  };
  assert.deepEqual(order_table(tables), [['tr_bdf2', 4, '1.45', '-0.56 (crank)', '2.00 (beam)']]);
});

test('Cheapest_NamesItsField', () => {
  const row = { scene: 'beam', error_kind: 'time', status: 'ok', wall_s_per_sim_s: 1, error_rel: 1e-3 };
  const say = (...integrators) =>
    work_findings({ work_precision: integrators.map((integrator) => ({ ...row, integrator })) })[0];
  assert.match(say('rk4'), /\(the only integrator run\): error 0.01 with `rk4`/);
  assert.match(say('rk4', 'bdf2'), /\(of 2 integrators\)/);
});

test('CalibratePoints_DrawsOfEachRecordThePointThatMovesMost', () => {
  const path = (record, point, component, measured) =>
    measured.map((measured_m, k) => ({
      record,
      strand: 0,
      point,
      time_s: 0.1 * k,
      component,
      measured_m,
      fitted_m: measured_m + 1e-3,
    }));
  const tables = {
    calibrate_points: [
      ...path('a/one.csv', '3', 'x', [0.1, 0.11]),
      ...path('a/one.csv', '3', 'y', [9, 9]), // far from x, and at rest
      ...path('a/one.csv', 'tip', 'x', [0.2, 0.24]),
      ...path('a/one.csv', 'tip', 'z', [0, 0]),
      ...path('two.csv', '5', 'y', [1, 2]),
    ],
  };
  const rows = calibrate_points.rows(tables);
  assert.deepEqual(
    rows.map((row) => `${row.name} ${row.point_name} ${row.component}`),
    ['x', 'x', 'z', 'z']
      .map((component) => `one.csv strand 0, point tip ${component}`)
      .concat(['y', 'y'].map((component) => `two.csv strand 0, point 5 ${component}`)),
  );
  // From the mean of 0.22 m; the fitted point is 1 mm off.
  assert.ok(Math.abs(rows[0].measured_mm + 20) < 1e-9 && Math.abs(rows[0].fitted_mm + 19) < 1e-9);
  assert.match(calibrate_points.headline(tables), /2 records are within 1 mm/);
  const { concat } = calibrate_points.spec(tables, { width: 1000, theme: paper_theme });
  assert.deepEqual(concat.map(({ title }) => title), [
    'one.csv: strand 0, point tip',
    'two.csv: strand 0, point 5',
  ]);
});
