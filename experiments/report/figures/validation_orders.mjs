// How the error of a test falls with the number of elements.
import { distinct, group_by } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
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
import { model_style } from './palette.mjs';
import { answered, named } from './validation.mjs';

const order_rows = (tables) => {
  const rows = named(tables).filter((row) => answered(row) && row.error_rel > 0);
  // Of every test and model the parameter at which its error is largest.
  return [...group_by(rows, (row) => `${row.test}|${row.name}`).values()].flatMap((members) => {
    if (distinct(members.map((row) => row.elements)).length < 2) return [];
    const worst = members.reduce((a, b) => (b.error_rel > a.error_rel ? b : a));
    return members
      .filter((row) => row.parameter === worst.parameter)
      .map((row, _, { length }) => ({
        ...row,
        error_pct: 100 * row.error_rel,
        points: length,
      }));
  });
};

export const validation_orders = {
  id: 'validation_orders',
  title: 'How the error falls with elements',
  table: 'validation',
  caption: `Error in per cent against the number of elements, one panel per test, each model at the
    parameter where its error is largest. Slope -2: halving the elements' length quarters the
    error. Dashed with hollow points: two numbers of elements only, so that the slope is no
    fitted order, and nothing says that it lasts. Made from validation.csv.`,

  rows: order_rows,

  spec(tables, { width }) {
    const rows = order_rows(tables);
    const style = model_style(rows.map((row) => row.name));
    const tests = [...group_by(rows, (row) => row.test)];
    const { columns, panel_width, legend } = layout(width, tests.length, {
      columns_max: 3,
      labels: style.domain,
      above: true,
    });
    const list = tests.map(([test, members]) => {
      const elements = members.map((row) => row.elements);
      const x = log_channel('elements', 'elements', {
        ...log_extent(elements),
        ticks: distinct(elements).sort((a, b) => a - b),
      });
      const y = log_channel(
        'error_pct',
        'error (%)',
        log_extent(members.map((row) => row.error_pct), 5),
      );
      const series = series_channels('name', 'model', style, legend);
      const opacity = dimmed_unless(['pick_model'], 0.9);
      const tooltip = tooltips([
        ['name', 'model'],
        ['elements', 'elements'],
        ['parameter', 'parameter', '.4g'],
        ['error_pct', 'error (%)', '.3g'],
        ['order', 'slope', '.2f'],
        ['points', 'numbers of elements the slope is from'],
      ]);
      return {
        title: spaced(test),
        width: panel_width,
        height: 180,
        data: { values: members },
        layer: [
          ...['datum.points > 2', 'datum.points <= 2'].map((filter, hollow) => ({
            transform: [{ filter }],
            mark: { type: 'point', filled: hollow === 0, size: 55, strokeWidth: 1.5 },
            encoding: { x, y, ...series, strokeDash: undefined, opacity, tooltip },
          })),
          ...['datum.points > 2', 'datum.points <= 2'].map((filter, hollow) => ({
            transform: [{ filter }],
            mark: { type: 'line', strokeWidth: 1.3, strokeDash: hollow ? [5, 3] : [1, 0] },
            encoding: { x, y, color: series.color, opacity },
          })),
        ],
      };
    });
    return panels(
      with_parameters(list, [legend_selection('pick_model', 'name')]),
      columns,
    );
  },

  describe(tables) {
    const rows = order_rows(tables);
    return `${distinct(rows.map((row) => row.test)).length} panels, one per test: error in per cent,
      log scale, against the number of elements of
      ${distinct(rows.map((row) => row.name)).length} models.`;
  },
};
