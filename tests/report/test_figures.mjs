// How figures look, drawn from the fixture and from the tables: `node --test tests/report/test_figures.mjs`.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { contrast, degrees, lightness, told_apart } from './colour_vision.mjs';
import { colour_scales, drawings, fixed_colours, is_themed, size_of } from './drawn.mjs';
import { fixture_directory, remove, report_root } from './support.mjs';
import { dark_theme, paper_theme } from '../../experiments/report/figures/common.mjs';
import {
  cell_fills,
  families,
  palette,
  series_style,
  shapes,
} from '../../experiments/report/figures/palette.mjs';
import { hard_cases } from '../../experiments/report/figures/hard_cases.mjs';
import { cost_of_accuracy } from '../../experiments/report/figures/cost_of_accuracy.mjs';
import { hard_cases_summary } from '../../experiments/report/figures/hard_cases_summary.mjs';

// Figures are read by everybody: colours of one figure are told apart by three quarters of all
// viewers at a glance, whatever their colour vision.
const least_difference = 1.5;
const pairs_of = (list) => list.flatMap((a, i) => list.slice(i + 1).map((b) => [a, b]));

function assert_told_apart(colours, size, where) {
  for (const [a, b] of pairs_of(colours)) {
    if (is_themed(a) && is_themed(b)) continue;
    const difference = told_apart(a, b, size);
    assert.ok(difference >= least_difference, `${where}: ${a} and ${b} differ by ${difference}`);
  }
}

test('ToldApart_FindsColoursThatOneKindOfVisionConfuses', () => {
  // Okabe and Ito's bluish green next to a grey.
  assert.ok(told_apart('#009e73', '#7a7f87') < 1);
  assert.ok(told_apart('#0072b2', '#d55e00') > 3);
  assert.ok(Math.abs(lightness('#ffffff') - 100) < 0.1 && Math.abs(lightness('#777777') - 50) < 0.5);
});

// WCAG asks 4.5 of text. Marks of data are larger and have a shape as well.
test('Colours_AreReadableOnLightAndOnDark', () => {
  for (const theme of [paper_theme, dark_theme]) {
    for (const name of ['text', 'muted'])
      assert.ok(contrast(theme[name], theme.background) >= 4.5, `${name} ${theme[name]}`);
    for (const colour of palette) assert.ok(contrast(colour, theme.background) >= 2.2, colour);
  }
  for (const { fill, text } of Object.values(cell_fills))
    assert.ok(contrast(fill, text) >= 3.6, fill);
  const style = readFileSync(join(report_root, 'src/browser/style.css'), 'utf8');
  const dark = style.slice(style.indexOf('prefers-color-scheme: dark'));
  for (const [name, of] of Object.entries({ text: 'text', muted: 'muted', grid: 'grid', axis: 'axis', bad: 'bad', background: 'card' }))
    assert.ok(dark.includes(`--${of}: ${dark_theme[name]};`), name);
});

const repository = fileURLToPath(new URL('../../', import.meta.url));
const tall = { most: 1200, readme: 700, width: 1060 };

const fixture = fixture_directory();
after(() => remove(fixture));

for (const [name, directory] of [
  ['OfTheFixture', fixture],
  ['OfTheTables', join(repository, 'results')],
]) {
  test(`Figures${name}_AreReadInTenSeconds`, async () => {
    const drawn = await drawings(directory);
    assert.ok(drawn.length > 15, `${drawn.length} figures`);
    const readme = readFileSync(join(repository, 'docs/templates/README.md'), 'utf8');
    for (const { id, spec, svg } of drawn) {
      const { width, height } = size_of(svg);
      const most = readme.includes(`${id}.svg`) ? tall.readme : tall.most;
      assert.ok(height <= most && width <= tall.width, `${id}: ${width} by ${height}`);
      const title = spec.title.text.join(' ');
      assert.ok(spec.title.text.length <= 3 && title.length > 15, `${id}: ${title}`);
      assert.doesNotMatch(title + spec.title.subtitle.join(' '), /undefined|NaN|Infinity|null/, id);
      if (name === 'OfTheTables') assert.match(title, /\d/, `${id} states no number: ${title}`);
      assert.match(svg, /<title>[^<]{15,}<\/title><desc>[^<]{40,}<\/desc>/, id);
      assert.match(svg, /@media \(prefers-color-scheme:dark\)/, id);
    }
  });

  test(`Series${name}_ShareNoColour`, async () => {
    for (const { id, spec } of await drawings(directory)) {
      const scales = colour_scales(spec);
      const entries = scales.flatMap(({ names, colours }) => names.map((of, i) => [of, colours[i]]));
      const colour_of = new Map(entries);
      for (const [of, colour] of entries)
        assert.equal(colour_of.get(of), colour, `${id}: ${of} has two colours`);
      const colours = [...colour_of.values(), ...new Set(fixed_colours(spec))];
      assert.equal(new Set([...colour_of.values()]).size, colour_of.size, `${id}: a colour twice`);
      assert.ok(new Set(colours).size <= palette.length, `${id}: ${colours.length} colours`);
      const cells = scales.length > 0 && scales.every((scale) => scale.cells);
      assert_told_apart([...new Set(colours)], cells ? degrees.cell : degrees.mark, id);
      // Colour is never the only sign of a series: it has a shape of its own as well.
      for (const { names, cells: filled } of scales) {
        if (filled || names.length < 2) continue;
        const marked = scales.find(
          (scale) => String(scale.names) === String(names) && scale.shapes.length > 1,
        );
        assert.ok(marked, `${id}: ${names} have no shapes`);
        assert.equal(new Set(marked.shapes).size, marked.shapes.length, id);
      }
    }
  });
}

test('CellFills_DifferInGrey', () => {
  const all = Object.values(cell_fills)
    .map(({ fill }) => lightness(fill))
    .concat(100)
    .sort((a, b) => a - b);
  // A difference of 1 to 2 in L* is just noticeable; 100 is the paper.
  all.slice(1).forEach((l, i) => assert.ok(l - all[i] >= 10, all.join(' ')));
  assert_told_apart(Object.values(cell_fills).map(({ fill }) => fill), degrees.cell, 'cells');
});

test('Shapes_AreOneForEachIntegrator', () => {
  assert.equal(new Set(shapes).size, shapes.length);
  const known = families.flatMap(({ members }) => members);
  assert.ok(shapes.length >= known.length, `${shapes.length} for ${known.length}`);
  // work_precision draws methods that take a step or a tolerance twice.
  const drawn = [...known, 'tr_bdf2 (tolerance)', 'esdirk43 (tolerance)'];
  assert.equal(new Set(series_style(drawn).shapes).size, drawn.length);
});

const hard_run = (more) => ({
  case: 'cone',
  model: 'der',
  variant: '',
  integrator: 'backward_euler',
  dt_s: 1e-3,
  outcome: 'stable',
  error_rel: null,
  ...more,
});

// A title is a sentence about this table: it follows the table.
test('Titles_FollowTheTable', () => {
  const run = (model, outcome, error_rel) => hard_run({ model, outcome, error_rel, dt_s: 1 / 30 });
  const runs = [run('der', 'stable and accurate', 0.01), run('corde', 'stable', 0.2), run('xpbd', 'unstable')];
  const title = (list) => hard_cases_summary.headline({ hard_cases: list });
  assert.equal(
    title(runs),
    'backward_euler at 33.3 ms is stable in 67 % of 3 stress tests and accurate in 33 %',
  );
  assert.match(title([...runs, run('swing', 'unstable')]), /50 % of 4 stress tests and accurate in 25 %/);
  const cost = (kind, wall_s_per_sim_s, more) => ({
    scene: 'whip', kind, model: 'der', integrator: 'bdf2', elements: 5, status: 'ok', error_rel: 0.01, wall_s_per_sim_s, ...more,
  });
  const costs = (wall) => [cost('winner', 1e-3, { target_error_rel: 0.01 }), cost('as_given', wall)];
  assert.match(
    cost_of_accuracy.headline({ cost_of_accuracy: costs(0.02) }),
    /^A tip error of 1 % costs 1 ms to 1 ms .*take 20 to 20 times as long$/,
  );
  assert.match(cost_of_accuracy.headline({ cost_of_accuracy: costs(0.05) }), /50 times as long$/);
});
