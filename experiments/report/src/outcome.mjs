// What the manifest of a scene says about its run, as sentences.
import { format_number } from './format.mjs';

const is_number = (value) => Number.isFinite(value);

function error_text(outcome, part) {
  const of = (name) => outcome[`${part}_${name}`];
  if (typeof of('error_missing') === 'string')
    return [`No error in ${part}: ${of('error_missing')}.`];
  if (!is_number(of('error_max_rel'))) return [];
  const median = is_number(of('error_median_rel'))
    ? `, median of the strands ${format_number(of('error_median_rel'))}`
    : '';
  const horizon = is_number(of('horizon_s'))
    ? `, until ${format_number(of('horizon_s'))} s, from where the run and a finer one are different motions`
    : '';
  return [
    `Estimated error in ${part}, over the length: at most ${format_number(of('error_max_rel'))}, ` +
      `root mean square ${format_number(of('error_rms_rel'))}${median}${horizon}.`,
  ];
}

function steps_text({ steps, rejected_steps, smallest_step_s, smallest_step_at_s }) {
  if (!is_number(steps) || !is_number(rejected_steps)) return [];
  const shortest = is_number(smallest_step_s)
    ? `, the shortest ${format_number(smallest_step_s * 1e3)} ms at ${format_number(smallest_step_at_s)} s`
    : '';
  return [`${steps} steps, ${rejected_steps} rejected${shortest}.`];
}

// '' where the manifest is older than these.
export const outcome_text = (outcome = {}) =>
  [
    ...steps_text(outcome),
    ...error_text(outcome, 'time'),
    ...error_text(outcome, 'space'),
  ].join(' ');
