// Error of all hairs against time a frame: heads by which nothing else is beaten.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
import { layout, log_channel, log_extent, panels, tooltips } from './common.mjs';

const whose = { mean: 'error_mean_rel', p95: 'error_p95_rel', largest: 'error_max_rel' };
const some = 'guides, the others follow';
const each = 'each hair';
const colours = { domain: [some, each], range: ['#1F7FC2', '#D55E00'] };

const rows_of = ({ head_accuracy = [] }) =>
  head_accuracy
    .filter((row) => succeeded(row) && is_positive(row.ms_per_frame))
    .filter((row) => ['front', 'cheapest'].includes(row.kind))
    .map((row) => ({
      ...row,
      error_pct: 100 * row[whose[row.over]],
      us_a_hair: (1e3 * row.ms_per_frame) / row.strands,
      simulated: row.guides === row.strands ? each : some,
      step_ms: 1e3 * row.dt_s,
    }))
    .filter((row) => is_positive(row.error_pct));

export const head_accuracy = {
  id: 'head_accuracy',
  title: 'Error of all hairs and time a frame',
  table: 'head_accuracy',
  caption: `One panel per groom: runs that nothing beats in both the error that 95 % of the sampled hairs do not exceed and time a frame
    by the number of hairs. Down and to the left is better. Large marks are the answers to a wanted error. Colour: whether some hairs are
    simulated and others follow them, or each is. Made from head_accuracy.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    const scenes = [...group_by(rows, (row) => row.scene)];
    const { columns, panel_width } = layout(width, scenes.length, {
      columns_max: 3,
      labels: colours.domain,
      above: true,
    });
    const x = log_channel('error_pct', 'error (%)', log_extent(rows.map((r) => r.error_pct)));
    const y = log_channel(
      'us_a_hair',
      'time a frame and hair (µs)',
      log_extent(rows.map((r) => r.us_a_hair)),
    );
    const tooltip = tooltips([
      ['kind', 'kind'],
      ['target_error_rel', 'target error', '.1%'],
      ['guides', 'simulated'],
      ['strands', 'hairs'],
      ['elements', 'elements'],
      ['step_ms', 'step (ms)', '.3g'],
      ['bits', 'bits'],
      ['error_pct', 'error (%)', '.3g'],
      ['interpolation_p95_rel', 'of interpolation', '.2%'],
      ['simulated_p95_rel', 'of elements and step', '.2%'],
      ['ms_per_frame', 'time a frame (ms)', '.3g'],
    ]);
    const color = {
      field: 'simulated',
      type: 'nominal',
      title: null,
      scale: colours,
      legend: { orient: 'top' },
    };
    return panels(
      scenes.map(([scene, members]) => ({
        title: spaced(scene),
        width: panel_width,
        height: 160,
        layer: [
          ['front', { filled: true, size: 34 }],
          ['cheapest', { filled: true, size: 130 }],
        ].map(([kind, mark]) => ({
          data: { values: members.filter((row) => row.kind === kind) },
          mark: { type: 'point', ...mark },
          encoding: { x, y, color, tooltip },
        })),
      })),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Time a frame and hair against the error of all hairs, both log scale, of the best runs of
      ${distinct(rows.map((row) => row.scene)).length} grooms.`;
  },
};
