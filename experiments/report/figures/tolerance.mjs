// Figure: the time error that a method with error control achieves, over the tolerance
// asked for; one panel per model and scene.
import { bounds, control_finding, control_rows } from '../src/findings/tolerance.mjs';
import { distinct, group_by, problem_name } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  log_channel,
  log_extent,
  marked_line,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { series_style } from './palette.mjs';

const panel_name = (row) =>
  spaced(row.model) === problem_name(row)
    ? problem_name(row)
    : `${problem_name(row)}: ${spaced(row.model)}`;

const bound_lines = (y, theme) => ({
  data: { values: Object.values(bounds).map((achieved_over_asked) => ({ achieved_over_asked })) },
  mark: { type: 'rule', stroke: theme.muted, strokeWidth: 1, strokeDash: [3, 2] },
  encoding: { y },
});

export const tolerance = {
  id: 'tolerance',
  title: 'Error over tolerance',
  table: 'work_precision',
  finding: control_finding,
  caption: `Largest time error at the compared instants, of
    a point over the length, divided by the tolerance; the reference has the same elements.
    At 1 the error is the tolerance; dashed lines mark that and a twentieth of it. A flat line is an
    error in proportion to the tolerance. Click a legend entry to keep that method and dim the
    other. Made from work_precision.csv; failed runs, and errors below ten times the gap of the
    references, are in the table only.`,

  rows: control_rows,

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const groups = [...group_by(rows, panel_name)];
    const style = series_style(rows.map((row) => row.integrator));
    const { columns, panel_width, legend } = layout(width, groups.length, {
      labels: style.domain,
    });
    const x = log_channel('tolerance', 'tolerance', log_extent(rows.map((r) => r.tolerance), 3));
    const ratios = rows.map((row) => row.achieved_over_asked);
    const y = log_channel(
      'achieved_over_asked',
      'error over tolerance',
      log_extent([...ratios, bounds.least, bounds.most], 4),
    );
    const series = series_channels('integrator', 'integrator', style, legend);
    const opacity = dimmed_unless(['pick_integrator']);
    const tooltip = tooltips([
      ['scene', 'scene'],
      ['model', 'model'],
      ['integrator', 'integrator'],
      ['tolerance', 'tolerance'],
      ['achieved_over_asked', 'error over tolerance', '.3f'],
      ['steps', 'steps'],
      ['rejected', 'rejected'],
    ]);
    const list = groups.map(([name, members]) => ({
      title: name,
      width: panel_width,
      height: 170,
      layer: [
        ...marked_line(members, { x, y, series, opacity, tooltip }),
        bound_lines(y, theme),
      ],
    }));
    return panels(
      with_parameters(list, [legend_selection('pick_integrator', 'integrator')]),
      columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Log-log charts of the time error over the tolerance against the tolerance, for
      ${distinct(rows.map(panel_name)).length} pairs of scene and model and
      ${distinct(rows.map((r) => r.integrator)).length} methods.`;
  },
};
