// The cheapest run for a target error, scene by scene, and the effect of each choice.
import { distinct, group_by, is_number, is_positive, succeeded } from '../src/tables.mjs';
import {
  format_elements,
  format_number,
  format_ratio,
  format_steps,
  format_time,
} from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
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
import { model_style } from './palette.mjs';

const rows_of = (tables) =>
  (tables.cost_of_accuracy ?? [])
    .filter(
      (row) =>
        succeeded(row) && is_positive(row.wall_s_per_sim_s) && is_positive(row.error_rel),
    )
    .map((row) => ({
      ...row,
      name: spaced(row.model),
      method: spaced(row.integrator),
      wall_ms: 1e3 * row.wall_s_per_sim_s,
      error_pct: 100 * row.error_rel,
      steps: format_steps(row),
      how: [row.modes, row.tangent, row.solver, row.options].filter(Boolean).join(', '),
    }));

const percent = (value) => `${format_number(100 * value)} %`;

const run_text = (row) =>
  `${row.name}, ${row.method}, ${format_elements(row)} elements, ` +
  format_steps(row, (dt) => `steps of ${format_time(dt)}`);

const of_kind = (rows, kind) => rows.filter((row) => row.kind === kind);

// One sentence per scene at `target`, the winner and the runner-up.
function winner_sentences(rows, target) {
  return [...group_by(rows, (row) => row.scene)].flatMap(([scene, members]) => {
    const winner = of_kind(members, 'winner').find(
      (row) => row.target_error_rel === target,
    );
    if (!winner) return [];
    const second = of_kind(members, 'runner_up').find(
      (row) => row.target_error_rel === target,
    );
    return [
      `${spaced(scene)}, ${percent(target)}: ${run_text(winner)}, ` +
        `${format_time(winner.wall_s_per_sim_s)} a simulated second` +
        (second
          ? `; next ${run_text(second)}, ` +
            `${format_ratio(second.wall_ms / winner.wall_ms)} the time.`
          : '.'),
    ];
  });
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const half = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

// The median, over scenes and targets, of what replacing one choice costs.
const choice_medians = (rows) =>
  [
    ...group_by(
      of_kind(rows, 'without').filter((row) => is_positive(row.cost_factor)),
      (row) => row.choice,
    ),
  ]
    .map(([choice, members]) => ({
      choice,
      factor: median(members.map((row) => row.cost_factor)),
    }))
    .sort((a, b) => b.factor - a.factor);

const choice_words = {
  elements: 'number of elements',
  dt_s: 'time step',
  tolerance: 'step control',
  extrapolated: 'extrapolation',
  cuts: 'cuts of elements',
  refresh: 'refresh of the matrix',
};
const choice_name = (choice) => choice_words[choice] ?? spaced(choice);

export function cost_findings(tables) {
  const rows = rows_of(tables);
  const targets = distinct(of_kind(rows, 'winner').map((row) => row.target_error_rel));
  const wanted = targets.includes(0.01) ? 0.01 : targets[0];
  const medians = choice_medians(rows);
  const said = winner_sentences(rows, wanted);
  if (medians.length > 0)
    said.push(
      `Effect of a choice (time after it is replaced by the next best that keeps the error, over the winner's, median over ` +
        `scenes and targets): ${medians
          .map(({ choice, factor }) => `${choice_name(choice)} ${format_ratio(factor)}`)
          .join(', ')}.`,
    );
  return [
    ...said,
    ...targets
      .filter((target) => target !== wanted)
      .flatMap((target) => winner_sentences(rows, target)),
  ];
}

export const cost_of_accuracy = {
  id: 'cost_of_accuracy',
  title: 'Error and time, scene by scene',
  table: 'cost_of_accuracy',
  caption: `One panel per scene: the runs that nothing beats in both error and time. Down and to the
    left is better. Large marks are the winners at a target error, hollow ones the runners-up, which differ in model or
    integrator. Errors are of the tip, against the continuous rod, over the length of the strand. A click on a name in the
    legend keeps one model. Made from cost_of_accuracy.csv.`,

  rows: (tables) =>
    rows_of(tables).filter((row) => ['front', 'winner', 'runner_up'].includes(row.kind)),

  spec(tables, { width }) {
    const rows = this.rows(tables);
    const style = model_style(rows.map((row) => row.name));
    const scenes = [...group_by(rows, (row) => row.scene)];
    const { columns, panel_width, legend } = layout(width, scenes.length, {
      columns_max: 3,
      labels: style.domain,
      above: true,
    });
    const x = log_channel(
      'error_pct',
      'error (%)',
      log_extent(rows.map((row) => row.error_pct)),
    );
    const margin = rows.some((row) => is_number(row.margin));
    const tooltip = tooltips([
      ['kind', 'kind'],
      ['target_error_rel', 'target error', '.1%'],
      ['name', 'model'],
      ['method', 'integrator'],
      ['how', 'options'],
      ['elements', 'elements'],
      ['steps', 'step'],
      ['error_pct', 'error (%)', '.3g'],
      ['wall_ms', 'time per simulated second (ms)', '.3g'],
      ...(margin ? [['margin', 'margin', '.3g']] : []),
    ]);
    const opacity = dimmed_unless(['pick_model']);
    const list = scenes.map(([scene, members]) => {
      const y = log_channel(
        'wall_ms',
        'time per simulated second (ms)',
        log_extent(members.map((row) => row.wall_ms)),
      );
      const series = series_channels('name', 'model', style, legend);
      const points = (kinds, mark) => ({
        data: { values: members.filter((row) => kinds.includes(row.kind)) },
        mark: { type: 'point', ...mark },
        encoding: { x, y, ...series, strokeDash: undefined, opacity, tooltip },
      });
      return {
        title: spaced(scene),
        width: panel_width,
        height: 220,
        layer: [
          points(['front'], { filled: true, size: 34 }),
          points(['runner_up'], { filled: false, size: 110, strokeWidth: 1.8 }),
          points(['winner'], { filled: true, size: 130 }),
        ],
      };
    });
    return panels(
      with_parameters(list, [legend_selection('pick_model', 'name')]),
      columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Time per simulated second against tip error, both log scale, of the best runs of
      ${distinct(rows.map((row) => row.scene)).length} scenes and
      ${distinct(rows.map((row) => row.name)).length} models.`;
  },
};

const choice_rows = (tables) =>
  of_kind(rows_of(tables), 'without')
    .filter((row) => is_number(row.cost_factor))
    .map((row) => ({
      ...row,
      replaced: choice_name(row.choice),
      situation: spaced(row.scene),
    }));

export const cost_choices = {
  id: 'cost_choices',
  title: 'Effect of each choice',
  table: 'cost_of_accuracy',
  caption: `How many times as long a run takes when one choice of the winner is replaced by the best alternative
    that still meets the target error: the model, the integrator, the linear solver or tangent, the modes, twice
    the elements, half the step. One mark per scene and target error. Made from cost_of_accuracy.csv.`,

  rows: choice_rows,

  spec(tables, { width }) {
    const rows = choice_rows(tables);
    const style = model_style(rows.map((row) => row.situation));
    const { panel_width, legend } = layout(width, 1, { labels: style.domain, above: true });
    const x = log_channel(
      'cost_factor',
      "time over the winner's",
      log_extent(rows.map((row) => row.cost_factor)),
    );
    return {
      width: Math.max(220, panel_width - 120),
      height: { step: 26 },
      data: { values: rows },
      mark: { type: 'point', filled: true, size: 70 },
      params: [legend_selection('pick_scene', 'situation')],
      encoding: {
        x,
        y: {
          field: 'replaced',
          type: 'nominal',
          title: null,
          axis: { labelLimit: 0, grid: true },
        },
        ...series_channels('situation', 'scene', style, legend),
        strokeDash: undefined,
        opacity: dimmed_unless(['pick_scene'], 0.85),
        tooltip: tooltips([
          ['situation', 'scene'],
          ['target_error_rel', 'target error', '.1%'],
          ['replaced', 'replaced'],
          ['name', 'best alternative: model'],
          ['method', 'integrator'],
          ['how', 'options'],
          ['elements', 'elements'],
          ['dt_ms', 'step (ms)', '.3g'],
          ['cost_factor', 'times as long', '.3g'],
        ]),
      },
    };
  },

  describe(tables) {
    const rows = choice_rows(tables);
    return `Factors in time, log scale, for ${distinct(rows.map((row) => row.replaced)).length} choices and
      ${distinct(rows.map((row) => row.scene)).length} scenes.`;
  },
};
