// What a groom costs at a target error of all its hairs, and how many hairs must be simulated.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
import { dimmed_unless, legend_selection, log_channel, log_extent, tooltips } from './common.mjs';
import { blue, orange, purple, sky } from './palette.mjs';
import { row_channel, row_text, row_width } from './rows.mjs';

const whose = { mean: 'error_mean_rel', p95: 'error_p95_rel', largest: 'error_max_rel' };
const some = 'guides simulated, the others interpolated';
const each = 'every hair simulated';
const percent = (value) => `${format_number(100 * value)} %`;

const rows_of = ({ head_accuracy = [] }) =>
  head_accuracy
    .filter((row) => succeeded(row) && is_positive(row.ms_per_frame) && row.kind === 'cheapest')
    .map((row) => ({
      ...row,
      groom: spaced(row.scene),
      error_pct: 100 * row[whose[row.over]],
      us_a_hair: (1e3 * row.ms_per_frame) / row.strands,
      simulated: row.guides === row.strands ? each : some,
      series: `${percent(row.target_error_rel)}, ${row.guides === row.strands ? each : some}`,
      step_ms: 1e3 * row.dt_s,
    }))
    .filter((row) => is_positive(row.error_pct));

const targets_of = (rows) =>
  distinct(rows.map((row) => row.target_error_rel)).sort((a, b) => b - a);

// "For 1 %, 6 of 12 grooms need every hair simulated; with guides a frame takes ... µs per hair"
function headline(tables) {
  const rows = rows_of(tables);
  const targets = targets_of(rows);
  const wanted = targets.includes(0.01) ? 0.01 : targets.at(-1);
  const at = rows.filter((row) => row.target_error_rel === wanted);
  const times = (kind) => at.filter((row) => row.simulated === kind).map((row) => row.us_a_hair);
  const range = (values) =>
    values.length === 0
      ? 'none'
      : `${format_number(Math.min(...values), 2)} to ${format_number(Math.max(...values), 2)} µs`;
  return (
    `For ${percent(wanted)}, guides are enough in ${times(some).length} of ${at.length} grooms ` +
    `(${range(times(some))} per frame and hair); the others need every hair (${range(times(each))})`
  );
}

const styles = [
  [sky, 'circle'],
  [orange, 'triangle-up'],
  [blue, 'square'],
  [purple, 'diamond'],
];

export const head_accuracy = {
  id: 'head_accuracy',
  title: 'Time and guides for a target error',
  table: 'head_accuracy',
  headline,
  reading: `The cheapest run of each groom for each target error. On the right: hairs simulated of all hairs, from the looser
    target to the tighter.`,
  caption: `The target is the error that 95 % of the sampled hairs do not exceed. Grooms without a mark have no run within
    that target. Made from head_accuracy.csv, which has all runs on the front of error and time.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    const grooms = distinct(rows.map((row) => row.groom));
    const narrow = width < 700;
    const series = targets_of(rows).flatMap((target) =>
      [some, each].map((kind) => `${percent(target)}, ${kind}`),
    );
    const used = series.filter((name) => rows.some((row) => row.series === name));
    const of = (k) => ({
      domain: used,
      range: used.map((name) => styles[series.indexOf(name) % styles.length][k]),
    });
    const shared = {
      field: 'series',
      type: 'nominal',
      title: 'target error',
      legend: { orient: 'top', direction: 'horizontal', columns: narrow ? 1 : 2 },
    };
    const texts = [...group_by(rows, (row) => row.groom)].map(([groom, members]) => ({
      groom,
      text: `${[...members]
        .sort((a, b) => b.target_error_rel - a.target_error_rel)
        .map((row) => row.guides)
        .join(', ')} of ${members[0].strands}`,
    }));
    const x = log_channel(
      'us_a_hair',
      'time per frame and hair (µs)',
      log_extent(rows.map((row) => row.us_a_hair)),
    );
    const y = row_channel('groom', grooms);
    return {
      width: row_width(width, grooms, narrow ? 0 : 160),
      height: { step: 24 },
      layer: [
        {
          data: { values: rows },
          params: [legend_selection('pick_series', 'series')],
          mark: { type: 'point', filled: true, size: 95 },
          encoding: {
            x,
            y,
            color: { ...shared, scale: of(0) },
            shape: { ...shared, scale: of(1) },
            opacity: dimmed_unless(['pick_series']),
            tooltip: tooltips([
              ['target_error_rel', 'target error', '.1%'],
              ['guides', 'simulated'],
              ['strands', 'hairs'],
              ['elements', 'elements'],
              ['step_ms', 'step (ms)', '.3g'],
              ['precision', 'precision'],
              ['error_pct', 'error (%)', '.3g'],
              ['interpolation_p95_rel', 'error of interpolation', '.2%'],
              ['simulated_p95_rel', 'error of elements and step', '.2%'],
              ['ms_per_frame', 'time per frame (ms)', '.3g'],
            ]),
          },
        },
        ...(narrow ? [] : [row_text(texts, y, 'text', { baseline: 'middle' })]),
      ],
    };
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Time per frame and hair, log scale, of the cheapest run of
      ${distinct(rows.map((row) => row.scene)).length} grooms for each target error.`;
  },
};
