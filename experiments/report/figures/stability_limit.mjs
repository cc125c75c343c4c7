// Figure 6: largest stable time step against the number of elements, scene x damping.
import { distinct, group_by, is_positive, study_rows } from '../src/tables.mjs';
import {
  damping_name,
  damping_rank,
  frame_s,
  has_limit,
  is_capped,
  is_reduced,
  principal_runs,
  run_name,
  scan_end_s,
  spaced,
} from '../src/strand.mjs';
import { stability_finding } from '../src/findings/stability.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  lines_of,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { method_style } from './palette.mjs';

const elements_end = 40;
const cap_ms = 1e3 * scan_end_s;
const frame_ms = 1e3 * frame_s;
const lane_factor = 1.42;
const gap = 14;
const axis_room = 72;
// What marks and tick labels at the ends of x reach beyond a panel.
const overhang = 6;

const grouped = ['recursive', 'composite'];

// Steps at the end of the scan would hide each other: every method has a lane of its own
// in the band above, recursive and composite one together.
function with_places(rows, domain) {
  const lanes = distinct(
    domain.map((name) => (grouped.includes(name) ? grouped[0] : name)),
  );
  const lane = (name) => lanes.indexOf(grouped.includes(name) ? grouped[0] : name);
  return {
    top: cap_ms * lane_factor ** (lanes.length + 0.7),
    placed: rows.map((row) => ({
      ...row,
      dt_ms: is_capped(row)
        ? cap_ms * lane_factor ** (lane(row.method) + 0.85)
        : has_limit(row)
          ? 1e3 * row.dt_max_s
          : null,
      capped: is_capped(row),
    })),
  };
}

// A line joins measured limits: it ends where a bound of the scan lies between them.
function with_stretches(rows) {
  return [...group_by(rows, (row) => row.method).values()].flatMap((members) => {
    let stretch = 0;
    return [...members]
      .sort((a, b) => a.elements - b.elements)
      .map((row) => ({ ...row, stretch: row.capped ? ++stretch : stretch }));
  });
}

function axes({ bottom, top, first, last_row }) {
  const first_decade = Math.ceil(Math.log10(bottom));
  const decades = Array.from(
    { length: 3 - first_decade },
    (_, k) => 10 ** (first_decade + k),
  );
  return {
    x: {
      field: 'elements',
      type: 'quantitative',
      title: last_row ? 'elements' : null,
      scale: { domain: [0, elements_end + 1], nice: false },
      axis: { values: [0, 10, 20, 30, 40] },
    },
    y: {
      field: 'dt_ms',
      type: 'quantitative',
      title: first ? 'largest stable dt (ms)' : null,
      scale: { type: 'log', domain: [bottom, top], nice: false },
      axis: {
        values: [...decades, frame_ms],
        labels: first,
        ticks: first,
        labelOverlap: false,
        labelExpr:
          `datum.value == ${cap_ms} ? '≥ ${cap_ms}' : ` +
          "format(datum.value, datum.value > 1 ? '.0f' : '~g')",
      },
    },
  };
}

function panel(
  members,
  { x, y, style, legend, panel_width, height, theme, top, bottom },
) {
  const series = series_channels('method', 'method', style, legend);
  const opacity = dimmed_unless(['pick_method']);
  const tooltip = tooltips([
    ['method', 'method'],
    ['integrator', 'integrator'],
    ['elements', 'elements'],
    ['dt_max_s', 'largest stable dt (s)', '.3e'],
    ['dt_first_unstable_s', 'first unstable dt (s)', '.3e'],
    ['limited_by', 'limited by'],
    ['cost_per_step_s', 'cost per step (s)', '.3e'],
    ['realtime_factor', 'simulated s per s', '.3g'],
  ]);
  const stable = with_stretches(members.filter((row) => row.dt_ms !== null));
  const hollow = (row) => row.capped || row.method === 'composite';
  return {
    title: {
      text: spaced(members[0].scene),
      subtitle: damping_name(members[0]),
      subtitleColor: theme.muted,
      subtitleFontSize: 12,
      offset: 6,
    },
    width: panel_width,
    height,
    layer: [
      {
        data: {
          values: stable.filter((row) => row.method !== 'composite' && !row.capped),
        },
        mark: { type: 'line', strokeWidth: 1.8 },
        encoding: {
          x,
          y,
          ...series,
          shape: undefined,
          opacity,
          detail: { field: 'stretch' },
        },
      },
      {
        data: { values: [{ low: cap_ms, high: top }] },
        mark: { type: 'rect', color: theme.axis, opacity: 0.16 },
        encoding: { y: { ...y, field: 'low' }, y2: { field: 'high' } },
      },
      {
        data: { values: [{ dt_ms: frame_ms }] },
        mark: { type: 'rule', strokeDash: [5, 4], color: theme.text },
        encoding: { y },
      },
      ...[
        [(row) => !hollow(row), { filled: true, size: 48 }],
        [(row) => hollow(row) && row.method !== 'composite', { filled: false, size: 38 }],
        [(row) => row.method === 'composite', { filled: false, size: 130 }],
      ].map(([is_of, mark]) => ({
        data: { values: stable.filter(is_of) },
        mark: { type: 'point', strokeWidth: 1.7, ...mark },
        encoding: { x, y, ...series, strokeDash: undefined, opacity, tooltip },
      })),
      {
        data: {
          values: members
            .filter((row) => row.dt_ms === null)
            .map((row) => ({ ...row, dt_ms: bottom * 1.25 })),
        },
        mark: {
          type: 'point',
          shape: 'M-0.7,-0.7L0.7,0.7M-0.7,0.7L0.7,-0.7',
          size: 50,
          strokeWidth: 1.7,
        },
        encoding: { x, y, color: series.color, opacity, tooltip },
      },
    ],
  };
}

// What a limit can be drawn from: the search found one, or found none.
export const is_drawn = (row) =>
  is_positive(row.elements) &&
  row.elements <= elements_end &&
  (has_limit(row) ||
    (row.status === 'unstable' && is_positive(row.dt_first_unstable_s)));

// Rows with a `method` each: one panel per scene and damping, one line per method, in
// `columns` at least where there are as many panels.
export function limit_spec(rows, style, { width, theme }, columns_wanted = 3) {
  const { placed, top } = with_places(rows, style.domain);
  const smallest = Math.min(
    ...placed.map((row) => row.dt_ms ?? 1e3 * row.dt_first_unstable_s),
    frame_ms / 10,
  );
  const bottom = smallest / 1.6;
  const groups = [
    ...group_by(
      [...placed].sort((a, b) => damping_rank(a) - damping_rank(b)),
      (row) => `${row.scene}|${row.damping}`,
    ).values(),
  ];
  // Columns are dampings where they fit: scenes that have all of them come first, and
  // only the first column carries the labels of y.
  const scenes = distinct(rows.map((row) => row.scene));
  const panels_of = (group) => groups.filter(([row]) => row.scene === group[0].scene);
  const wanted = Math.max(
    Math.min(columns_wanted, groups.length),
    ...groups.map((group) => panels_of(group).length),
  );
  const place = (group) =>
    (panels_of(group).length === wanted ? 0 : scenes.length) +
    scenes.indexOf(group[0].scene);
  groups.sort((a, b) => place(a) - place(b));
  const columns = width >= 150 * wanted + axis_room + 100 ? wanted : 1;
  const room = width - axis_room - 8 - columns * overhang - (columns - 1) * gap;
  const { legend } = layout(width, groups.length, {
    labels: style.domain,
    above: true,
  });
  const list = groups.map((members, i) => {
    const { x, y } = axes({
      bottom,
      top,
      first: i % columns === 0,
      last_row: columns === 1 || i + columns >= groups.length,
    });
    return panel(members, {
      x,
      y,
      style,
      legend,
      panel_width: Math.floor(room / columns),
      height: columns === 1 ? 190 : 220,
      theme,
      top,
      bottom,
    });
  });
  return {
    title: {
      text: lines_of(
        'Filled, joined: the limit that was measured. Hollow, in the shaded band: a lower ' +
          'bound, stable up to the end of the scan (100\u00a0ms; curl drop 33\u00a0ms, whip 5\u00a0ms: longer ' +
          'steps miss the drive). Cross: no stable step found. Dashed: 33\u00a0ms, one frame at 30 ' +
          'frames/s.',
        width - 20,
      ),
      fontSize: 12,
      fontWeight: 'normal',
      color: theme.muted,
    },
    ...panels(
      with_parameters(list, [legend_selection('pick_method', 'method')]),
      columns,
    ),
    spacing: { row: 22, column: gap },
  };
}

export const stability_limit = {
  id: 'stability_limit',
  title: 'The largest stable time step',
  table: 'stability_limit',
  finding: stability_finding,
  caption: `Largest stable time step against the number of elements, one panel per scene
    and damping. Composite is drawn as hollow squares on the line of recursive: the two
    solve the same equations. Hollow marks in the shaded band are lower bounds, runs that
    were stable up to the end of the scan, 100 ms; the height inside the band means nothing. The dashed line is
    33 ms, one frame at 30 frames/s. A cross at the bottom: no stable step was found. The
    step is the papers' semi-implicit one unless the legend says otherwise. Made from
    stability_limit.csv, up to 40 elements; other solvers, integrators and modes, and
    searches that ran out of time, are in the tables only.`,

  rows: (tables) =>
    principal_runs(
      study_rows(tables, 'stability_limit', 'grid').filter(
        (row) => is_reduced(row) && is_drawn(row),
      ),
    ).map((row) => ({ ...row, method: run_name(row) })),

  spec(tables, options) {
    const rows = this.rows(tables);
    return limit_spec(rows, method_style(rows.map((row) => row.method)), options);
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Largest stable time step in milliseconds, log scale, against the number of
      elements: ${distinct(rows.map((r) => `${r.scene} ${r.damping}`)).length} panels of scene and damping,
      ${distinct(rows.map((r) => r.method)).length} methods, 33 ms marked,
      ${rows.filter(is_capped).length} runs stable up to the end of the scan.`;
  },
};
