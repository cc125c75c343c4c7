// The time error that a method with error control reaches, over the tolerance; one row per
// problem.
import { bounds, control_rows } from '../src/findings/tolerance.mjs';
import { distinct, group_by, problem_name } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
import {
  dimmed_unless,
  legend_selection,
  log_channel,
  log_extent,
  series_channels,
  tooltips,
} from './common.mjs';
import { series_style } from './palette.mjs';
import { row_channel, row_width } from './rows.mjs';

const row_name = (row) =>
  spaced(row.model) === problem_name(row)
    ? problem_name(row)
    : `${problem_name(row)}: ${spaced(row.model)}`;

const rows_of = (tables) =>
  control_rows(tables).map((row) => ({ ...row, name: row_name(row) }));

function headline(tables) {
  const said = [...group_by(rows_of(tables), (row) => row.integrator)].map(
    ([integrator, members]) =>
      `${integrator} in ${members.filter((row) => row.error_over_tolerance <= bounds.most).length} of ${members.length}`,
  );
  return `The error stays below the tolerance: ${said.join(' runs, ')} runs`;
}

export const tolerance = {
  id: 'tolerance',
  title: 'Error over tolerance',
  table: 'work_precision',
  headline,
  reading: `One row per problem, one mark per tolerance. Solid line: the error equals the tolerance; dashed: a twentieth of
    it. Marks close together are an error in proportion to the tolerance.`,
  caption: `Largest time error at the compared instants, of a point over the length, divided by the tolerance; the
    reference has the same elements. Made from work_precision.csv; failed runs, and errors below ten times the gap of the
    references, are in the table only.`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const names = distinct(rows.map((row) => row.name));
    const methods = series_style(rows.map((row) => row.integrator));
    const ratios = rows.map((row) => row.error_over_tolerance);
    const x = log_channel(
      'error_over_tolerance',
      'error / tolerance',
      log_extent([...ratios, bounds.least, bounds.most], 6),
    );
    const y = row_channel('name', names);
    const yOffset = { field: 'integrator', scale: { domain: methods.domain } };
    const opacity = dimmed_unless(['pick_integrator']);
    const series = series_channels('integrator', 'integrator', methods, {
      orient: 'top',
      direction: 'horizontal',
    });
    const bound = (value, strokeDash) => ({
      data: { values: [{ error_over_tolerance: value }] },
      mark: { type: 'rule', color: theme.text, strokeWidth: 1.1, strokeDash },
      encoding: { x },
    });
    return {
      width: row_width(width, names, 8),
      height: { step: 24, for: 'position' },
      layer: [
        {
          data: { values: rows },
          params: [legend_selection('pick_integrator', 'integrator')],
          mark: { type: 'line', strokeWidth: 1.4 },
          encoding: { x, y, yOffset, color: series.color, detail: { field: 'name' }, opacity },
        },
        {
          data: { values: rows },
          mark: { type: 'point', filled: true, size: 48 },
          encoding: {
            x,
            y,
            yOffset,
            ...series,
            strokeDash: undefined,
            opacity,
            tooltip: tooltips([
              ['name', 'problem'],
              ['integrator', 'integrator'],
              ['position_tol_rel', 'tolerance'],
              ['error_over_tolerance', 'error / tolerance', '.3f'],
              ['steps', 'steps'],
              ['rejected', 'rejected'],
            ]),
          },
        },
        bound(bounds.most, [1, 0]),
        bound(bounds.least, [3, 3]),
      ],
    };
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Time error over tolerance, log scale, one row for each of
      ${distinct(rows.map((row) => row.name)).length} pairs of scene and model, for
      ${distinct(rows.map((r) => r.integrator)).length} methods.`;
  },
};
