// The cheapest run for each target error, scene by scene, and the scene files as shipped.
import { distinct, is_positive } from '../src/tables.mjs';
import { format_number, format_time } from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
import { cost_rows, of_kind, percent, run_text, wanted_of } from '../src/findings/cost.mjs';
import { log_extent, tooltips } from './common.mjs';
import { blue, green, orange, purple, sky } from './palette.mjs';
import { row_channel, row_width, time_channel } from './rows.mjs';

const shipped = 'file as shipped';

const drawn_rows = (tables) =>
  cost_rows(tables)
    .filter(
      ({ kind, target_error_rel }) =>
        kind === 'as_given' || (kind === 'winner' && is_positive(target_error_rel)),
    )
    .map((row) => ({
      ...row,
      situation: spaced(row.scene),
      series: row.kind === 'as_given' ? shipped : percent(row.target_error_rel),
    }));

// Winners at the target error of the title, and the time of the file as shipped over theirs.
function at_wanted(rows) {
  const winners = of_kind(rows, 'winner');
  const wanted = wanted_of(distinct(winners.map((row) => row.target_error_rel)));
  const at = winners.filter((row) => row.target_error_rel === wanted);
  const gains = of_kind(rows, 'as_given').flatMap((row) => {
    const winner = at.find(({ scene }) => scene === row.scene);
    return winner ? [row.wall_ms / winner.wall_ms] : [];
  });
  return { wanted, at: [...at].sort((a, b) => a.wall_ms - b.wall_ms), gains };
}

const factor = (value) => format_number(value, value >= 10 ? 2 : 1);

function headline(tables) {
  const { wanted, at, gains } = at_wanted(drawn_rows(tables));
  const times =
    gains.length > 0
      ? `; the files as shipped take ${factor(Math.min(...gains))} to ${factor(Math.max(...gains))} times as long`
      : '';
  const [first, last] = [at[0], at.at(-1)].map((row) => format_time(row.wall_s_per_sim_s));
  return `A tip error of ${percent(wanted)} costs ${first} to ${last} per simulated second on ${at.length} scenes${times}`;
}

export const cost_of_accuracy = {
  id: 'cost_of_accuracy',
  title: 'Error and time, scene by scene',
  table: 'cost_of_accuracy',
  headline,
  reading: `The cheapest run for each target error. Below a scene: the run for the error in the title. Next to a cross: the
    error of the scene file as shipped.`,
  caption: `Wall time of one thread. Errors are of the tip, against the continuous rod, over the length of the strand. Made
    from cost_of_accuracy.csv.`,

  rows: drawn_rows,

  spec(tables, { width, theme }) {
    const rows = drawn_rows(tables);
    const { wanted, at } = at_wanted(rows);
    const targets = distinct(of_kind(rows, 'winner').map((row) => row.target_error_rel)).sort(
      (a, b) => b - a,
    );
    const names = [...targets.map(percent), shipped].filter((name) =>
      rows.some((row) => row.series === name),
    );
    const range = (values) => ({
      domain: names,
      range: names.map((name, i) => (name === shipped ? values.at(-1) : values[i])),
    });
    const legend = { orient: 'top', direction: 'horizontal', columns: width < 600 ? 1 : 4 };
    const series = { field: 'series', type: 'nominal', title: 'target error', legend };
    const x = time_channel(
      'wall_ms',
      'wall time per simulated second',
      log_extent(rows.map((row) => row.wall_ms)),
    );
    const scenes = at.map((row) => spaced(row.scene));
    const y = row_channel('situation', scenes, { grid: false });
    const given = of_kind(rows, 'as_given');
    const runs = of_kind(rows, 'winner')
      .filter((row) => row.target_error_rel === wanted)
      .map((row) => ({ ...row, text: run_text(row) }));
    // The text of a run on the right half of the plot ends at its mark.
    const [low, high] = x.scale.domain.map(Math.log);
    const on_right = (row) => Math.log(row.wall_ms) > (low + high) / 2;
    const run_texts = (values, align, dx) => ({
      data: { values },
      mark: { type: 'text', align, dy: 17, dx, fontSize: 11, color: theme.muted },
      encoding: { x, y, text: { field: 'text' } },
    });
    return {
      width: row_width(width, scenes, 58),
      height: { step: 46 },
      layer: [
        {
          data: { values: of_kind(rows, 'winner') },
          mark: { type: 'line', strokeWidth: 2, color: theme.axis },
          encoding: { x, y, detail: { field: 'situation' } },
        },
        {
          data: { values: rows.filter((row) => scenes.includes(row.situation)) },
          mark: { type: 'point', filled: true, size: 120, opacity: 1 },
          encoding: {
            x,
            y,
            color: { ...series, scale: range([sky, blue, purple, green, orange]) },
            shape: { ...series, scale: range(['circle', 'square', 'diamond', 'triangle-up', 'cross']) },
            tooltip: tooltips([
              ['situation', 'scene'],
              ['series', 'target error'],
              ['name', 'model'],
              ['method', 'integrator'],
              ['how', 'options'],
              ['elements', 'elements'],
              ['steps', 'step'],
              ['error_pct', 'error (%)', '.3g'],
              ['wall_ms', 'time per simulated second (ms)', '.3g'],
              ['margin', 'margin', '.3g'],
            ]),
          },
        },
        run_texts(runs.filter((row) => !on_right(row)), 'left', -5),
        run_texts(runs.filter(on_right), 'right', 5),
        {
          data: { values: given.map((row) => ({ ...row, text: `${format_number(100 * row.error_rel, 2)} %` })) },
          mark: { type: 'text', align: 'left', dx: 10, fontSize: 11, color: theme.text },
          encoding: { x, y, text: { field: 'text' } },
        },
      ],
    };
  },

  describe(tables) {
    const rows = drawn_rows(tables);
    return `Time per simulated second, log scale, of the cheapest run for each target error on
      ${distinct(rows.map((row) => row.scene)).length} scenes, and of the scene file as shipped.`;
  },
};
