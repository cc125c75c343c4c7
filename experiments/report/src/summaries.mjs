// Small tables of selected numbers as HTML; the full tables stand below them.
import {
  distinct,
  group_by,
  is_positive,
  study_rows,
  succeeded,
  swing_rows,
} from './tables.mjs';
import { escape_html, format_number } from './format.mjs';
import {
  damping_name,
  damping_rank,
  fastest_at,
  has_limit,
  is_capped,
  run_name,
  solver_pairs,
  spaced,
  swing_levels,
  swing_runs,
} from './strand.mjs';

// `head` and each row: cells as text; the first `texts` columns are words, the rest
// numbers; a row may carry {strong: true}.
function grid_html(id, caption, head, rows, texts) {
  if (rows.length === 0) return '';
  const cell = (tag, text, i, scope = '') =>
    `<${tag}${scope} class="${i < texts ? 'text' : 'number'}">${escape_html(text ?? '')}</${tag}>`;
  return (
    `<h3 id="${id}">${escape_html(caption)}</h3>` +
    `<div class="table-box" tabindex="0" role="region" aria-labelledby="${id}"><table class="selected"><thead><tr>` +
    `${head.map((text, i) => cell('th', text, i, ' scope="col"')).join('')}</tr></thead><tbody>` +
    rows
      .map(
        ({ cells, strong }) =>
          `<tr${strong ? ' class="strong"' : ''}>` +
          `${cells.map((text, i) => cell('td', text, i)).join('')}</tr>`,
      )
      .join('') +
    '</tbody></table></div>'
  );
}

const element_marks = [1, 2, 5, 10, 20, 40];

function limit_cell(row) {
  if (row === undefined) return '';
  if (has_limit(row))
    return `${is_capped(row) ? '≥ ' : ''}${format_number(1e3 * row.dt_max_s)}`;
  return row.status === 'unstable' && is_positive(row.dt_first_unstable_s)
    ? `< ${format_number(1e3 * row.dt_first_unstable_s)}`
    : spaced(row.status);
}

export function stability_summary(tables) {
  const rows = study_rows(tables, 'stability_limit', 'grid');
  const scenes = distinct(rows.map((row) => row.scene));
  const series = [
    ...group_by(rows, (row) =>
      [row.scene, row.damping, run_name(row)].join('|'),
    ).values(),
  ]
    .filter((members) => members.some((row) => element_marks.includes(row.elements)))
    .sort(
      ([a], [b]) =>
        scenes.indexOf(a.scene) - scenes.indexOf(b.scene) ||
        damping_rank(a) - damping_rank(b),
    );
  return grid_html(
    'stability-numbers',
    'Largest stable time step (ms) by number of elements',
    ['scene', 'damping', 'method', ...element_marks.map(String)],
    series.map((members) => ({
      cells: [
        spaced(members[0].scene),
        damping_name(members[0]),
        run_name(members[0]),
        ...element_marks.map((n) =>
          limit_cell(members.find((row) => row.elements === n)),
        ),
      ],
    })),
    3,
  );
}

// What each test is, where it comes from and what is asked of a model.
export function validation_summary({ validation = [], glossary }) {
  const texts = glossary?.validation?.test ?? {};
  return grid_html(
    'validation-about',
    'The tests',
    ['test', 'what', 'parameter', 'measured', 'accepted, and why', 'source'],
    distinct(validation.map((row) => row.test)).map((test) => {
      const { what, parameter, quantity, why, source } = texts[test] ?? {};
      return { cells: [spaced(test), what, parameter, quantity, why, source] };
    }),
    6,
  );
}

// Why each case is hard and what a run must keep.
export function hard_summary({ hard_cases = [], glossary }) {
  const texts = glossary?.hard_cases?.case ?? {};
  return grid_html(
    'hard-about',
    'The cases',
    ['case', 'why it is hard', 'criterion'],
    distinct(hard_cases.map((row) => row.case)).map((name) => {
      const { hard_because, criterion } = texts[name] ?? {};
      return { cells: [spaced(name), hard_because, criterion] };
    }),
    3,
  );
}

export function scaling_summary({ scaling: rows = [] }) {
  const number = (value) => (is_positive(value) ? format_number(value) : '');
  const time = (row) =>
    row && succeeded(row) && is_positive(row.cost_per_step_s)
      ? format_number(1e6 * row.cost_per_step_s)
      : '';
  const listed = solver_pairs(rows).filter(
    ({ structure, composite, recursive }) =>
      structure !== 'straight' ||
      is_positive(composite?.published_fps) ||
      is_positive(recursive?.published_fps),
  );
  return grid_html(
    'scaling-numbers',
    "Frames per second: the published table (hardware of 2008) and ours",
    [
      'structure',
      'elements',
      'source: composite',
      'source: recursive',
      'source: ratio',
      'ours: composite',
      'ours: recursive',
      'composite step (µs)',
      'recursive step (µs)',
      'ours: ratio of steps',
    ],
    listed.map(({ structure, elements, composite, recursive, ours, source }) => ({
      cells: [
        spaced(structure),
        String(elements),
        number(composite?.published_fps),
        number(recursive?.published_fps),
        number(source),
        number(composite?.fps),
        number(recursive?.fps),
        time(composite),
        time(recursive),
        number(ours),
      ],
    })),
    1,
  );
}

export function swing_summary(tables) {
  const { other_simulators_swing = [] } = tables;
  const milliseconds = (value) => (is_positive(value) ? format_number(1e3 * value) : '');
  const other_simulators = other_simulators_swing.map((row) => ({
    name: row.simulator,
    step_us: row.us_per_step_n20,
    one: row.wall_1pct_s,
    dt: row.dt_1pct_s,
    tenth: row.wall_0p1pct_s,
  }));
  const [one, tenth] = swing_levels;
  const ours = [...group_by(swing_runs(swing_rows(tables), 'time'), (row) => row.series)].map(
    ([series, members]) => {
      const best = fastest_at(members, one.error);
      return {
        name: `ours: ${series}`,
        step_us: is_positive(best?.steps) ? (1e6 * best.wall_s) / best.steps : undefined,
        one: best?.wall_s,
        dt: best?.dt_s,
        tenth: fastest_at(members, tenth.error)?.wall_s,
        strong: true,
      };
    },
  );
  const rank = (row) => (is_positive(row.one) ? row.one : Infinity);
  return grid_html(
    'swing-numbers',
    'Wall time of 2 simulated seconds at 20 elements (time error): ours and as published',
    [
      'simulator',
      'µs per step',
      '1 %: wall time (ms)',
      '1 %: dt (ms)',
      '0.1 %: wall time (ms)',
    ],
    [...ours, ...other_simulators]
      .sort((a, b) => (rank(a) < rank(b) ? -1 : rank(a) > rank(b) ? 1 : 0))
      .map((row) => ({
        strong: row.strong,
        cells: [
          row.name,
          is_positive(row.step_us) ? format_number(row.step_us) : '',
          milliseconds(row.one),
          milliseconds(row.dt),
          milliseconds(row.tenth),
        ],
      })),
    1,
  );
}
