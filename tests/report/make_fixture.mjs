// Writes small tables with made-up but plausible numbers and the columns of the real ones:
// `node tests/report/make_fixture.mjs DIRECTORY`. Nothing in here is a measurement.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const here = process.argv[2];
mkdirSync(here, { recursive: true });

let run = 0;
function write(name, columns, rows) {
  const quote = (v) => (/[",\n]/.test(v) ? `"${v.replaceAll('"', '""')}"` : v);
  const text = (v) => (v === undefined || v === null ? '' : typeof v === 'number'
    ? String(Number(v.toPrecision(6))) : quote(String(v)));
  const tail = ['run_id', 'status', 'reason'];
  const lines = rows.map((row) => [...columns, ...tail].map((c) =>
    text(c === 'run_id' ? `r${++run}` : c === 'status' ? row.status ?? 'ok' : row[c])).join(','));
  writeFileSync(join(here, `${name}.csv`), [[...columns, ...tail].join(','), ...lines, ''].join('\n'));
  writeFileSync(join(here, `${name}.meta.json`), `${JSON.stringify({
    command: `build/release/experiments/${name} --out results/${name}.csv`, version: '0.1.0',
    git: { commit: '0123456789abcdef', dirty: name === 'bdf_order' }, compiler: 'g++ 12.2.0',
    flags: '-O3 -march=native', cpu: 'Fixture CPU @ 2.10 GHz', date: '2026-01-01T00:00:00Z',
    libraries: { sundials: '6.4.1', klu: '5.12.0' }, sundials_speed_ratio: 1.08, seed: 1,
  }, null, 2)}\n`);
}

// Deterministic scatter in [-1, 1] so that curves do not coincide.
const jitter = (k) => Math.sin(12.9898 * (k + 1)) * Math.cos(4.1414 * (k + 3));

const drift = [];
const explicit = ['explicit_euler', 'symplectic_euler', 'velocity_verlet', 'rk4', 'gsl_rkf45'];
const base = { explicit_euler: 0.4, symplectic_euler: 2.5e-2, velocity_verlet: 8e-4, rk4: 5e-11,
  gsl_rkf45: 3e-7 };
for (const system of ['bead_on_circle', 'bead_on_helix']) {
  const scale = system === 'bead_on_circle' ? 1 : 1.7;
  explicit.forEach((integrator, k) => {
    const run_of = (formulation, g, cost, extra) => drift.push({ study: 'formulation', system,
      formulation, integrator, alpha: 0, beta: 0, dt_s: 1e-3, t_end_s: 10, violation: 0, g_max: g,
      g_final: 0.7 * g, g_rate_max: 4 * g, energy_drift_rel: 3 * g + 1e-12, steps: 10000,
      wall_s: cost * scale * (1 + 0.4 * k + 0.1 * jitter(k)), ...extra });
    run_of('acceleration', base[integrator] * scale, 6e-3);
    const held = integrator === 'rk4' ? 5e-7 : base[integrator] / 60;
    run_of('baumgarte', held * scale, 6.6e-3, { alpha: 1e4, beta: 200 });
    run_of('baumgarte', held * scale * 6, 6.5e-3, { alpha: 100, beta: 20 });
    run_of('projection', 3e-13 * (1 + k), 9e-3);
    run_of('parametric', 0, 2.2e-3);
  });
  drift.push({ study: 'formulation', system, formulation: 'rattle', integrator: 'rattle', dt_s: 1e-3,
    t_end_s: 10, g_max: 4e-15, g_final: 1e-15, energy_drift_rel: 2e-6, steps: 10000, wall_s: 1.4e-2 });
  for (const [suppress, steps] of [['true', 1900], ['false', 1830000]]) {
    drift.push({ study: 'formulation', system, formulation: 'index2_ggl', integrator: 'ida',
      t_end_s: 10, g_max: 4e-8, g_final: 1e-8, energy_drift_rel: 1e-6, steps, dt_s: null,
      wall_s: steps * 6e-6, suppress_algebraic: suppress });
  }
  drift.push({ study: 'formulation', system, formulation: 'index3', integrator: 'ida', t_end_s: 10,
    status: 'failed', reason: 'error test failed repeatedly at t = 0.0031 s, "index 3" limit' });
}
const limits = { symplectic_euler: 0.828, rk4: 1.39 };
const grid_axis = Array.from({ length: 13 }, (_, k) => 10 ** (k / 2));
for (const integrator of Object.keys(limits)) {
  for (const alpha of grid_axis) {
    for (const b of grid_axis) {
      const beta = Number((b / 100).toPrecision(6));
      const w = Math.sqrt(alpha) * 1e-3;
      const z = beta / (2 * Math.sqrt(alpha));
      const edge = limits[integrator] * (z < 1 ? 1 : 1 / z ** 0.9);
      const diverged = w > edge || beta * 1e-3 > 1.9;
      drift.push({ study: 'grid', system: 'bead_on_circle', formulation: 'baumgarte', integrator,
        alpha: Number(alpha.toPrecision(6)), beta, dt_s: 1e-3, t_end_s: 10,
        g_max: diverged ? 'nan' : 2e-2 / (1 + alpha / 30 + beta) * (z < 0.2 ? 3 : 1), steps: 10000,
        wall_s: 6.4e-3, status: diverged ? 'diverged' : 'ok',
        reason: diverged ? 'not finite at t = 0.4 s' : '' });
    }
  }
}
for (const integrator of ['symplectic_euler', 'rk4', 'velocity_verlet']) {
  for (let k = -6; k <= 6; ++k) {
    const r = 10 ** (k / 3);
    const alpha = 100;
    const time = 0.95 * (r < 1 ? r ** -0.5 : (2 * r) ** 0.9 / 1.8) *
      { symplectic_euler: 1.05, rk4: 1, velocity_verlet: 0.96 }[integrator];
    const late = time > 8;
    drift.push({ study: 'recovery', system: 'bead_on_circle', formulation: 'baumgarte', integrator,
      alpha, beta: 20 * Math.sqrt(r), dt_s: 1e-3, t_end_s: 10, violation: 1e-2, g_max: 1e-2,
      recovery_time_s: late ? null : time, overshoot: r < 1 ? 0.4 * (1 - r) : 0, steps: 10000,
      wall_s: 6e-3, status: 'ok', reason: late ? 'not recovered by t = 10 s' : '' });
  }
}
write('constraint_drift', ['study', 'system', 'formulation', 'integrator', 'alpha', 'beta', 'dt_s',
  't_end_s', 'violation', 'g_max', 'g_final', 'g_rate_max', 'energy_drift_rel', 'recovery_time_s',
  'overshoot', 'steps', 'wall_s', 'suppress_algebraic'], drift);

const boundary = [], region = [];
for (const [integrator, limit] of Object.entries(limits)) {
  const omega_h = (z) => limit * (z < 1 ? 1 : 1 / z ** 0.95);
  [0.1, 0.3, 1, 3, 10].forEach((zeta, k) => boundary.push({ integrator, zeta, dt_s: 1e-3,
    omega_h_predicted: omega_h(zeta), omega_h_measured: omega_h(zeta) * (1 + 0.02 * jitter(k)),
    rel_gap: 0.02 * Math.abs(jitter(k)) }));
  Array.from({ length: 60 }, (_, i) => 0.002 * 1.22 ** i).forEach((zeta, i) => {
    const omega = omega_h(zeta) / 1e-3;
    region.push({ integrator, dt_s: 1e-3, alpha: omega ** 2, beta: 2 * zeta * omega, i });
  });
}
write('drift_boundary', ['integrator', 'zeta', 'omega_h_predicted', 'omega_h_measured', 'rel_gap',
  'dt_s'], boundary);
write('drift_region', ['integrator', 'dt_s', 'alpha', 'beta', 'i'], region);

// order, cost per step (s), error constant; adaptive ones by rtol.
const methods = [['explicit_euler', 1, 1, 6], ['symplectic_euler', 1, 1, 2],
  ['velocity_verlet', 2, 1.2, 3], ['rk4', 4, 3.6, 2], ['semi_implicit_euler', 1, 4, 5],
  ['backward_euler', 1, 9, 7], ['implicit_midpoint', 2, 8, 2], ['bdf2', 2, 7, 4],
  ['newmark', 2, 7, 3], ['generalized_alpha', 2, 7.5, 3.5], ['rattle', 2, 3, 2.6],
  ['gsl_rkf45', 5, 6, 1, 1], ['gsl_rk8pd', 8, 14, 1, 1], ['gsl_msadams', 6, 5, 3, 1],
  ['gsl_bsimp', 6, 40, 2, 1], ['cvode_adams', 7, 4, 4, 1], ['cvode_bdf', 4, 6, 8, 1],
  ['arkode_erk', 5, 5, 1.5, 1], ['arkode_dirk', 4, 22, 2, 1], ['ida', 4, 8, 9, 1]];
const scenes = [['pendulum', 1, 1e-13], ['inextensible_chain', 30, 1e-11],
  ['andrews_squeezer', 12, 1e-12], ['beam', 90, 1e-9]];
const work = [];
scenes.forEach(([scene, cost, gap], s) => methods.forEach(([integrator, p, c, e, adaptive], m) => {
  if ((m + 2 * s) % 7 === 3) {
    work.push({ scene, model: scene, integrator, error_kind: 'time', status: 'failed', rtol: 1e-6,
      reason: `newton did not converge at t = ${s}.25 s` });
    return;
  }
  for (let k = 0; k < 7; ++k) {
    const dt = 1e-2 / 2 ** k, rtol = 10 ** (-3 - k);
    const steps = Math.round(adaptive ? 30 * (e / rtol) ** (1 / p) : 1 / dt);
    const error = Math.max(adaptive ? e * rtol * (1 + 0.3 * jitter(m + k))
      : e * (40 * dt) ** p * 0.01, gap / 3);
    const wall = steps * c * cost * 2e-7 * (1 + 0.05 * jitter(7 * m + k + s));
    work.push({ scene, model: scene, integrator, solver: c > 3.6 ? 'banded' : '', elements: cost,
      dt_s: adaptive ? null : dt, rtol: adaptive ? rtol : null, error_kind: 'time',
      error_rel: error, scd: -Math.log10(error), wall_s_per_sim_s: wall, wall_s: wall, steps,
      rejected: adaptive ? Math.round(steps / 25) : 0, residuals: steps * 2, solves: steps * 2,
      linearizations: Math.round(steps / 6), order_fit: adaptive ? null : p + 0.05 * jitter(m),
      below_reference: error < 10 * gap ? 1 : 0, pareto: 0 });
  }
}));
for (const [scene] of scenes) {
  const rows = work.filter((r) => r.scene === scene && !r.status && !r.below_reference);
  for (const r of rows) {
    r.pareto = rows.some((o) => o !== r && o.error_rel <= r.error_rel &&
      o.wall_s_per_sim_s < r.wall_s_per_sim_s) ? 0 : 1;
  }
}
write('work_precision', ['scene', 'model', 'integrator', 'solver', 'elements', 'dt_s', 'rtol',
  'max_order', 'error_kind', 'error_rel', 'scd', 'wall_s_per_sim_s', 'wall_s', 'steps', 'rejected',
  'residuals', 'linearizations', 'solves', 'order_fit', 'pareto', 'below_reference'], work);

const bdf = [];
const runs = [1, 2, 3, 4, 5].map((q) => ['cvode_bdf', q, `cvode_bdf max order ${q}`])
  .concat([['arkode_dirk', null, 'arkode_dirk (ESDIRK)'], ['cvode_adams', null, 'cvode_adams'],
    ['generalized_alpha', null, 'generalized_alpha']]);
runs.forEach(([integrator, max_order, label]) => {
  for (let k = 0; k < 5; ++k) {
    const rtol = 10 ** (-2 - k);
    const stiff = { 1: 900 * 3 ** k, 2: 110 * 2.1 ** k, 3: 4000 * 1.4 ** k, 4: 9000 * 1.3 ** k,
      5: 14000 * 1.2 ** k }[max_order];
    const steps = Math.round(stiff ?? { arkode_dirk: 60, cvode_adams: 16000,
      generalized_alpha: 200 }[integrator] * (integrator === 'cvode_adams' ? 1.1 : 2) ** k);
    const failed = max_order === 1 && k === 4;
    bdf.push({ scene: 'beam', integrator, label, max_order, rtol, error_rel: failed ? null : 30 * rtol,
      scd: failed ? null : -Math.log10(30 * rtol), steps, wall_s: steps * 5e-5,
      status: failed ? 'failed' : 'ok', reason: failed ? 'more than 50000 steps' : '' });
  }
});
write('bdf_order', ['scene', 'integrator', 'label', 'max_order', 'rtol', 'error_rel', 'scd', 'steps',
  'wall_s'], bdf);

write('benchmark_extra', ['model', 'elements', 'time_s'],
  [10, 100, 1000].map((n) => ({ model: 'chain <n>', elements: n, time_s: 4e-7 * n })));
