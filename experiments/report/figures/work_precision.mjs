// Work-precision diagrams: error against time, one panel per problem, by family of integrators.
import {
  distinct,
  group_by,
  is_positive,
  is_set,
  minimum_by,
  problem_name,
  problem_rows,
  succeeded,
} from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  log_channel,
  log_extent,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { families, family_name, family_style } from './palette.mjs';
import { front_of } from './swing.mjs';

// Runs whose error is known: a run closer to the reference than that is accurate proves nothing.
const answered = (tables) =>
  problem_rows(tables)
    .filter(
      (row) =>
        succeeded(row) &&
        is_positive(row.error_rel) &&
        is_positive(row.wall_s_per_sim_s) &&
        !is_set(row.below_reference),
    )
    .map((row) => ({
      ...row,
      problem: problem_name(row),
      family: family_name(row.integrator),
      formulation: row.formulation ?? '',
      solver: row.solver ?? '',
      wall_s: row.wall_s_per_sim_s,
      wall_ms: 1e3 * row.wall_s_per_sim_s,
    }));

// One integrator on several models: the models are what such a problem tells apart.
const compares_models = (members) =>
  distinct(members.map((row) => row.integrator)).length === 1 &&
  distinct(members.map((row) => row.model)).length > 1;

const of_kind = (tables, models) =>
  [...group_by(answered(tables), (row) => row.problem)]
    .filter(([, members]) => compares_models(members) === models)
    .flatMap(([, members]) => members);

export const family_rows = (tables) => of_kind(tables, false);
export const model_rows = (tables) => of_kind(tables, true);

const counts = [
  ['integrator', 'integrator'],
  ['model', 'model'],
  ['formulation', 'formulation'],
  ['solver', 'linear solver'],
  ['elements', 'elements'],
  ['dt_s', 'dt (s)'],
  ['rtol', 'rtol'],
  ['position_tol_rel', 'tolerance'],
  ['max_order', 'max order'],
  ['error_rel', 'relative error', '.3e'],
  ['scd', 'correct digits'],
  ['wall_ms', 'wall time per simulated second (ms)', '.3g'],
  ['steps', 'steps'],
  ['rejected', 'rejected'],
  ['residuals', 'residuals'],
  ['linearizations', 'linearizations'],
  ['solves', 'solves'],
  ['order_fit', 'fitted order'],
];

// Panels of problems: of each series the runs that no other of it beats, joined, and all others
// small. `by`: the field of the series.
export function work_panels(rows, { by, title, style, width, height, columns_max }) {
  const groups = [...group_by(rows, (row) => row.problem)];
  const { columns, panel_width, legend } = layout(width, groups.length, {
    columns_max,
    labels: style.domain,
    above: true,
    least: 220,
  });
  const series = series_channels(by, title, style, legend);
  const pick = `pick_${by}`;
  const list = groups.map(([problem, members]) => {
    const x = log_channel(
      'wall_ms',
      'time per simulated second (ms)',
      log_extent(members.map((row) => row.wall_ms), 5),
    );
    const y = log_channel(
      'error_rel',
      'relative error',
      log_extent(members.map((row) => row.error_rel), 6),
    );
    const front = [...group_by(members, (row) => row[by]).values()].flatMap(front_of);
    const opacity = (value) => dimmed_unless([pick], value);
    return {
      title: problem,
      width: panel_width,
      height,
      layer: [
        {
          data: { values: members },
          mark: { type: 'point', filled: true, size: 9, aria: false },
          encoding: {
            x,
            y,
            color: series.color,
            opacity: opacity(0.35),
            tooltip: tooltips(counts),
          },
        },
        {
          data: { values: front },
          mark: { type: 'line', strokeWidth: 1.6 },
          encoding: { x, y, color: series.color, opacity: opacity(1) },
        },
        {
          data: { values: front },
          mark: { type: 'point', filled: true, size: 42 },
          encoding: {
            x,
            y,
            ...series,
            strokeDash: undefined,
            opacity: opacity(1),
            tooltip: tooltips(counts),
          },
        },
      ],
    };
  });
  return panels(with_parameters(list, [legend_selection(pick, by)]), columns);
}

const level = 1e-4;

// "For an error of 1e-4, explicit, adaptive is the cheapest family on 5 of 7 problems, ..."
function headline(tables) {
  const groups = [...group_by(family_rows(tables), (row) => row.problem)];
  const winners = groups.flatMap(([, members]) => {
    const reached = members.filter((row) => row.error_rel <= level);
    return reached.length > 0 ? [minimum_by(reached, (row) => row.wall_s).family] : [];
  });
  if (winners.length === 0) return `No run reaches a relative error of ${format_number(level)}`;
  const ranked = [...group_by(winners, (name) => name)].sort((a, b) => b[1].length - a[1].length);
  const [[first, { length }], ...rest] = ranked;
  const also = rest.map(([name, { length: count }]) => `“${name}” on ${count}`).join(', ');
  return (
    `For an error of ${format_number(level)}, “${first}” methods are the cheapest on ${length} of ` +
    `${winners.length} problems${also === '' ? '' : `, ${also}`}`
  );
}

export const work_precision = {
  id: 'work_precision',
  title: 'Error against time',
  table: 'work_precision',
  headline,
  reading: `One panel per problem, one colour per family of integrators; lower left is better. A line joins the runs of a
    family that no other of its runs beats in both, small dots are its other runs.`,
  caption: `Relative error against wall time per simulated second. Runs that agree with the reference better than the
    references agree with each other are left out. The integrators of each family: ${families
      .filter(({ members }) => members.length > 0)
      .map(({ name, members }) => `${name}: ${members.join(', ')}`)
      .join('; ')}. Made from work_precision.csv; failed runs are in the table only.`,

  rows: family_rows,

  spec(tables, { width }) {
    const rows = family_rows(tables);
    return work_panels(rows, {
      by: 'family',
      title: 'family of integrators',
      style: family_style(rows.map((row) => row.family)),
      width,
      height: 165,
      columns_max: 3,
    });
  },

  describe(tables) {
    const rows = family_rows(tables);
    return `Log-log work-precision diagrams for
      ${distinct(rows.map((r) => r.problem)).length} problems and
      ${distinct(rows.map((r) => r.integrator)).length} integrators in
      ${distinct(rows.map((r) => r.family)).length} families.`;
  },
};
