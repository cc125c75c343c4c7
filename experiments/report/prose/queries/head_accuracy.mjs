// Which share of a head must be simulated.
import { distinct, succeeded } from '../../src/tables.mjs';
import { spaced } from '../../src/strand.mjs';
import { must, number, percent, range, rows_of, table } from '../markdown.mjs';

const all = (tables) => rows_of(tables, 'head_accuracy');
const answers = (tables) => all(tables).filter((row) => row.kind === 'cheapest');
const met = (tables) => answers(tables).filter(succeeded);
const every = (row) => row.guides === row.strands;
const share = (row) => row.guides / row.strands;
const head = 'full_head';

const words = (row) =>
  `${every(row) ? `each of ${row.strands} hairs` : `${row.guides} guides for ${row.strands} hairs`}, ` +
  `${row.elements} elements, steps of ${number(1e3 * row.dt_s)} ms, ${row.bits}-bit precision`;

/// Of the shipped head, for the smallest target error.
export const answer = (tables) => {
  const row = met(tables)
    .filter(({ scene }) => scene === head)
    .sort((a, b) => a.target_error_rel - b.target_error_rel)[0];
  must(row !== undefined, 'the shipped head has an answer');
  return (
    `> ${spaced(row.scene)}, ${percent(row.target_error_rel)}: take ${words(row)}: of ${row.looked_at} sampled hairs, 95 % are within ` +
    `${percent(row.error_p95_rel)} of their length (mean ${percent(row.error_mean_rel)}, largest ` +
    `${percent(row.error_max_rel)}) in ${number(row.ms_per_frame)} ms a frame` +
    (every(row) && row.best_guides
      ? `; hairs that follow ${row.best_guides} guides are off by ${percent(row.best_interpolation_rel)}.`
      : '.')
  );
};

export const over = (tables) =>
  ({
    p95: 'The target is the error that 95 % of the sampled hairs do not exceed.',
    mean: 'The target is the mean over the sampled hairs.',
    largest: 'The target is the largest error of the sampled hairs.',
  })[answers(tables)[0].over];

export const answers_table = (tables) =>
  table(
    [
      'groom',
      'target',
      'sampled hairs',
      'simulated',
      'elements, step, bits',
      'error: mean, 95 %, largest',
      'of interpolation',
      'of elements and step',
      'ms a frame: simulated, following',
    ],
    answers(tables).map((row) =>
      succeeded(row)
        ? [
            spaced(row.scene),
            percent(row.target_error_rel),
            row.looked_at,
            every(row) ? `all ${row.strands}` : `${row.guides} of ${row.strands}`,
            `${row.elements}, ${number(1e3 * row.dt_s)} ms, ${row.bits}`,
            ['mean', 'p95', 'max'].map((of) => percent(row[`error_${of}_rel`])).join(', '),
            every(row)
              ? `none; following ${row.best_guides}: ${percent(row.best_interpolation_rel)}`
              : percent(row.interpolation_p95_rel),
            percent(row.simulated_p95_rel),
            `${number(row.step_ms_per_frame)}, ${number(row.follow_ms_per_frame)}`,
          ]
        : [spaced(row.scene), percent(row.target_error_rel), row.looked_at, row.reason, '', '', '', '', ''],
    ),
  );

/// What variation between hairs decides.
export const findings = (tables) => {
  const of = (kind) => met(tables).filter((row) => row.scene.includes(kind));
  const alike = of('alike').filter((row) => !every(row));
  const varied = of('varied');
  must(alike.length > 0 && alike.length > of('alike').length / 2, 'most grooms of equal hairs need few guides');
  must(varied.length > 0 && varied.every(every), 'varied hairs must all be simulated');
  return (
    `In ${alike.length} of ${of('alike').length} answers for grooms of equal hairs, ${range(alike.map(share), percent)} of the hairs ` +
    `are enough as guides. Hairs that differ in length, curl and phase must all be simulated ` +
    `(${varied.length} of ${varied.length} answers): hairs that follow the best guides are off by ` +
    `${range(varied.map((row) => row.best_interpolation_rel), percent)}. Grooms: ` +
    `${distinct(answers(tables).map((row) => spaced(row.scene))).join(', ')}.`
  );
};
