// Error against time of every strand model, one integrator for all.
import { distinct, minimum_by } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
import { folded, name_style } from './palette.mjs';
import { front_of } from './swing.mjs';
import { model_rows, work_panels } from './work_precision.mjs';

// Models with a run that no run of another model beats have a colour; the cheapest first.
function rows_of(tables) {
  const rows = model_rows(tables);
  const best = front_of(rows).sort((a, b) => a.wall_s - b.wall_s);
  const rest = [...rows].sort((a, b) => a.error_rel - b.error_rel);
  const fold = folded(distinct([...best, ...rest].map((row) => spaced(row.model))));
  return rows.map((row) => ({ ...row, series: fold(spaced(row.model)) }));
}

const level = 1e-3;

function headline(tables) {
  const rows = rows_of(tables);
  const best = minimum_by(
    rows.filter((row) => row.error_rel <= level),
    (row) => row.wall_s,
  );
  const models = distinct(rows.map((row) => row.model)).length;
  return best === undefined
    ? `None of ${models} models reaches an error of ${format_number(100 * level)} %`
    : `Of ${models} models, ${spaced(best.model)} reaches an error of ${format_number(100 * level)} % ` +
        `in the least time: ${format_time(best.wall_s)} per simulated second`;
}

export const work_models = {
  id: 'work_models',
  title: 'Error against time, model by model',
  table: 'work_precision',
  headline,
  reading: `All models with the same integrator, with several numbers of elements and tolerances; lower left is better. A
    line joins the runs of a model that no other of its runs beats in both. Grey: models that others always beat, where
    there are more than eight.`,
  caption: `Error of the tip against the continuous rod, over the length, against wall time per simulated second. Made from
    work_precision.csv; failed runs are in the table only.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    return work_panels(rows, {
      by: 'series',
      title: 'model',
      style: name_style(rows.map((row) => row.series)),
      width,
      height: 300,
      columns_max: 1,
    });
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Log-log work-precision diagram of ${distinct(rows.map((row) => row.model)).length} models.`;
  },
};
