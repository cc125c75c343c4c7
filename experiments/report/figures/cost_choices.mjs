// How much longer a run takes when one choice of the cheapest run is replaced.
import { distinct, is_number } from '../src/tables.mjs';
import { format_ratio } from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
import { choice_medians, choice_name, cost_rows, of_kind } from '../src/findings/cost.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  log_channel,
  log_extent,
  series_channels,
  tooltips,
} from './common.mjs';
import { name_style } from './palette.mjs';
import { row_channel, row_text, row_width } from './rows.mjs';

const choice_rows = (tables) =>
  of_kind(cost_rows(tables), 'without')
    .filter((row) => is_number(row.cost_factor))
    .map((row) => ({
      ...row,
      replaced: choice_name(row.choice),
      situation: spaced(row.scene),
    }));

function headline(tables) {
  const medians = choice_medians(cost_rows(tables));
  const text = ({ choice, factor }) => `the ${choice_name(choice)} (${format_ratio(factor)})`;
  const [most, rest] = [medians.slice(0, 3), medians.slice(3)];
  return (
    `The choices that matter most: ${most.map(text).join(', ')}` +
    (rest.length > 0 ? `; least: ${text(rest.at(-1))}` : '')
  );
}

export const cost_choices = {
  id: 'cost_choices',
  title: 'Effect of each choice',
  table: 'cost_of_accuracy',
  headline,
  reading: `Time after one choice of the cheapest run is replaced by its best alternative, over the time of the cheapest
    run. A mark for each scene and target error; the bar and the number are the median.`,
  caption: `The alternative still meets the target error. Choices: the model, the integrator, the linear solver or
    Jacobian, the modes, twice the elements, half the step. Made from cost_of_accuracy.csv.`,

  rows: choice_rows,

  spec(tables, { width, theme }) {
    const rows = choice_rows(tables);
    const style = name_style(rows.map((row) => row.situation));
    const { legend } = layout(width, 1, { labels: style.domain, above: true });
    const medians = choice_medians(cost_rows(tables)).map(({ choice, factor: cost_factor }) => ({
      replaced: choice_name(choice),
      cost_factor,
      text: format_ratio(cost_factor),
    }));
    const names = medians.map(({ replaced }) => replaced);
    const x = log_channel(
      'cost_factor',
      'time / time of the cheapest run',
      log_extent([...rows.map((row) => row.cost_factor), 1]),
    );
    const y = row_channel('replaced', names);
    return {
      width: row_width(width, names, 80),
      height: { step: 28 },
      layer: [
        {
          data: { values: rows },
          params: [legend_selection('pick_scene', 'situation')],
          mark: { type: 'point', filled: true, size: 55 },
          encoding: {
            x,
            y,
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
              ['steps', 'step'],
              ['cost_factor', 'time / time of the cheapest run', '.3g'],
            ]),
          },
        },
        {
          data: { values: [{ cost_factor: 1 }] },
          mark: { type: 'rule', color: theme.axis },
          encoding: { x },
        },
        {
          data: { values: medians },
          mark: { type: 'tick', thickness: 3, size: 22, color: theme.text },
          encoding: { x, y },
        },
        row_text(medians, y, 'text', { baseline: 'middle' }),
      ],
    };
  },

  describe(tables) {
    const rows = choice_rows(tables);
    return `Factors in time, log scale, for ${distinct(rows.map((row) => row.replaced)).length} choices and
      ${distinct(rows.map((row) => row.scene)).length} scenes.`;
  },
};
