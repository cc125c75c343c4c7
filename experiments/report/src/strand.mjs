// Names and rules shared by the figures, findings and tables of the strand experiments.
import { group_by, is_positive, minimum_by, succeeded } from './tables.mjs';

// One frame at 30 frames per second, and the end of the scan over dt where longer steps
// do not miss what drives the scene.
export const frame_s = 1 / 30;
export const scan_end_s = 0.1;

export const spaced = (name) => String(name ?? '').replaceAll('_', ' ');

// "der, inextensible": the model and the word of its choice.
// An id as prose has it.
export const code = (name) => `\`${name}\``;
export const variant_name = ({ model, variant }) =>
  variant ? `${spaced(model)}, ${String(variant).split('=').at(-1)}` : spaced(model);

const papers_step = 'linearly_implicit_euler';
// Reduced coordinates: the models of [Bertails et al. 2006], whose solvers and Jacobians are compared.
export const is_reduced = (row) => /^(super_helix|articulated_chain)/.test(row.model);
const is_helix = (row) => /^super_helix/.test(row.model);
const is_elastic_local = (row) =>
  [row.model, row.solver, row.jacobian, row.integrator].some((name) =>
    /elastic_local/.test(name ?? ''),
  );

// "recursive", "sparse, exact Jacobian", "articulated chain, recursive, bend planar": the
// super-helix with all modes and the elastic Jacobian goes without saying.
export function method_name(row) {
  const extra = [
    row.jacobian === 'exact' ? 'exact Jacobian' : '',
    ['', 'bend_twist'].includes(row.modes ?? '') ? '' : spaced(row.modes),
  ];
  const base = is_elastic_local(row)
    ? ['local elastic Jacobian']
    : [is_helix(row) ? '' : spaced(row.model), spaced(row.solver)];
  return [...base, ...extra].filter(Boolean).join(', ');
}

// The same with the integrator, where it is not the papers' linearly implicit step.
export function run_name(row) {
  const integrator =
    row.integrator === papers_step || is_elastic_local(row) ? '' : row.integrator;
  return [method_name(row), integrator].filter(Boolean).join(', ');
}

// Nothing unstable was met up to the longest step of the scene: dt_max is a lower bound.
export const is_capped = (row) => is_positive(row.dt_max_s) && row.limited_by === 'cap';

// The search was done and found a step below which everything tested was stable.
export const has_limit = (row) => succeeded(row) && is_positive(row.dt_max_s);

const dampings = {
  none: 'no damping',
  light: 'light damping',
  published: 'the published damping',
};
export const damping_rank = ({ damping }) => Object.keys(dampings).indexOf(damping);
export const damping_name = ({ damping }) => dampings[damping] ?? spaced(damping);

// What the figure draws of one method: all modes, the papers' step (and backward Euler
// next to it with the exact Jacobian), one solver where solvers share one name in it.
export function principal_runs(rows) {
  const main = rows.filter((row) => ['', 'bend_twist'].includes(row.modes ?? ''));
  const kind = (row) =>
    is_elastic_local(row) || (is_helix(row) && row.jacobian !== 'exact')
      ? method_name(row)
      : `${row.model} ${row.jacobian}`;
  return [...group_by(main, kind)].flatMap(([name, members]) => {
    if (name === 'sparse') return [];
    const solvers = [...new Set(members.map((row) => row.solver))];
    const solver =
      ['recursive', 'sparse', 'composite'].find((s) => solvers.includes(s)) ?? solvers[0];
    const of = members.filter((row) => row.solver === solver);
    const wanted =
      members[0].jacobian === 'exact' ? [papers_step, 'backward_euler'] : [papers_step];
    const kept = of.filter(
      (row) => wanted.includes(row.integrator) || is_elastic_local(row),
    );
    return kept.length > 0 ? kept : of.filter((r) => r.integrator === of[0].integrator);
  });
}

// Rows of scaling.csv as series, the fitted exponent of each next to its name.
export function scaling_series(rows) {
  const timed = rows.filter((row) => succeeded(row) && is_positive(row.cost_per_step_s));
  const straight = timed.filter((row) => row.structure === 'straight');
  return [...group_by(straight, method_name)].map(([name, members]) => ({
    name,
    members,
    exponent: members.findLast((row) => is_positive(row.exponent))?.exponent,
  }));
}

// Composite against recursive at the same structure and element count: our cost per step,
// and the published frames per second where it gives both.
export function solver_pairs(rows) {
  const plain = rows.filter(
    (row) => is_helix(row) && ['recursive', 'composite'].includes(method_name(row)),
  );
  return [...group_by(plain, (row) => `${row.structure}|${row.elements}`).values()].map(
    (members) => {
      const of = (solver) => members.find((row) => row.solver === solver);
      const [composite, recursive] = [of('composite'), of('recursive')];
      const ratio = (a, b) => (is_positive(a) && is_positive(b) ? a / b : undefined);
      const cost = (row) => (row && succeeded(row) ? row.cost_per_step_s : undefined);
      return {
        structure: members[0].structure,
        elements: members[0].elements,
        composite,
        recursive,
        ours: ratio(cost(composite), cost(recursive)),
        source: ratio(recursive?.published_fps, composite?.published_fps),
      };
    },
  );
}

export const swing_levels = [
  { error: 1e-2, name: '1 %', target_s: 20e-3, simulator: 'wall_1pct_s' },
  { error: 1e-3, name: '0.1 %', target_s: 50e-3, simulator: 'wall_0p1pct_s' },
];

// Runs of the swing with one kind of error; time errors at the other simulators' element count.
export function swing_runs(rows, kind) {
  const good = rows.filter(
    (row) =>
      succeeded(row) &&
      row.error_kind === kind &&
      is_positive(row.error_rel) &&
      is_positive(row.wall_s),
  );
  const same = good.filter((row) => row.elements === 20);
  const kept = kind === 'time' && same.length > 0 ? same : good;
  return kept.map((row) => ({
    ...row,
    series: row.integrator + (is_helix(row) ? '' : ` (${spaced(row.model)})`),
  }));
}

export const fastest_at = (runs, error) =>
  minimum_by(
    runs.filter((row) => row.error_rel <= error),
    (row) => row.wall_s,
  );
