// Figure 4: work-precision diagrams, one panel per scene, Pareto front marked.
import {
  distinct,
  group_by,
  is_positive,
  is_set,
  problem_name,
  problem_rows,
  succeeded,
} from '../src/tables.mjs';
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
import { model_style, series_style, solver_dashes } from './palette.mjs';

// Guides of error ~ time^-p from the lower left corner: what order p looks like.
function order_guides(members) {
  const [left, right] = log_extent(members.map((r) => r.wall_s_per_sim_s)).domain.map(
    Math.log10,
  );
  const [bottom, top] = log_extent(members.map((r) => r.error_rel)).domain.map(
    Math.log10,
  );
  const height = 0.3 * (top - bottom);
  const reach = 0.24 * (right - left);
  return [1, 2, 4].flatMap((order) => {
    const run = Math.min(reach, height / order);
    const end = bottom + height + 0.02 * (top - bottom) - order * run;
    const start = {
      x: 10 ** (left + 0.02 * (right - left)),
      y: 10 ** (bottom + height + 0.02 * (top - bottom)),
    };
    return [
      { order, ...start, i: 0 },
      {
        order,
        x: 10 ** (Math.log10(start.x) + run),
        y: 10 ** end,
        i: 1,
        text: `${order}`,
      },
    ];
  });
}

// The solvers of the problems that were solved with several; none when each had one.
export function compared_solvers(rows) {
  const groups = group_by(rows, (row) => `${problem_name(row)}|${row.model}`);
  return distinct(
    [...groups.values()].flatMap((members) => {
      const solvers = group_by(members, (row) => row.integrator);
      const several = [...solvers.values()].some(
        (runs) => distinct(runs.map((row) => row.solver)).length > 1,
      );
      return several ? members.map((row) => row.solver) : [];
    }),
  ).filter(Boolean);
}

// One curve: same integrator under the same settings, from loose to tight.
const curve = (row) =>
  [
    row.model,
    row.integrator,
    row.solver,
    row.elements,
    row.max_order,
    row.error_kind,
    row.formulation,
  ].join('|');

// A method that takes both has a curve for each.
const driven_name = ({ integrator, tolerance }) =>
  is_positive(tolerance) ? `${integrator} (tolerance)` : integrator;

export function pareto_rows(members) {
  if (members.some((row) => is_set(row.pareto)))
    return members.filter((r) => is_set(r.pareto));
  return members.filter(
    (row) =>
      !is_set(row.below_reference) &&
      !members.some(
        (other) =>
          other !== row &&
          other.error_rel <= row.error_rel &&
          other.wall_s_per_sim_s < row.wall_s_per_sim_s,
      ),
  );
}

const counts = [
  ['integrator', 'integrator'],
  ['model', 'model'],
  ['formulation', 'formulation'],
  ['solver', 'linear solver'],
  ['elements', 'elements'],
  ['dt_s', 'dt (s)'],
  ['rtol', 'rtol'],
  ['tolerance', 'tolerance'],
  ['max_order', 'max order'],
  ['error_kind', 'error'],
  ['error_rel', 'relative error', '.3e'],
  ['scd', 'correct digits'],
  ['wall_s_per_sim_s', 'wall time per simulated s', '.3e'],
  ['wall_s', 'wall time (s)', '.3e'],
  ['steps', 'steps'],
  ['rejected', 'rejected'],
  ['residuals', 'residuals'],
  ['linearizations', 'linearizations'],
  ['solves', 'solves'],
  ['order_fit', 'fitted order'],
  ['pareto_text', 'on the Pareto front'],
  ['below', 'below the reference'],
];

// `by`: the field that colour and shape tell apart.
function panel(problem, members, { panel_width, legend, style, theme, dash, by }) {
  const x = log_channel(
    'wall_s_per_sim_s',
    'wall time per simulated second (s/s)',
    log_extent(
      members.map((row) => row.wall_s_per_sim_s),
      5,
    ),
  );
  const y = log_channel(
    'error_rel',
    'relative error',
    log_extent(members.map((r) => r.error_rel)),
  );
  const series = {
    ...series_channels(by, by, style, legend),
    ...(dash ? { strokeDash: dash } : {}),
  };
  const opacity = dimmed_unless([`pick_${by}`]);
  const front = pareto_rows(members);
  const guides = order_guides(members);
  const guide_xy = { x: { ...x, field: 'x' }, y: { ...y, field: 'y' } };
  return {
    title: problem,
    width: panel_width,
    height: 330,
    layer: [
      {
        data: { values: members },
        mark: { type: 'line' },
        encoding: {
          x,
          y,
          ...series,
          shape: undefined,
          strokeWidth: { condition: { test: 'datum.rival', value: 0.9 }, value: 1.6 },
          detail: { field: 'curve' },
          order: { field: 'rank', type: 'quantitative' },
          opacity,
        },
      },
      {
        data: { values: front },
        mark: {
          type: 'line',
          strokeWidth: 7,
          stroke: theme.axis,
          strokeOpacity: 0.35,
          strokeCap: 'round',
          strokeJoin: 'round',
        },
        encoding: { x, y, order: { field: 'wall_s_per_sim_s', type: 'quantitative' } },
      },
      ...['no', 'yes'].map((below) => ({
        data: { values: members.filter((row) => row.below === below) },
        mark: { type: 'point', strokeWidth: 1.6, filled: below === 'no' },
        encoding: {
          x,
          y,
          ...series,
          strokeDash: undefined,
          size: { condition: { test: 'datum.rival', value: 16 }, value: 70 },
          opacity,
          tooltip: tooltips(counts),
        },
      })),
      {
        data: { values: front },
        mark: {
          type: 'point',
          shape: 'circle',
          size: 170,
          strokeWidth: 1.5,
          stroke: theme.text,
          filled: false,
        },
        encoding: { x, y },
      },
      {
        data: { values: guides },
        mark: { type: 'line', stroke: theme.muted, strokeWidth: 1, strokeDash: [3, 2] },
        encoding: { ...guide_xy, detail: { field: 'order' }, order: { field: 'i' } },
      },
      {
        data: { values: guides.filter((g) => g.i === 1) },
        mark: { type: 'text', align: 'left', dx: 3, fontSize: 10, color: theme.muted },
        encoding: { ...guide_xy, text: { field: 'text' } },
      },
    ],
  };
}

// One integrator on several models: the models are what such a problem tells apart.
const compares_models = (members) =>
  distinct(members.map((row) => row.integrator)).length === 1 &&
  distinct(members.map((row) => row.model)).length > 1;

function problem_panels(groups, { by, style, solvers, rows, width, theme }) {
  const { columns, panel_width, legend } = layout(width, groups.length, {
    columns_max: 2,
    labels: style.domain,
  });
  const compared = by === 'integrator' && solvers.length > 0;
  const dash = compared && {
    field: 'solver',
    type: 'nominal',
    title: 'linear solver',
    scale: solver_dashes(solvers, rows),
    legend: { ...legend, values: solvers, symbolType: 'stroke', symbolSize: 500 },
  };
  // Solvers give one error at different times: the first in full, its rivals thin.
  const rivals = dash ? dash.scale.domain.slice(1, solvers.length) : [];
  return panels(
    with_parameters(
      groups.map(([problem, members]) =>
        panel(
          problem,
          members.map((row) => ({ ...row, rival: rivals.includes(row.solver) })),
          { panel_width, legend, style, theme, dash, by },
        ),
      ),
      [legend_selection(`pick_${by}`, by)],
    ),
    columns,
    { dashes: dash ? 'shared' : 'independent' },
  );
}

export const work_precision = {
  id: 'work_precision',
  title: 'What accuracy costs in time',
  table: 'work_precision',
  caption: `Relative error against wall time per simulated second; down and left is
    better. Each line is one integrator from loose to tight; in a panel of one integrator on
    several models, one model at one number of elements. Ringed points joined by the
    grey band are the Pareto front: nothing else is both faster and more accurate. Hollow
    points lie below the accuracy of the reference and prove nothing. The dashed fan shows
    the slopes of orders 1, 2 and 4. Where one problem was solved with several linear
    solvers, dashes tell them apart and all but the first are thin. Click a legend entry to keep that integrator and dim
    the others. Made from work_precision.csv; failed runs are in the table only.`,

  rows: (tables) =>
    problem_rows(tables)
      .filter(
        (row) =>
          succeeded(row) &&
          is_positive(row.error_rel) &&
          is_positive(row.wall_s_per_sim_s),
      )
      .map((row) => ({
        ...row,
        integrator: driven_name(row),
        formulation: row.formulation ?? '',
        solver: row.solver ?? '',
        curve: curve({ ...row, integrator: driven_name(row) }),
        below: is_set(row.below_reference) ? 'yes' : 'no',
        pareto_text: is_set(row.pareto) ? 'yes' : 'no',
        rank: -Math.log10(row.rtol ?? row.tolerance ?? row.dt_s ?? row.error_rel),
      })),

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const solvers = compared_solvers(rows);
    const groups = [...group_by(rows, problem_name)];
    const kinds = [
      { by: 'integrator', groups: groups.filter(([, members]) => !compares_models(members)) },
      { by: 'model', groups: groups.filter(([, members]) => compares_models(members)) },
    ].filter((kind) => kind.groups.length > 0);
    const list = kinds.map(({ by, groups }) => {
      const members = groups.flatMap(([, group]) => group);
      const names = members.map((row) => row[by]);
      const style = by === 'model' ? model_style(names) : series_style(names);
      return problem_panels(groups, { by, style, solvers, rows, width, theme });
    });
    return list.length === 1
      ? list[0]
      : {
          vconcat: list,
          spacing: 36,
          resolve: {
            scale: { color: 'independent', shape: 'independent', strokeDash: 'independent' },
            legend: { color: 'independent', shape: 'independent', strokeDash: 'independent' },
          },
        };
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Log-log work-precision diagrams for
      ${distinct(rows.map((r) => r.scene)).length} scenes and
      ${distinct(rows.map((r) => r.integrator)).length} integrators: relative error against
      wall time per simulated second, with the Pareto front marked.`;
  },
};
