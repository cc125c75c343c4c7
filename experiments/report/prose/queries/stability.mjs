// Largest stable steps.
import { group_by, is_positive } from '../../src/tables.mjs';
import { is_capped } from '../../src/strand.mjs';
import { must, number, rows_of, table, time } from '../markdown.mjs';

const step = (row) => {
  if (row === undefined) return 'not searched';
  if (row.status === 'gave_up') return 'not found in time';
  if (!is_positive(row.dt_max_s)) return 'none found';
  return `${is_capped(row) ? '≥ ' : ''}${time(row.dt_max_s)}`;
};

const helix = { study: 'grid', model: 'super_helix', solver: 'recursive', modes: 'bend_twist' };
const ways = [
  ['semi_implicit_euler', 'stiff'],
  ['semi_implicit_euler', 'less_implicit'],
  ['semi_implicit_euler', 'exact'],
  ['backward_euler', 'exact'],
];
const damped = [
  ['none', 'none'],
  ['light', 'light'],
  ['seed', 'the published'],
];

// Scenes and dampings down, ways to step across, super_helix of 20 elements.
export function super_helix_table(tables) {
  const rows = rows_of(tables, 'stability_limit', { ...helix, elements: 20 });
  const lines = [...group_by(rows, (row) => row.scene)].flatMap(([scene, members]) =>
    damped.flatMap(([damping, words]) => {
      const here = members.filter((row) => row.damping === damping);
      if (here.length === 0) return [];
      const found = ways.map(([integrator, tangent]) =>
        here.find((row) => row.integrator === integrator && row.tangent === tangent),
      );
      return [[scene, words, ...found.map(step)]];
    }),
  );
  return table(
    ['scene', 'friction', ...ways.map(([integrator, tangent]) => `${integrator}, ${tangent}`)],
    lines,
  );
}

// Of the shaken undamped hair, the papers' step: "115 µs with 1 element, ...".
export function shaken_stiff(tables) {
  const rows = rows_of(tables, 'stability_limit', {
    ...helix,
    scene: 'shake',
    damping: 'none',
    integrator: 'semi_implicit_euler',
    tangent: 'stiff',
    status: 'ok',
  }).sort((a, b) => a.elements - b.elements);
  const [few, many] = [rows[0], rows.at(-1)];
  must(many.dt_max_s >= few.dt_max_s, 'more elements do not shorten the step');
  return `${time(few.dt_max_s)} with ${few.elements} element${few.elements === 1 ? '' : 's'} and ${time(many.dt_max_s)} with ${many.elements}`;
}

// Every strand model at 20 elements: error, and largest steps.
export function models_table(tables) {
  const rows = rows_of(tables, 'stability_limit', {
    study: 'grid',
    elements: 20,
    damping: 'none',
  }).filter((row) => ['release', 'shake'].includes(row.scene) && !/less_implicit/.test(row.tangent),
  );
  const lines = [...group_by(rows, (row) => row.model)].map(([model, members]) => [
    `\`${model}\``,
    ...['release', 'shake'].flatMap((scene) =>
      ['semi_implicit_euler', 'backward_euler'].map((integrator) =>
        step(
          members.find(
            (row) =>
              row.scene === scene &&
              row.integrator === integrator &&
              (row.modes ?? '') !== 'bend' &&
              (integrator === 'backward_euler' || row.tangent !== 'exact' ||
                !members.some((other) => other.tangent === 'stiff')),
          ),
        ),
      ),
    ),
  ]);
  return table(
    [
      'model',
      'release: semi-implicit',
      'release: backward Euler',
      'shake: semi-implicit',
      'shake: backward Euler',
    ],
    lines,
  );
}

const usual = '1e-3';

// What error control holds: scenes and models down.
export function tolerance_table(tables) {
  const rows = rows_of(tables, 'stability_limit').filter((row) => row.study === 'tolerance');
  if (rows.length === 0) return 'The table has no such rows yet.';
  const asked = (tolerance) => (is_positive(tolerance) ? tolerance.toExponential() : '');
  const loosest = ({ status, tolerance_loosest }) =>
    ({ gave_up: 'not found in time', unstable: 'none found' })[status] ?? asked(tolerance_loosest);
  return table(
    ['scene', 'model', 'integrator', 'elements', 'loosest', 'tightest', `steps at ${usual}`, `work at ${usual}`],
    rows.map((row) => [
      row.scene,
      `\`${row.model}\``,
      `\`${row.integrator}\``,
      row.elements,
      loosest(row),
      asked(row.tolerance_tightest),
      is_positive(row.steps_usual) ? row.steps_usual : '',
      is_positive(row.work_usual) ? number(row.work_usual) : '',
    ]),
  );
}

// Total error of every model on the released hair, by its finest step.
export function errors_table(tables) {
  const counts = [10, 20, 40];
  const rows = rows_of(tables, 'work_precision', {
    scene: 'strand_release',
    error_kind: 'total',
    integrator: 'implicit_midpoint',
    status: 'ok',
  });
  const finest = (members) => members.reduce((a, b) => (b.dt_s < a.dt_s ? b : a));
  return table(
    ['model', ...counts.map((n) => `${n} elements`)],
    // A model whose runs break off at all of these is not in the table.
    [...group_by(
      rows.filter((row) => counts.includes(row.elements)),
      (row) => row.model,
    )].map(([model, members]) => [
      `\`${model}\``,
      ...counts.map((n) => {
        const at = members.filter((row) => row.elements === n);
        return at.length > 0 ? number(finest(at).error_rel) : '';
      }),
    ]),
  );
}
