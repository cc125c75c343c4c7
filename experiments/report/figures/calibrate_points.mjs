// Measured points of a fit, and the same points of the fitted scene: a panel for each record.
import { distinct, group_by, is_number, minimum_by } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { layout, linear_channel, panels, series_channels, tooltips } from './common.mjs';
import { series_style } from './palette.mjs';

const usable = ({ calibrate_points = [] }) =>
  calibrate_points.filter((row) => [row.time_s, row.measured_m, row.fitted_m].every(is_number));

const mean = (list) => list.reduce((sum, x) => sum + x, 0) / list.length;

const paths_of = (rows) => [...group_by(rows, (row) => row.component).values()];

// How far a point moves: its coordinates, each from its own mean.
const travel = (rows) =>
  Math.hypot(
    ...paths_of(rows).flatMap((path) => {
      const middle = mean(path.map((row) => row.measured_m));
      return path.map((row) => row.measured_m - middle);
    }),
  );

// Of each record: the point that moves most, with its coordinates from their means.
function drawn(tables) {
  return [...group_by(usable(tables), (row) => row.record).values()].flatMap((record) => {
    const points = [...group_by(record, (row) => `strand ${row.strand}, point ${row.point}`)];
    const [point, rows] = minimum_by(points, ([, of_point]) => -travel(of_point));
    return paths_of(rows).flatMap((path) => {
      const middle = mean(path.map((row) => row.measured_m));
      return path.map((row) => ({
        ...row,
        name: row.record.replace(/^.*\//, ''),
        point_name: point,
        measured_mm: 1e3 * (row.measured_m - middle),
        fitted_mm: 1e3 * (row.fitted_m - middle),
      }));
    });
  });
}

const rms_mm = (rows) => 1e3 * Math.sqrt(mean(rows.map((row) => (row.measured_m - row.fitted_m) ** 2)));

export const calibrate_points = {
  id: 'calibrate_points',
  title: 'Measured and fitted points',
  table: 'calibrate_points',
  headline(tables) {
    const rows = drawn(tables);
    const records = distinct(rows.map((row) => row.record)).length;
    return `${records === 1 ? 'The fitted scene is' : `The scenes fitted to ${records} records are`} within ${format_number(rms_mm(rows), 2)} mm of the drawn points, root mean square`;
  },
  reading: `Marks: measured coordinates; lines: the fitted scene. Coordinates count from their mean over the record. Drawn is the
    point of each record that moves most.`,
  caption: `A panel for each record. Made from calibrate_points.csv, which calibrate writes next to its table.`,

  rows: drawn,

  spec(tables, { width }) {
    const rows = drawn(tables);
    const style = series_style(distinct(rows.map((row) => row.component)));
    const groups = [...group_by(rows, (row) => `${row.name}: ${row.point_name}`)];
    const { columns, panel_width, legend } = layout(width, groups.length, {
      columns_max: 2,
      labels: style.domain,
    });
    const series = series_channels('component', 'coordinate', style, legend);
    const x = linear_channel('time_s', 'time (s)');
    const y = (field) => linear_channel(field, 'from its mean (mm)');
    return panels(
      groups.map(([title, members]) => ({
        title,
        width: panel_width,
        height: 200,
        layer: [
          {
            data: { values: members },
            mark: { type: 'point', filled: true, size: members.length > 300 ? 12 : 40, opacity: 0.6 },
            encoding: {
              x,
              y: y('measured_mm'),
              ...series,
              strokeDash: undefined,
              tooltip: tooltips([
                ['component', 'coordinate'],
                ['time_s', 'time (s)', '.4g'],
                ['measured_mm', 'measured (mm)', '.4g'],
                ['fitted_mm', 'fitted (mm)', '.4g'],
              ]),
            },
          },
          {
            data: { values: members },
            mark: { type: 'line', strokeWidth: 1.6 },
            encoding: { x, y: y('fitted_mm'), ...series, shape: undefined, strokeDash: undefined },
          },
        ],
      })),
      columns,
    );
  },

  describe(tables) {
    const rows = drawn(tables);
    return `Coordinates against time of ${distinct(rows.map((row) => row.record)).length} records: measured marks and
      fitted lines, ${format_number(rms_mm(rows), 2)} mm apart, root mean square.`;
  },
};
