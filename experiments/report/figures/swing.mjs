// Figure 8: wall time against tip error on the swinging strand, beside other simulators.
import { distinct, group_by, is_positive, swing_rows } from '../src/tables.mjs';
import { fastest_at, spaced, swing_levels, swing_runs } from '../src/strand.mjs';
import { swing_finding } from '../src/findings/swing.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  lines_of,
  log_channel,
  log_extent,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { series_style } from './palette.mjs';

// The runs of one series that no other run of it beats in both error and time.
export const front_of = (runs) =>
  runs.filter(
    (row) =>
      !runs.some(
        (other) =>
          other.error_rel <= row.error_rel &&
          other.wall_s <= row.wall_s &&
          (other.error_rel < row.error_rel || other.wall_s < row.wall_s),
      ),
  );

// What is worth drawing: a useless answer and rounding are not.
const error_range = [1e-7, 1];

const fronts = (tables, kind) =>
  [...group_by(swing_runs(swing_rows(tables), kind), (row) => row.series).values()]
    .flatMap(front_of)
    .filter(
      ({ error_rel }) =>
        error_rel >= error_range[0] && error_rel <= error_range[1],
    )
    .map((row) => ({
      ...row,
      error_pct: 100 * row.error_rel,
      wall_ms: 1e3 * row.wall_s,
    }));

const peer_points = (tables) =>
  (tables.peers_swing ?? []).flatMap((row) =>
    swing_levels
      .filter(({ peer }) => is_positive(row[peer]))
      .map(({ error, name, peer }) => ({
        peer: row.peer,
        level: name,
        error_pct: 100 * error,
        wall_ms: 1e3 * row[peer],
      })),
  );

const targets = swing_levels.map(({ error, target_s }) => ({
  error_pct: 100 * error,
  wall_ms: 1e3 * target_s,
  text: `${1e3 * target_s} ms`,
}));

function error_panel(title, rows, extra, { y_extent, x_extent, style, legend, ...look }) {
  const x = log_channel('error_pct', 'tip error (%)', x_extent);
  const y = log_channel('wall_ms', 'wall time (ms)', y_extent);
  const series = series_channels('series', 'integrator', style, legend);
  const opacity = dimmed_unless(['pick_integrator']);
  const halo = { fontSize: 11, align: 'left', dx: 11, baseline: 'middle' };
  const text = (mark) => ({
    data: { values: extra.targets },
    mark: { type: 'text', ...halo, ...mark },
    encoding: { x, y, text: { field: 'text' } },
  });
  return {
    title,
    width: look.panel_width,
    height: 340,
    layer: [
      {
        data: { values: rows },
        mark: { type: 'line', strokeWidth: 1.8 },
        encoding: {
          x,
          y,
          ...series,
          shape: undefined,
          order: { field: 'error_pct', type: 'quantitative' },
          opacity,
        },
      },
      {
        data: { values: extra.peers },
        mark: {
          type: 'tick',
          orient: 'horizontal',
          size: 16,
          thickness: 1.5,
          color: look.theme.axis,
        },
        encoding: {
          x,
          y,
          tooltip: tooltips([
            ['peer', 'simulator'],
            ['level', 'at an error of'],
            ['wall_ms', 'wall time (ms)', '.3g'],
          ]),
        },
      },
      {
        data: { values: rows },
        mark: { type: 'point', filled: true, size: 45 },
        encoding: {
          x,
          y,
          ...series,
          strokeDash: undefined,
          opacity,
          tooltip: tooltips([
            ['integrator', 'integrator'],
            ['model', 'model'],
            ['solver', 'solver'],
            ['modes', 'modes'],
            ['elements', 'elements'],
            ['dt_s', 'dt (s)'],
            ['rtol', 'rtol'],
            ['error_pct', 'tip error (%)', '.3g'],
            ['wall_ms', 'wall time (ms)', '.3g'],
            ['steps', 'steps'],
          ]),
        },
      },
      {
        data: { values: extra.targets },
        mark: {
          type: 'point',
          shape: 'circle',
          filled: false,
          size: 190,
          strokeWidth: 2,
          color: look.theme.text,
        },
        encoding: { x, y },
      },
      text({ stroke: look.theme.background, strokeWidth: 4, strokeJoin: 'round' }),
      text({ color: look.theme.text, fontWeight: 600 }),
    ],
  };
}

// Every simulator as a row, sorted by the time it needs for 1 %; ours coloured among them.
function ranking(tables, { width, style, theme }) {
  const runs = swing_runs(swing_rows(tables), 'time');
  const points = peer_points(tables).map((p) => ({
    ...p,
    name: p.peer,
    colour: theme.axis,
  }));
  const fastest = [...group_by(runs, (row) => row.series)]
    .map(([series, members]) => ({ series, members, best: fastest_at(members, 1e-2) }))
    .filter(({ best }) => best !== undefined)
    .sort((a, b) => a.best.wall_s - b.best.wall_s)
    .slice(0, 3);
  for (const { series, members } of fastest) {
    for (const { error, name: level } of swing_levels) {
      const best = fastest_at(members, error);
      if (best === undefined) continue;
      points.push({
        name: `ours: ${series}`,
        colour: style.colours[style.domain.indexOf(series)],
        level,
        wall_ms: 1e3 * best.wall_s,
      });
    }
  }
  // Labels stand left of where x begins, or above their row where there is no room. They
  // are text inside the plot, so that both rows of the figure start at the same edge.
  const narrow = width < 720;
  const plot_width = Math.floor(width - 84);
  const longest = Math.max(...points.map((p) => p.name.length));
  const label_room = narrow ? 0 : Math.min(6.6 * longest + 12, 0.45 * width);
  const rank = ([, members]) =>
    Math.min(
      ...members.map((p) => p.wall_ms + (p.level === swing_levels[0].name ? 0 : 1e9)),
    );
  const order = [...group_by(points, (p) => p.name)]
    .sort((a, b) => rank(a) - rank(b))
    .map(([name, members]) => ({
      name,
      low: Math.min(...members.map((p) => p.wall_ms)),
      high: Math.max(...members.map((p) => p.wall_ms)),
    }));
  const x_of = log_channel(
    'wall_ms',
    'wall time for 2 simulated seconds (ms)',
    log_extent(
      points.map((p) => p.wall_ms),
      5,
    ),
  );
  const x = { ...x_of, scale: { ...x_of.scale, range: [label_room, plot_width] } };
  const y = {
    field: 'name',
    type: 'nominal',
    title: null,
    axis: null,
    scale: { domain: order.map((row) => row.name) },
  };
  const row_y = narrow ? { yOffset: 8 } : {};
  const label_place = narrow
    ? { x: -56, align: 'left', dy: -8, fontSize: 10 }
    : { x: label_room - 10, align: 'right', fontSize: 11, clip: true };
  const marks = [...group_by(points, (p) => `${p.colour}|${p.level}`).values()];
  return {
    title: {
      text: lines_of(
        'Published simulators (grey, another machine) and our fastest three: filled 1 %, hollow 0.1 %',
        width - 90,
        7.6,
      ),
    },
    width: plot_width,
    height: { step: narrow ? 32 : 20 },
    layer: [
      {
        data: { values: order },
        mark: { type: 'rule', color: theme.axis, strokeWidth: 1.2, ...row_y },
        encoding: { x: { ...x, field: 'low' }, x2: { field: 'high' }, y },
      },
      {
        data: { values: order },
        mark: { type: 'text', baseline: 'middle', color: theme.text, ...label_place },
        encoding: { y, text: { field: 'name' } },
      },
      ...marks.map((values) => ({
        data: { values },
        mark: {
          type: 'point',
          filled: values[0].level === swing_levels[0].name,
          color: values[0].colour,
          size: 60,
          strokeWidth: 1.8,
          ...row_y,
        },
        encoding: {
          x,
          y,
          tooltip: tooltips([
            ['name', 'simulator'],
            ['level', 'at an error of'],
            ['wall_ms', 'wall time (ms)', '.3g'],
          ]),
        },
      })),
    ],
  };
}

export const swing = {
  id: 'swing',
  title: 'A swinging strand at a stated error, with other simulators',
  table: 'work_precision',
  finding: swing_finding,
  caption: `Wall time of 2 simulated seconds on one core against the tip error (root mean
    square over the run, over the strand's length); down and left is better. Each line
    joins the runs of one integrator that none of its other runs beats in both. Grey ticks
    at 1 % and 0.1 %, and the rows below, are other simulators as published: time error
    against their own finest run at 20 elements, measured on another machine of the same
    class, so trust ratios. Large rings are the targets, 20 ms and 50 ms. Errors under
    1e-5 % and over 100 % are not drawn. Made from
    work_precision.csv and peers_swing.csv; failed runs are in the tables only.`,

  rows: (tables) => [...fronts(tables, 'time'), ...fronts(tables, 'total')],

  spec(tables, { width, theme }) {
    const style = series_style(this.rows(tables).map((row) => row.series));
    const peers = peer_points(tables);
    const kinds = [
      ['time', 'Time error', { peers, targets }],
      ['total', 'Total error', { peers: [], targets: [] }],
    ].filter(([kind]) => fronts(tables, kind).length > 0);
    const { columns, panel_width, legend } = layout(width, kinds.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const list = kinds.map(([kind, title, extra]) => {
      const rows = fronts(tables, kind);
      const all = [...rows, ...extra.peers, ...extra.targets];
      return error_panel(title, rows, extra, {
        x_extent: log_extent(
          all.map((r) => r.error_pct),
          6,
        ),
        y_extent: log_extent(all.map((r) => r.wall_ms)),
        panel_width,
        legend,
        style,
        theme,
      });
    });
    const errors = panels(
      with_parameters(list, [legend_selection('pick_integrator', 'series')]),
      columns,
    );
    if (peers.length === 0) return errors;
    // Two rows of their own, so that neither stretches the other's columns.
    return {
      vconcat: [errors, ranking(tables, { width, style, theme })],
      spacing: 30,
      resolve: errors.resolve,
    };
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Wall time in milliseconds against tip error in percent, log-log, one line for
      each of ${distinct(rows.map((r) => spaced(r.series))).length} integrators, the
      targets marked, and ${(tables.peers_swing ?? []).length} published configurations of
      other simulators.`;
  },
};
