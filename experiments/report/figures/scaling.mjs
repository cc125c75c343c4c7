// Figure 7: cost per step against elements, model by model, and composite against
// recursive.
import { distinct, group_by, is_positive, succeeded } from '../src/tables.mjs';
import { method_name, scaling_series, solver_pairs, spaced } from '../src/strand.mjs';
import { scaling_finding } from '../src/findings/scaling.mjs';
import { layout, log_channel, log_extent, panels, spread, tooltips } from './common.mjs';
import { method_style } from './palette.mjs';

// All modes of every solver; fewer modes of the recursion alone and maximal coordinates by
// the band solver alone, to keep lines apart.
const drawn = ({ members: [row] }) =>
  row.solver !== 'klu' &&
  (['', 'bend_twist'].includes(row.modes ?? '') ||
    (row.solver === 'recursive' && row.tangent !== 'exact'));

// A panel for each of the models that have several solvers, one for all others.
const panel_names = {
  super_helix: 'super helix: cost of one step',
  articulated_chain: 'articulated chain: cost of one step',
};
const others = 'other models: cost of one step';
const panel_of = ({ model }) => panel_names[model.replace(/_tree$/, '')] ?? others;

// The name of a line beside its end, without what the panel's title says.
const label = ({ name, exponent }) => {
  const short = name.replace(/^articulated chain, |, banded/g, '');
  return is_positive(exponent) ? `${short}: N^${exponent.toFixed(2)}` : short;
};

const panel_height = 330;
const ours = '#1F7FC2';
const source = '#D55E00';

// Ratio of the two solvers: ours as a line with the trees beside it, the published one dashed.
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
    title: 'Cost of composite over recursive',
    width: panel_width,
    height: panel_height,
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

// One line per solver, its name at its end.
function cost_panel(title, rows, trees, { panel_width, x, y, style }) {
  const nominal = (range) => ({
    field: 'method',
    type: 'nominal',
    scale: { domain: style.domain, range },
    legend: null,
  });
  const color = nominal(style.colours);
  const tooltip = tooltips([
    ['structure', 'structure'],
    ['method', 'solver'],
    ['elements', 'elements'],
    ['cost_us', 'cost per step (µs)', '.3g'],
    ['exponent', 'slope', '.2f'],
    ['dt_max_s', 'largest stable dt (s)', '.3e'],
    ['fps', 'frames per second', '.3g'],
    ['seed_fps', 'published frames per second'],
  ]);
  const names = [...group_by(rows, (row) => row.method).values()].map((members) =>
    members.reduce((last, row) => (row.elements > last.elements ? row : last)),
  );
  const font_size = panel_width < 300 ? 9.5 : 11;
  const longest = Math.max(...names.map((row) => row.series.length));
  const room = 0.56 * font_size * longest + 16;
  const plot_width = Math.floor(Math.max(90, panel_width - room));
  const [bottom, top] = y.scale.domain.map(Math.log10);
  const pixels = panel_height / (top - bottom);
  const places = spread(
    names.map((row) => pixels * (top - Math.log10(row.cost_us))),
    font_size + 3,
    panel_height,
  ).map((place) => 10 ** (top - place / pixels));
  return {
    title,
    width: plot_width,
    height: panel_height,
    layer: [
      {
        data: { values: rows },
        mark: { type: 'line', strokeWidth: 1.6 },
        encoding: { x, y, color, strokeDash: nominal(style.dashes) },
      },
      {
        data: { values: rows },
        mark: { type: 'point', filled: true, size: 45 },
        encoding: { x, y, color, shape: nominal(style.shapes), tooltip },
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
        encoding: { x, y, color, tooltip },
      },
      {
        data: { values: names.map((row, i) => ({ ...row, place: places[i] })) },
        mark: {
          type: 'text',
          align: 'left',
          baseline: 'middle',
          fontSize: font_size,
          x: plot_width + 8,
        },
        encoding: { y: { ...y, field: 'place' }, text: { field: 'series' }, color },
      },
    ],
  };
}

export const scaling = {
  id: 'scaling',
  title: 'Cost against the number of elements',
  table: 'scaling',
  finding: scaling_finding,
  caption: `Cost of one time step against the number of elements of a straight strand, one
    line per solver, with the power of N fitted by the experiment from 20 elements on; hollow
    diamonds are the five trees. Last: how many times the recursive step the composite one
    costs; diamonds are trees, squares what the published frames per second say (rounded
    there, and equal at one and two elements). Its hardware was of 2008, so its frames per
    second are not comparable with ours, the ratio is. Made from scaling.csv.`,

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
    const drawn_methods = new Map(rows.map((row) => [row.method, row.series]));
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
        method: method_name(row),
        series: drawn_methods.get(method_name(row)),
        cost_us: 1e6 * row.cost_per_step_s,
      }))
      .filter((row) => row.series !== undefined);
    const pairs = solver_pairs(tables.scaling).filter((p) => p.ours || p.source);
    const groups = group_by(rows, panel_of);
    const titles = [...Object.values(panel_names), others].filter((t) => groups.has(t));
    const { columns, panel_width } = layout(width, titles.length + (pairs.length > 0), {
      columns_max: 2,
      above: true, // no legend: names stand at the lines
    });
    const all = [...rows, ...trees];
    const shared = {
      panel_width,
      style: method_style(rows.map((row) => row.method)),
      x: log_channel('elements', 'elements', log_extent(all.map((r) => r.elements))),
      y: log_channel(
        'cost_us',
        'cost per step (µs)',
        log_extent(all.map((r) => r.cost_us)),
      ),
    };
    return panels(
      [
        ...titles.map((title) =>
          cost_panel(
            title,
            groups.get(title),
            trees.filter((row) => panel_of(row) === title),
            shared,
          ),
        ),
        ...(pairs.length > 0 ? [ratio_panel(pairs, { panel_width, theme })] : []),
      ],
      columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Two log-log charts against the number of elements: cost per step of
      ${distinct(rows.map((r) => r.method)).length} solvers in microseconds, and the ratio
      of composite to recursive, ours and the published ones.`;
  },
};
