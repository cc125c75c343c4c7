// Error of gradients of runs against the linearizations that they take.
import { distinct, group_by, is_positive, minimum_by } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
import { line_panels } from './common.mjs';

// Two families of models on the curl, then the laws of contact.
const drawn_models = ['super_helix', 'der'];

const rows_of = ({ cost_of_gradient = [] }) =>
  cost_of_gradient
    .filter(
      (row) =>
        (row.part === 'contact' || (row.part === 'time' && drawn_models.includes(row.model))) &&
        row.start === 'damped' &&
        row.jacobian === 'exact' &&
        (row.status === 'ok' || row.status === 'below_reference') &&
        is_positive(row.gradient_error_rel),
    )
    .map((row) => ({ ...row, error_pct: 100 * row.gradient_error_rel }));

const panel_of = (row) =>
  row.part === 'contact' ? `falls on a plane: ${row.law}` : `curl, ${spaced(row.model)}`;

export const cost_of_gradient = {
  id: 'cost_of_gradient',
  title: 'Error of a gradient',
  table: 'cost_of_gradient',
  headline(tables) {
    const rows = rows_of(tables).filter((row) => row.part === 'time');
    const model = drawn_models.find((name) => rows.some((row) => row.model === name));
    const series = [...group_by(rows.filter((row) => row.model === model), (row) => row.integrator)].map(
      ([, members]) => members[0],
    );
    const best = (column) => minimum_by(series.filter((row) => is_positive(row[column])), (row) => row[column]);
    const text = (column, target) => {
      const row = best(column);
      return row === undefined
        ? `no method reaches ${target}`
        : `${row.integrator} reaches ${target} with ${format_number(row[column], 2)} linearizations`;
    };
    return series.length === 0
      ? 'Error of a gradient against its linearizations'
      : `Gradient of the tip of a curl, ${spaced(model)}: ${text('linearizations_1_percent', '1 %')}, ` +
          text('linearizations_001_percent', '0.01 %');
  },
  reading: `Error of the derivative of the tip by its worst of four parameters, against the linearizations of the run and of its
    derivatives. Lower left is better.`,
  caption: `Errors in time. A line goes from long to short steps. Made from cost_of_gradient.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    return line_panels([...group_by(rows_of(tables), panel_of)], {
      id: 'cost_of_gradient',
      width,
      series: ['integrator', 'method'],
      x: ['linearizations', 'linearizations'],
      y: ['error_pct', 'error of the gradient (%)'],
      tooltip: [
        ['integrator', 'method'],
        ['steps', 'steps'],
        ['linearizations', 'linearizations'],
        ['error_pct', 'error of the gradient (%)', '.3g'],
        ['tip_error_rel', 'error of the tip over the length', '.3g'],
      ],
    });
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Error of the gradient in percent against linearizations, both log scale, for
      ${distinct(rows.map((row) => row.integrator)).length} methods in ${distinct(rows.map(panel_of)).length} panels.`;
  },
};
