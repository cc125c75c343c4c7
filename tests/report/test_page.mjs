// The page in headless Chromium: `node --test tests/report/test_page.mjs`. CHROMEDRIVER
// and CHROMIUM name the programs when they are not on the path.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { parse_csv } from '../../experiments/report/src/csv.mjs';
import { Browser } from '../../experiments/report/src/chromium.mjs';
import { fixture_directory, remove, run_page } from './support.mjs';

// What each tab draws; addresses that name a section open its tab.
const opening = {
  validation: ['validation', 'validation_tests', 'validation_orders'],
  hard_cases: ['hard_cases_summary', 'hard_cases'],
  cost_of_accuracy: ['cost_of_accuracy', 'cost_choices', 'cost_by_model'],
};
const figures = [
  'family',
  'drift_cost',
  'drift_heatmap',
  'drift_recovery',
  'work_precision',
  'tolerance',
  'bdf_order',
  'stability_limit',
  'nodal_steps',
  'scaling',
  'swing',
  'force_transport',
  'block_descent',
  'cosserat_map',
  'newest_methods',
];
let directory, browser, page;

before(async () => {
  directory = fixture_directory();
  assert.equal(run_page(directory).status, 0);
  page = `file://${join(directory, 'report.html')}`;
  browser = await Browser.start();
});

after(async () => {
  await browser?.stop();
  remove(directory);
});

// Opacities of the drawn points of a figure, by their opacity attribute or style.
const point_opacities = (figure) =>
  browser.run(`
  return [...document.querySelectorAll('#plot-${figure} path[aria-roledescription="point"]')]
    .map((p) => Number(p.getAttribute('opacity') ?? 1));`);

// Clicks the legend entry with this text in a figure.
async function click_legend(figure, text) {
  const at = await browser.run(
    `
    const label = [...document.querySelectorAll('#plot-${figure} .role-legend-label text')]
      .find((t) => t.textContent === arguments[0]);
    label.scrollIntoView({ block: 'center', behavior: 'instant' });
    const box = label.getBoundingClientRect();
    return [box.x + box.width / 2, box.y + box.height / 2];`,
    text,
  );
  await browser.click_at(...at);
}

const settle = async (ready) => {
  for (let attempt = 0; attempt < 500; ++attempt) {
    if (await ready()) return true;
    await pause(20);
  }
  return false;
};

// Drawing the figures takes seconds: tests that only read share a page, and those that
// change a figure name it.
const shown = { width: undefined, changed: new Set() };
async function open_page(width = 1400) {
  await browser.open(page, width);
  shown.width = undefined;
}

// The tab of the measurements, all of its figures drawn.
async function open_measurements({ width = 1400, changes } = {}) {
  if (shown.width !== width || shown.changed.has(changes)) {
    await open_page(width);
    await draw_measurements();
    shown.width = width;
    shown.changed.clear();
  }
  if (changes) shown.changed.add(changes);
}

async function draw_measurements() {
  await browser.click('#tab-measured');
  assert.ok(
    await settle(() =>
      browser.run(`return [...document.querySelectorAll('#panel-measured [data-figure]')]
        .every((place) => place.querySelector('svg'))`),
    ),
  );
}

const marks_in = (figure) =>
  browser.run(
    `return document.querySelectorAll('#plot-${figure} svg .mark-symbol path, ` +
      `#plot-${figure} svg .mark-rect path').length`,
  );
const least_marks = {
  validation: 8, validation_tests: 7, validation_orders: 7, cost_choices: 6, cost_of_accuracy: 6,
}; // prettier-ignore

test('Page_OpensWithTheThreeQuestions', async () => {
  await open_page();
  assert.deepEqual(
    await browser.run(
      `return [...document.querySelectorAll('[role="tab"]')].map((tab) => tab.textContent)`,
    ),
    ['Is it right?', 'What survives?', 'What does accuracy cost?', 'Measurements', 'Scenes'],
  );
  assert.equal(await browser.run("return document.querySelector('h1').textContent"),
    'Is the physics right?');
  assert.ok((await marks_in('validation')) >= 8);
  await browser.click('#tab-hard');
  assert.ok(await settle(async () => (await marks_in('hard_cases')) > 10));
  assert.equal(
    await browser.run("return document.getElementById('panel-validation').hidden"),
    true,
  );
});

test('Questions_SayWhatTestsAndCasesAre', async () => {
  await open_page();
  const text = (id) =>
    browser.run(`return document.getElementById('${id}').nextElementSibling.textContent`);
  assert.match(await text('validation-about'), /bent by its weight.*the <elastica>/);
  assert.match(await text('hard-about'), /antipodal tangents/);
});

test('Page_DrawsEveryFigureWithoutErrorsOrRequests', async () => {
  await open_page();
  for (const [address, drawn] of [...Object.entries(opening), ['drift_cost', figures]]) {
    await browser.run(`location.hash = '#${address}'`);
    for (const figure of drawn) {
      const least = least_marks[figure] ?? 11;
      assert.ok(
        await settle(async () => (await marks_in(figure)) >= least),
        `${figure}: ${await marks_in(figure)} marks`,
      );
    }
  }
  assert.deepEqual(
    (await browser.log('browser')).map((entry) => entry.message),
    [],
  );
  assert.deepEqual(
    [...new Set((await browser.requests()).map((address) => address.split('#')[0]))],
    [page],
  );
});

// axe-core is a package for those who change the page (npm ci in experiments/report).
const axe = new URL(
  '../../experiments/report/node_modules/axe-core/axe.min.js',
  import.meta.url,
);
test(
  'Accessibility_HasNoComplaintsInAnyTab',
  { skip: !existsSync(axe) && 'axe-core is not there: npm ci in experiments/report' },
  async () => {
    // As the test before left it, when that ran: every figure is drawn.
    const ready = 'return document.documentElement.dataset.ready';
    if ((await browser.run(ready)) !== 'yes') await open_page();
    await browser.devtools('Runtime.evaluate', { expression: readFileSync(axe, 'utf8') });
    for (const tab of ['validation', 'hard', 'cost', 'measured', 'scenes']) {
      await browser.run(`location.hash = '#tab-${tab}'`);
      assert.ok(
        await settle(() =>
          browser.run(`return [...document.querySelectorAll(
            '#panel-${tab} [data-figure]')].every((place) => place.querySelector('svg'))`),
        ),
      );
      // What is inside a picture is hidden from readers; without it axe takes a tenth.
      const complaints = await browser.run(`
        document.querySelectorAll('svg > [aria-hidden="true"]').forEach((part) => part.remove());
        return axe.run(document, { resultTypes: ['violations'] })
          .then(({ violations }) => violations.map(({ id, nodes }) =>
            id + ': ' + nodes.slice(0, 3).map(({ html }) => html.slice(0, 160)).join(' ')))`);
      assert.deepEqual(complaints, [], tab);
    }
  },
);

test('Policy_StopsTheNetworkAndEvaluation', async () => {
  await open_measurements();
  assert.equal(
    await browser.run(`
    return fetch('https://example.org/').then(() => 'loaded', () => 'refused')`),
    'refused',
  );
  assert.equal(
    await browser.run(`
    const s = document.createElement('script');
    s.textContent = 'window.injected = 1';
    document.body.append(s);
    return window.injected === undefined ? 'refused' : 'ran'`),
    'refused',
  );
  await browser.log('browser');
});

for (const [figure, entry] of [
  ['work_precision', 'explicit, fixed step'],
  ['drift_cost', 'projection'],
  ['drift_cost', 'explicit, fixed step'],
  ['drift_recovery', 'velocity_verlet'],
  ['bdf_order', 'cvode_bdf <= 2'],
  ['stability_limit', 'measured limit'],
  ['swing', 'implicit, fixed step'],
  ['force_transport', 'corde'],
  ['block_descent', 'vbd, whole'],
  ['newest_methods', 'tress'],
]) {
  test(`LegendClick_DimsTheOthers_${figure}_${entry}`, async () => {
    await open_measurements({ changes: figure });
    const dimmed = async () =>
      (await point_opacities(figure)).filter((o) => o < 0.2).length;
    assert.equal(await dimmed(), 0);
    await click_legend(figure, entry);
    assert.ok(await settle(async () => (await dimmed()) > 0), 'nothing was dimmed');
    const all = await point_opacities(figure);
    assert.ok(
      all.some((o) => o > 0.5),
      'nothing was kept',
    );
    // Panels share the selection: kept points lie in as many panels as hold the entry.
    assert.deepEqual(
      (await browser.log('browser')).map((e) => e.message),
      [],
    );
  });
}

const column = (name) =>
  browser.run(
    `
  const table = document.querySelector('[data-table="family"] table');
  const k = [...table.tHead.rows[0].cells].findIndex((c) => c.textContent === arguments[0]);
  return [...table.tBodies[0].rows].map((row) => row.cells[k].textContent);`,
    name,
  );

test('Table_SortsFiltersAndShowsFailures', async () => {
  await open_measurements();
  await browser.run(`document.querySelector('[data-table="family"]').open = true`);
  // By a number, whose column stands where the table has it.
  const place = await browser.run(`
    const heads = [...document.querySelectorAll('[data-table="family"] thead th')];
    return 1 + heads.findIndex((head) => head.textContent.includes('length_m'));`);
  const header = `[data-table="family"] thead th:nth-child(${place}) button`;
  assert.ok(
    await settle(() => browser.run(`return !!document.querySelector('${header}')`)),
  );
  await browser.run(
    `document.querySelector('${header}').scrollIntoView({ block: 'center', behavior: 'instant' })`,
  );
  const name = await browser.run(
    `return document.querySelector('${header}').textContent`,
  );
  await browser.click(header);
  const up = (await column(name)).map(Number);
  assert.deepEqual(
    up,
    [...up].sort((a, b) => a - b),
  );
  await browser.click(header);
  const down = (await column(name)).map(Number);
  assert.deepEqual(down, [...up].reverse());
  assert.notDeepEqual(up, down);
  assert.equal(
    await browser.run(`
    return document.querySelector('${header}').parentNode.getAttribute('aria-sort')`),
    'descending',
  );
  const failed = await browser.run(`
    return [...document.querySelectorAll('[data-table="family"] tr.failed')]
      .map((row) => row.textContent)`);
  assert.equal(failed.length, 2);
  assert.match(failed[0], /not_met/);
  await browser.run(`
    const box = document.querySelector('[data-table="family"] input');
    box.value = 'reduced_cheaper';
    box.dispatchEvent(new Event('input'));`);
  assert.equal((await column(name)).length, 8);
});

test('UnknownTable_IsShownAsText', async () => {
  await open_measurements();
  await browser.run(
    `document.querySelector('[data-table="benchmark_extra"]').open = true`,
  );
  assert.ok(
    await settle(() =>
      browser.run(`
    return document.querySelector('[data-table="benchmark_extra"] tbody')
      ?.textContent.includes('chain <n>') ?? false`),
    ),
  );
});

test('CompositeAndRecursive_HaveTheSameSteps', async () => {
  await open_measurements();
  const [composite, recursive] = await browser.run(`
    const steps = (method) =>
      [...document.querySelectorAll('#plot-stability_limit path[aria-roledescription="point"]')]
        .filter((p) => p.getAttribute('aria-label').split('; ').includes('method: ' + method))
        .map((p) => p.getAttribute('transform').split(',')[0])
        .sort();
    return ['composite', 'recursive'].map(steps);`);
  assert.ok(composite.length > 80, `${composite.length} marks`);
  assert.deepEqual(composite, recursive);
});

test('Figures_HaveDescriptions', async () => {
  await open_measurements();
  for (const figure of figures) {
    const label = await browser.run(`
      const svg = document.querySelector('#plot-${figure} svg[role="img"]');
      return svg.getAttribute('aria-label')`);
    assert.ok(label.length > 40, `${figure}: ${label}`);
  }
});

// Boxes of the texts of a figure that are hidden by none and overlap another.
const overlapping_texts = (figure) =>
  browser.run(`
  const boxes = [...document.querySelectorAll('#plot-${figure} svg text')]
    .filter((t) => t.textContent !== '' && Number(t.getAttribute('opacity') ?? 1) > 0)
    .map((t) => [t.textContent, t.getBoundingClientRect()])
    .filter(([, box]) => box.width > 0);
  const apart = (a, b) =>
    a.right <= b.left + 1 || b.right <= a.left + 1 ||
    a.bottom <= b.top + 3 || b.bottom <= a.top + 3;
  // The outlined copy of a text lies under the text itself.
  return boxes.flatMap(([text, box], i) => boxes.slice(i + 1)
    .filter(([other, at]) => other !== text && !apart(box, at))
    .map(([other]) => text + ' / ' + other));`);

// Widths one after the other, that each is drawn once.
const page_widths = [1400, 768, 390];
const label_widths = [390, 1240];
for (const width of [1400, 1240, 768, 390]) {
  if (page_widths.includes(width))
    test(`Page_HasNoHorizontalScroll_${width}`, async () => {
      await open_measurements({ width });
      await browser.run(
        `for (const d of document.querySelectorAll('details')) d.open = true`,
      );
      const [content, view] = await browser.run(
        'return [document.documentElement.scrollWidth, window.innerWidth]',
      );
      assert.equal(view, width);
      assert.ok(content <= width, `${content} px wide`);
      // Nor may a figure hide anything behind its own scroll bar.
      const cut = await browser.run(`return [...document.querySelectorAll('.plot')]
        .filter((p) => p.scrollWidth > p.clientWidth + 1).map((p) => p.id)`);
      assert.deepEqual(cut, []);
    });
  if (label_widths.includes(width))
    test(`StrandFigures_KeepTheirLabelsApart_${width}`, async () => {
      await open_measurements({ width });
      for (const figure of ['stability_limit', 'scaling', 'swing', 'work_precision']) {
        assert.deepEqual(await overlapping_texts(figure), [], figure);
      }
    });
}

test('Table_IsSavedAsTheCsvItCameFrom', async () => {
  await open_measurements({ width: 390 }); // as the tests before left it
  await browser.run(`document.querySelector('[data-table="family"]').open = true`);
  const button = '[data-table="family"] .table-tools button';
  assert.ok(await settle(() => browser.run(`return !!document.querySelector('${button}')`)));
  const [name, text] = await browser.run(`
    const saved = new Promise((done) => {
      URL.createObjectURL = (blob) => (blob.text().then((text) => done(text)), 'about:blank');
    });
    let name;
    HTMLAnchorElement.prototype.click = function () { name = this.download; };
    document.querySelector('${button}').click();
    return saved.then((text) => [name, text]);`);
  shown.width = undefined; // the page is not what it was
  assert.equal(name, 'family.csv');
  const file = join(directory, 'family.csv');
  assert.deepEqual(
    parse_csv(text, 'saved'),
    parse_csv(readFileSync(file, 'utf8'), 'written'),
  );
});

const keys = { right: '\uE014', left: '\uE012', end: '\uE010', home: '\uE011' };
const selected_tab = () =>
  browser.run(`return document.querySelector('[role="tab"][aria-selected="true"]').id`);

test('Tabs_HaveAddressesThatBackReturnsTo', async () => {
  await open_page();
  await browser.click('#tab-hard');
  assert.equal(await browser.run('return location.hash'), '#tab-hard');
  await browser.click('#tab-cost');
  await browser.run('history.back()');
  assert.ok(await settle(async () => (await selected_tab()) === 'tab-hard'));
  await browser.run('history.back()');
  assert.ok(await settle(async () => (await selected_tab()) === 'tab-validation'));
  await browser.open(`${page}#tab-scenes`);
  assert.equal(await selected_tab(), 'tab-scenes');
});

test('TabKeys_LeadToTheEnds', async () => {
  await open_page();
  await browser.run("document.getElementById('tab-validation').focus()");
  for (const [key, tab] of [
    [keys.end, 'tab-scenes'],
    [keys.right, 'tab-validation'],
    [keys.left, 'tab-scenes'],
    [keys.home, 'tab-validation'],
    [keys.right, 'tab-hard'],
  ]) {
    await browser.press(key);
    assert.equal(await selected_tab(), tab);
    assert.equal(await browser.run('return document.activeElement.id'), tab);
  }
});

test('EveryTab_HasOneHeadingInMain', async () => {
  assert.deepEqual(
    await browser.run(`return [...document.querySelectorAll('[role="tabpanel"]')]
      .map((panel) => panel.querySelectorAll('h1').length)`),
    [1, 1, 1, 1, 1],
  );
  assert.equal(await browser.run("return document.querySelectorAll('main').length"), 1);
});

