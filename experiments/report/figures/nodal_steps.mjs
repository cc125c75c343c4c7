// Figure 11: the step that nodal finite differences of a rod need.
import { distinct, is_positive, study_rows } from '../src/tables.mjs';
import { format_time } from '../src/format.mjs';
import { code, is_capped, spaced } from '../src/strand.mjs';
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

const claimed_s = 1e-5;
const claimed_nodes = 200;

const method_of = (row, name = row.integrator) =>
  name +
  (row.jacobian === 'elastic' ? ', split' : '') +
  (row.start === 'plane' ? ', in a plane' : '');

const rows_of = (tables) =>
  study_rows(tables, 'stability_limit', 'nodal')
    .filter((row) => is_positive(row.dt_max_s))
    .map((row) => ({
      ...row,
      limited_by: row.limited_by ?? '',
      method: method_of(row),
      dt_us: 1e6 * row.dt_max_s,
    }));

export function nodal_step_findings(tables) {
  const at = study_rows(tables, 'stability_limit', 'nodal').filter(
    (row) => row.elements === claimed_nodes && row.at_claim,
  );
  return at.map((row) => {
    const outcome =
      row.at_claim === 'nothing'
        ? 'stable'
        : `unstable (${row.at_claim}) after ${format_time(row.t_claim_s)}`;
    const limit = is_positive(row.dt_max_s)
      ? `; largest stable step found ${format_time(row.dt_max_s)}`
      : '';
    return (
      `${method_of(row, code(row.integrator))}, ${claimed_nodes} nodes at ${format_time(claimed_s)}: ` +
      `${outcome}${limit}.`
    );
  });
}

export const nodal_steps = {
  id: 'nodal_steps',
  title: 'The step of a nodal scheme',
  table: 'stability_limit',
  headline(tables) {
    const at = rows_of(tables)
      .filter((row) => row.elements === claimed_nodes)
      .sort((a, b) => b.dt_max_s - a.dt_max_s);
    const said = distinct([at[0], at.at(-1)].filter(Boolean)).map(
      (row) => `${is_capped(row) ? 'at least ' : ''}${format_time(row.dt_max_s)} with ${spaced(row.method)}`,
    );
    return said.length > 0
      ? `Largest stable step of ${claimed_nodes} nodes: ${said.join(', ')}; published: ${format_time(claimed_s)}`
      : `No stable step was found for ${claimed_nodes} nodes`;
  },
  reading: `Finite differences of the rod in curvatures. Split: implicit in the terms of highest order only. Hollow with an
    arrow: a lower bound, stable up to the end of the scan.`,
  caption: `Largest stable step of finite differences of Kirchhoff's equations in curvatures
    against the number of nodes, a straight hair of 10 cm let go horizontally. Split:
    implicit in the terms of highest order only. Hollow with an arrow: stable up to the end
    of the scan, a lower bound. Made from
    the rows of stability_limit.csv whose study is "nodal".`,

  rows: rows_of,

  spec(tables, { width, theme }) {
    const rows = rows_of(tables);
    const style = series_style(rows.map((row) => row.method));
    const { columns, panel_width, legend } = layout(width, 1, {
      columns_max: 1,
      labels: style.domain,
      above: true,
    });
    const sizes = distinct(rows.map((row) => row.elements)).sort((a, b) => a - b);
    const x = log_channel('elements', 'nodes', { domain: [16, 420], ticks: sizes });
    const y = log_channel(
      'dt_us',
      'largest stable step (µs)',
      log_extent(rows.map((row) => row.dt_us), 7),
    );
    const series = series_channels('method', 'method', style, legend);
    const opacity = dimmed_unless(['pick_method']);
    const tooltip = tooltips([
      ['method', 'method'],
      ['elements', 'nodes'],
      ['dt_us', 'largest stable step (µs)', '.3g'],
      ['limited_by', 'limited by'],
      ['at_claim', 'at 10 µs'],
    ]);
    const bound = (mark, encoding) => ({
      data: { values: rows.filter(is_capped) },
      mark,
      encoding: { x, y, color: series.color, opacity, ...encoding },
    });
    const claim = [{ elements: claimed_nodes, dt_us: 1e6 * claimed_s }];
    const plot = {
      width: panel_width,
      height: 320,
      layer: [
        ...marked_line(
          rows.filter((row) => !is_capped(row)),
          { x, y, series, opacity, tooltip },
        ),
        bound(
          { type: 'point', filled: false, size: 65, strokeWidth: 1.7 },
          { shape: series.shape, tooltip },
        ),
        bound({ type: 'text', text: '\u2191', dy: -13, fontSize: 14 }, {}),
        {
          data: { values: claim },
          mark: {
            type: 'point',
            shape: 'cross',
            filled: false,
            size: 190,
            strokeWidth: 2,
            color: theme.text,
          },
          encoding: { x, y },
        },
        {
          data: { values: claim },
          mark: { type: 'text', text: 'published', align: 'left', dx: 13, color: theme.text },
          encoding: { x, y },
        },
      ],
    };
    return panels(
      with_parameters([plot], [legend_selection('pick_method', 'method')]),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Largest stable step in microseconds, log scale, against the number of nodes, for
      ${distinct(rows.map((row) => row.method)).length} methods; the claimed point of 200 nodes
      at 10 microseconds is marked.`;
  },
};
