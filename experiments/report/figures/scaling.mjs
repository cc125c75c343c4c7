// Figure 7: cost per step against elements, and composite against recursive.
import { distinct, is_positive, succeeded } from '../src/tables.mjs';
import { method_name, scaling_series, solver_pairs, spaced } from '../src/strand.mjs';
import { scaling_finding } from '../src/findings/scaling.mjs';
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
import { method_style } from './palette.mjs';

// All modes of every solver; fewer modes of the recursion alone and maximal coordinates by
// the band solver alone, to keep lines apart.
const drawn = ({ members: [row] }) =>
  row.solver !== 'klu' &&
  (['', 'bend_twist'].includes(row.modes ?? '') ||
    (row.solver === 'recursive' && row.tangent !== 'exact'));

const label = ({ name, exponent }) =>
  is_positive(exponent) ? `${name}: slope ${exponent.toFixed(2)}` : name;

const ours = '#1F7FC2';
const source = '#D55E00';

// Ratio of the two solvers: ours as a line with the trees beside it, the source's dashed.
function ratio_panel(pairs, { panel_width, theme }) {
  const shown = pairs.flatMap((pair) => [
    ...(pair.ours ? [{ ...pair, whose: 'ours', ratio: pair.ours }] : []),
    ...(pair.source ? [{ ...pair, whose: 'source', ratio: pair.source }] : []),
  ]);
  const x = log_channel('elements', 'elements', log_extent(shown.map((r) => r.elements)));
  const y = log_channel(
    'ratio',
    'composite / recursive',
    log_extent([...shown.map((r) => r.ratio), 1]),
  );
  const tooltip = tooltips([
    ['structure', 'structure'],
    ['elements', 'elements'],
    ['whose', 'whose'],
    ['ratio', 'composite / recursive', '.3g'],
  ]);
  const of = (whose, straight) =>
    shown.filter((r) => r.whose === whose && (r.structure === 'straight') === straight);
  const layer = (values, mark) => ({
    data: { values },
    mark,
    encoding: { x, y, ...(mark.type === 'point' ? { tooltip } : {}) },
  });
  const last = (values) => values.filter((r) => r === values.at(-1));
  const name = (whose, text, color, place) => ({
    data: {
      values: last(of(whose, true).sort((a, b) => a.elements - b.elements)).map((r) => ({
        ...r,
        text,
      })),
    },
    mark: { type: 'text', fontSize: 12, fontWeight: 600, color, ...place },
    encoding: { x, y, text: { field: 'text' } },
  });
  return {
    title: 'What composite costs beside recursive',
    width: panel_width,
    height: 330,
    layer: [
      layer(of('ours', true), { type: 'line', color: ours, strokeWidth: 1.8 }),
      layer(of('source', true), {
        type: 'line',
        color: source,
        strokeWidth: 1.8,
        strokeDash: [6, 3],
      }),
      {
        data: { values: [{ ratio: 1 }] },
        mark: { type: 'rule', color: theme.axis },
        encoding: { y },
      },
      layer(of('ours', true), { type: 'point', filled: true, color: ours, size: 55 }),
      layer(of('ours', false), {
        type: 'point',
        shape: 'diamond',
        filled: false,
        color: ours,
        size: 90,
        strokeWidth: 1.7,
      }),
      layer(of('source', true), {
        type: 'point',
        shape: 'square',
        filled: true,
        color: source,
        size: 60,
      }),
      name('ours', 'ours', ours, { align: 'right', dx: -8, dy: -10 }),
      name('source', 'source, 2008', source, { align: 'right', dx: -10, dy: -4 }),
    ],
  };
}

export const scaling = {
  id: 'scaling',
  title: 'Cost against the number of elements',
  table: 'scaling',
  finding: scaling_finding,
  caption: `First: cost of one time step against the number of elements of a straight
    strand, one line per solver, with the slope fitted by the experiment; hollow diamonds
    are the five trees. Second: how many times the recursive step the composite one costs;
    diamonds are trees, squares what the source's frames per second say (rounded there,
    and equal at one and two elements). Its hardware was of 2008, so its frames per second
    are not comparable with ours, the ratio is. Click a legend entry to keep it and dim
    the others. Made from scaling.csv.`,

  rows(tables) {
    return scaling_series(tables.scaling ?? [])
      .filter(drawn)
      .flatMap((series) =>
        series.members.map((row) => ({
          ...row,
          method: series.name,
          series: label(series),
          cost_us: 1e6 * row.cost_per_step_s,
        })),
      );
  },

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const labels = new Map(rows.map((row) => [row.method, row.series]));
    const style = method_style(rows.map((row) => row.method));
    const named = { ...style, domain: style.domain.map((name) => labels.get(name)) };
    const trees = (tables.scaling ?? [])
      .filter(
        (row) =>
          row.structure !== 'straight' &&
          succeeded(row) &&
          is_positive(row.cost_per_step_s),
      )
      .map((row) => ({
        ...row,
        structure: spaced(row.structure),
        series: labels.get(method_name(row)),
        cost_us: 1e6 * row.cost_per_step_s,
      }))
      .filter((row) => row.series !== undefined);
    const pairs = solver_pairs(tables.scaling).filter((p) => p.ours || p.source);
    const { columns, panel_width, legend } = layout(width, pairs.length > 0 ? 2 : 1, {
      columns_max: 2,
      labels: named.domain,
      above: true,
    });
    const all = [...rows, ...trees];
    const x = log_channel('elements', 'elements', log_extent(all.map((r) => r.elements)));
    const y = log_channel(
      'cost_us',
      'cost per step (µs)',
      log_extent(all.map((r) => r.cost_us)),
    );
    const series = series_channels('series', 'solver', named, legend);
    const opacity = dimmed_unless(['pick_series']);
    const tooltip = tooltips([
      ['structure', 'structure'],
      ['series', 'solver'],
      ['elements', 'elements'],
      ['cost_us', 'cost per step (µs)', '.3g'],
      ['dt_max_s', 'largest stable dt (s)', '.3e'],
      ['fps', 'frames per second', '.3g'],
      ['seed_fps', "source's frames per second"],
    ]);
    const cost_panel = {
      title: 'Cost of one step',
      width: panel_width,
      height: 330,
      layer: [
        {
          data: { values: rows },
          mark: { type: 'line', strokeWidth: 1.8 },
          encoding: { x, y, ...series, shape: undefined, opacity },
        },
        {
          data: { values: rows },
          mark: { type: 'point', filled: true, size: 50 },
          encoding: { x, y, ...series, strokeDash: undefined, opacity, tooltip },
        },
        {
          data: { values: trees },
          mark: {
            type: 'point',
            shape: 'diamond',
            filled: false,
            size: 100,
            strokeWidth: 1.7,
          },
          encoding: { x, y, color: series.color, opacity, tooltip },
        },
      ],
    };
    return panels(
      with_parameters(
        [
          cost_panel,
          ...(pairs.length > 0 ? [ratio_panel(pairs, { panel_width, theme })] : []),
        ],
        [legend_selection('pick_series', 'series')],
      ),
      columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Two log-log charts against the number of elements: cost per step of
      ${distinct(rows.map((r) => r.method)).length} solvers in microseconds, and the ratio
      of composite to recursive, ours and the source's.`;
  },
};
