// Figure 2: max |g| over (alpha, beta), diverged cells, stability boundary, critical
// damping.
import {
  distinct,
  group_by,
  is_number,
  is_positive,
  study_rows,
  succeeded,
} from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { layout, log_extent, panels } from './common.mjs';
import { cell_axis } from './grid.mjs';

const keys = ['system', 'integrator', 'dt_s'];

// The predicted boundary as a polyline.
function predicted(tables, integrator, dt) {
  return boundary_points(tables, integrator, dt, 'omega_h_predicted')
    .sort((a, b) => a.zeta - b.zeta)
    .map((row, i) => ({ ...row, i }));
}

// Limits of the feedback through alpha = (omega h / dt)^2, beta = 2 zeta omega.
function boundary_points(tables, integrator, dt, column) {
  return study_rows(tables, 'constraint_drift', 'limit')
    .filter((row) => row.integrator === integrator && is_positive(row[column]))
    .map((row) => {
      const omega = row[column] / dt;
      return {
        alpha: omega ** 2,
        beta: 2 * row.zeta * omega,
        zeta: row.zeta,
        rel_gap: row.rel_gap,
      };
    });
}

function panel(members, tables, label, { panel_width, legend, colour_domain, theme }) {
  const alpha = cell_axis(members.map((row) => row.alpha));
  const beta = cell_axis(members.map((row) => row.beta));
  const { integrator, dt_s } = members[0];
  const cells = members.map((row) => {
    const [alpha_low, alpha_high] = alpha.edges(row.alpha);
    const [beta_low, beta_high] = beta.edges(row.beta);
    return {
      ...row,
      alpha_low,
      alpha_high,
      beta_low,
      beta_high,
      alpha_mid: alpha.shown(row.alpha),
      beta_mid: beta.shown(row.beta),
      good: succeeded(row) && is_positive(row.g_max),
    };
  });
  const inside = (row) =>
    row.alpha >= alpha.domain[0] &&
    row.alpha <= alpha.domain[1] &&
    row.beta >= beta.domain[0] &&
    row.beta <= beta.domain[1];
  const channel = (field, title, axis) => ({
    field,
    type: 'quantitative',
    title,
    scale: {
      type: axis.log ? 'log' : 'linear',
      domain: axis.domain,
      nice: false,
      ...(axis.log ? {} : { zero: false }),
    },
    axis: {
      grid: false,
      ...(axis.log
        ? {
            values: [
              ...(axis.zero ? [axis.zero] : []),
              ...log_extent(axis.domain, 6).ticks.filter(
                (t) => t > (axis.zero ?? 0) * 1.5,
              ),
            ],
            labelExpr:
              `datum.value == ${axis.zero ?? -1} ? '0' : ` +
              "(datum.value >= 0.01 && datum.value < 10000 ? format(datum.value, '~g') : " +
              "replace(format(datum.value, '.0e'), '+', ''))",
          }
        : { tickCount: 5 }),
    },
  });
  const x = channel('alpha_low', 'alpha (1/s²)', alpha);
  const y = channel('beta_low', 'beta (1/s)', beta);
  const xy = (fx, fy) => ({ x: { ...x, field: fx }, y: { ...y, field: fy } });
  const tooltip = [
    ['alpha', 'alpha (1/s²)'],
    ['beta', 'beta (1/s)'],
    ['g_max', 'max |g| (m)'],
    ['status', 'status'],
    ['reason', 'reason'],
  ].map(([field, title]) => ({ field, title, type: 'nominal' }));
  const critical = critical_curve(alpha, beta);
  const curves = {
    'predicted boundary': [[1, 0], 2.4],
    'critical damping': [[3, 4], 1.4],
  };
  const line = (name, values, order) => ({
    data: { values },
    mark: {
      type: 'line',
      clip: true,
      strokeWidth: curves[name][1],
      stroke: '#fff',
      strokeDash: curves[name][0],
      strokeJoin: 'round',
    },
    encoding: { ...xy('alpha', 'beta'), order: { field: order, type: 'quantitative' } },
  });
  const shadow = (layer) => ({
    ...layer,
    mark: {
      ...layer.mark,
      stroke: '#000',
      strokeWidth: layer.mark.strokeWidth + 2,
      strokeOpacity: 0.75,
    },
  });
  const edge = line('predicted boundary', predicted(tables, integrator, dt_s), 'i');
  const damping = line('critical damping', critical, 'alpha');
  const measured = boundary_points(tables, integrator, dt_s, 'omega_h_measured').filter(
    inside,
  );
  return {
    title: label,
    width: panel_width,
    height: Math.round(Math.min(panel_width, 330)),
    layer: [
      {
        data: { values: cells.filter((c) => c.good) },
        mark: { type: 'rect', tooltip: true },
        encoding: {
          ...xy('alpha_low', 'beta_low'),
          x2: { field: 'alpha_high' },
          y2: { field: 'beta_high' },
          color: {
            field: 'g_max',
            type: 'quantitative',
            title: 'max |g| (m)',
            legend,
            scale: { type: 'log', scheme: 'viridis', domain: colour_domain },
          },
          tooltip,
        },
      },
      {
        data: { values: cells.filter((c) => !c.good) },
        mark: { type: 'rect', color: theme.bad },
        encoding: {
          ...xy('alpha_low', 'beta_low'),
          x2: { field: 'alpha_high' },
          y2: { field: 'beta_high' },
          tooltip,
        },
      },
      {
        data: { values: cells.filter((c) => !c.good) },
        mark: {
          type: 'point',
          shape: 'M-0.7,-0.7L0.7,0.7M-0.7,0.7L0.7,-0.7',
          size: 34,
          stroke: theme.text,
          strokeWidth: 1.1,
          opacity: 0.7,
        },
        encoding: { ...xy('alpha_mid', 'beta_mid'), tooltip },
      },
      shadow(damping),
      damping,
      shadow(edge),
      edge,
      {
        data: { values: measured },
        mark: {
          type: 'point',
          shape: 'circle',
          size: 60,
          filled: true,
          fill: '#fff',
          stroke: '#000',
          strokeWidth: 1.3,
        },
        encoding: {
          ...xy('alpha', 'beta'),
          tooltip: [
            { field: 'zeta', title: 'zeta', type: 'nominal' },
            { field: 'rel_gap', title: 'gap to prediction (rel)', type: 'nominal' },
          ],
        },
      },
    ],
  };
}

// beta^2 = 4 alpha across the plotted range.
function critical_curve(alpha, beta) {
  const [low, high] = alpha.domain;
  return Array.from({ length: 200 }, (_, k) => {
    const t = k / 199;
    const a = alpha.log ? low * (high / low) ** t : low + (high - low) * t;
    return { alpha: a, beta: 2 * Math.sqrt(Math.max(a, 0)) };
  }).filter((p) => p.beta > 0 && p.beta >= beta.domain[0] && p.beta <= beta.domain[1]);
}

export const drift_heatmap = {
  id: 'drift_heatmap',
  title: 'Where feedback is stable: drift over alpha and beta',
  table: 'constraint_drift',
  headline(tables) {
    const rows = this.rows(tables);
    const failed = rows.filter((row) => !succeeded(row)).length;
    const gaps = study_rows(tables, 'constraint_drift', 'limit')
      .map((row) => row.rel_gap)
      .filter(is_number)
      .map(Math.abs);
    const off =
      gaps.length > 0
        ? `; the predicted boundary is off by at most ${format_number(100 * Math.max(...gaps), 2)} %`
        : '';
    return `${failed} of ${rows.length} pairs of feedback gains are unstable${off}`;
  },
  reading: `Colour: largest violation |g| of a run with feedback g'' = -alpha g - beta g'. Grey with a cross: diverged. White
    line: predicted boundary; dots: measured; dotted: critical damping, beta² = 4 alpha.`,
  caption: `Colour is the largest violation max |g| of one run with feedback g'' = -alpha
    g - beta g' (dark is small). Grey cells with a cross diverged. The solid white line is
    the boundary predicted for the integrator from the test equation; white dots are
    measured boundary points; the dotted line is critical damping, beta² = 4 alpha. Made from
    the rows of constraint_drift.csv whose study is "grid"; the boundary from those whose
    study is "limit".`,

  rows: (tables) =>
    study_rows(tables, 'constraint_drift', 'grid').filter(
      (row) =>
        row.formulation === 'baumgarte' && is_number(row.alpha) && is_number(row.beta),
    ),

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const varied = keys.filter((key) => distinct(rows.map((row) => row[key])).length > 1);
    const groups = [...group_by(rows, (row) => keys.map((key) => row[key]).join('|'))];
    const label = (row) =>
      (varied.length > 0 ? varied : ['integrator'])
        .map((key) =>
          key === 'dt_s' ? `dt = ${row.dt_s} s` : String(row[key]).replaceAll('_', ' '),
        )
        .join(', ');
    const size = layout(width, groups.length, { columns_max: 3 });
    const drawn = rows
      .filter(succeeded)
      .map((row) => row.g_max)
      .filter(is_positive);
    const colour_domain =
      drawn.length > 0 ? [Math.min(...drawn), Math.max(...drawn)] : [1e-9, 1];
    const gradient = { format: '.0e', tickCount: 6, gradientThickness: 12 };
    const legend =
      width >= 720
        ? { ...gradient, orient: 'right', gradientLength: 220 }
        : { ...gradient, orient: 'bottom', gradientLength: size.panel_width };
    return panels(
      groups.map(([, members]) =>
        panel(members, tables, label(members[0]), {
          panel_width: size.panel_width,
          legend,
          colour_domain,
          theme,
        }),
      ),
      size.columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    const failed = rows.filter((row) => !succeeded(row)).length;
    return `Heat maps of the largest violation over alpha and beta, one per integrator and
      step: ${rows.length} runs, ${failed} of them diverged.`;
  },
};
