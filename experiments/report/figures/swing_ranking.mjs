// Simulators as rows, sorted by the time that they need for 1 %; those of tress coloured.
import { group_by, is_positive, swing_rows } from '../src/tables.mjs';
import { fastest_at, swing_levels, swing_runs } from '../src/strand.mjs';
import { lines_of, log_channel, log_extent, tooltips } from './common.mjs';
import { family_name } from './palette.mjs';

export const simulator_points = (tables) =>
  (tables.other_simulators_swing ?? []).flatMap((row) =>
    swing_levels
      .filter(({ simulator }) => is_positive(row[simulator]))
      .map(({ error, name, simulator }) => ({
        simulator: row.simulator,
        level: name,
        error_pct: 100 * error,
        wall_ms: 1e3 * row[simulator],
      })),
  );

export function ranking(tables, { width, style, theme }) {
  const runs = swing_runs(swing_rows(tables), 'time');
  const points = simulator_points(tables).map((p) => ({
    ...p,
    name: p.simulator,
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
        name: `tress: ${series}`,
        colour: style.colours[style.domain.indexOf(best.family ?? family_name(best.integrator))] ?? theme.text,
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
        'Published simulators (grey, another machine) and the three fastest integrators of tress: filled 1 %, hollow 0.1 %',
        width - 90,
        7.6,
      ),
    },
    width: plot_width,
    height: { step: narrow ? 32 : 18 },
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
