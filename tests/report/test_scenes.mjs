// The scenes tab in headless Chromium: `node --test tests/report/test_scenes.mjs`.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';
import { after, before, test } from 'node:test';
import { Browser } from '../../experiments/report/src/chromium.mjs';
import { fixture_directory, remove, report_root, run_page } from './support.mjs';

let directory, browser, url;

before(async () => {
  directory = fixture_directory();
  assert.equal(run_page(directory).status, 0);
  url = `file://${join(directory, 'report.html')}`;
  browser = await Browser.start();
});

after(async () => {
  await browser?.stop();
  remove(directory);
});

// No larger a window than the controls need: a processor draws it.
const open = (hash = '', width = 900, height = 1000) =>
  browser.open(url + hash, width, height);

const keys = { right: '\uE014', left: '\uE012', end: '\uE010', home: '\uE011', escape: '\uE00C' };
const frame = async () =>
  Number(
    await browser.run("return document.getElementById('scene-canvas').dataset.frame"),
  );
const address = () => browser.run('return location.hash');
const text_of = (selector) =>
  browser.run('return document.querySelector(arguments[0]).textContent', selector);
// The picture after the next frame was drawn.
const picture = () =>
  browser.run(`return new Promise((done) =>
    requestAnimationFrame(() => requestAnimationFrame(() =>
      done(document.getElementById('scene-canvas').toDataURL()))))`);
const choose = (id, value) =>
  browser.run(
    `const place = document.getElementById('scene-' + arguments[0]);
    place.value = arguments[1];
    place.dispatchEvent(new Event(place.tagName === 'SELECT' ? 'change' : 'input'));`,
    id,
    String(value),
  );
// Whether a condition comes true within 10 s; the pictures are not timed.
async function comes(condition) {
  for (let attempt = 0; attempt < 500; ++attempt) {
    if (await condition()) return true;
    await pause(20);
  }
  return false;
}
// Chromium notes that a picture of WebGL is slow to read where a processor draws it.
const no_errors = async () =>
  assert.deepEqual(
    (await browser.log('browser'))
      .map((entry) => entry.message)
      .filter((message) => !/GL Driver Message \(OpenGL, Performance/.test(message)),
    [],
  );

test('Tab_OpensASceneThatPlaysPausesAndScrubs', async () => {
  await open();
  assert.equal(
    await browser.run("return document.getElementById('panel-scenes').hidden"),
    true,
  );
  await browser.requests();
  await browser.click('#tab-scenes');
  await choose('name', 'fixture_head');
  assert.equal(await frame(), 0);
  const first = await picture();

  await choose('speed', 0.1); // so that the end is far when the next click comes
  await browser.click('#scene-play');
  assert.ok(await comes(async () => (await frame()) > 2), 'time does not run');
  await browser.click('#scene-play');
  assert.equal(await text_of('#scene-play'), 'Play');
  const stopped = await frame();
  assert.notEqual(await picture(), first);
  await pause(300);
  assert.equal(await frame(), stopped);

  await choose('scrub', 31);
  assert.equal(await frame(), 31);
  assert.match(await text_of('#scene-time'), /0\.775 s, frame 31 of 39/);
  const scrubbed = await picture();
  await choose('scrub', 0);
  assert.equal(await picture(), first);
  assert.notEqual(scrubbed, first);

  await choose('name', 'fixture_wind');
  assert.match(await text_of('#scene-title'), /strand <in> the wind/);
  assert.match(await text_of('#scene-caption'), /^1 strand, der, ida, adaptive steps/);
  assert.notEqual(await picture(), first);
  await no_errors();
  assert.deepEqual(await browser.requests(), []);
});

test('Playing_EndsAtTheLastFrameAndStartsAgain', async () => {
  await open('#scene=fixture_wind&frame=26');
  await choose('speed', 2);
  await browser.click('#scene-play');
  assert.ok(await comes(async () => (await text_of('#scene-play')) === 'Play'));
  assert.equal(await frame(), 29);
  await choose('speed', 0.1);
  await browser.click('#scene-play');
  assert.ok((await frame()) < 29);
  await browser.click('#scene-play');
});

test('Keyboard_StepsAndPlays', async () => {
  await open('#scene=fixture_head&frame=5');
  await choose('speed', 0.1); // so that the end is far when the next key comes
  await browser.run("document.getElementById('scene-canvas').focus()");
  for (const [key, wanted] of [
    [keys.right, 6],
    [keys.left, 5],
    [keys.end, 39],
    [keys.right, 39],
    [keys.home, 0],
    [keys.left, 0],
  ]) {
    await browser.press(key);
    assert.equal(await frame(), wanted);
  }
  await browser.press(' ');
  assert.ok(await comes(async () => (await frame()) > 0));
  await browser.press(' ');
  assert.equal(await text_of('#scene-play'), 'Play');
  // With the focus on the button itself a space must not count twice.
  await browser.press(keys.home);
  await browser.run("document.getElementById('scene-play').focus()");
  await browser.press(' ');
  assert.equal(await text_of('#scene-play'), 'Pause');
  await browser.press(' ');
  await browser.press(keys.home);
  await browser.press(keys.right);
  assert.equal(await frame(), 1);
});

test('Drag_TurnsAndTheAddressBringsTheSamePictureBack', async () => {
  await open('#scene=fixture_head&frame=10');
  const before_drag = await picture();
  const [x, y] = await browser.run(`
    const box = document.getElementById('scene-canvas').getBoundingClientRect();
    return [box.x + box.width / 2, box.y + box.height / 2];`);
  await browser.drag([x, y], [x + 80, y + 40]);
  const turned = await picture();
  assert.notEqual(turned, before_drag);
  await choose('colour', '1');
  await choose('strands', 'guides');
  const shown = await picture();
  assert.notEqual(shown, turned);
  const link = await address();
  assert.match(link, /scene=fixture_head&frame=10&view=[\d.,-]+&colour=load\+of\+gravity&strands=guides/);
  await open(link);
  assert.equal(await picture(), shown);
  assert.equal(await address(), link);
  await browser.click('[data-view="top"]');
  assert.notEqual(await picture(), shown);
  await no_errors();
});

test('ColourBar_HasNameUnitAndRange', async () => {
  await open('#scene=fixture_head');
  const bar = () => browser.run("return document.getElementById('scene-bar').innerText");
  assert.match(await bar(), /curvature \(1\/m\)\s+0\s+62\.5/);
  await choose('colour', '1');
  assert.match(await bar(), /load of gravity \(N\/m\)\s+0\s+6\.4e-5/);
  await choose('colour', 'strand');
  assert.equal(await browser.run("return document.getElementById('scene-bar').hidden"), true);
});

test('Forces_AreDrawnWhereAskedForAndTheAddressSaysSo', async () => {
  await open('#scene=fixture_head&frame=20');
  const hidden = (id) =>
    browser.run("return document.getElementById('scene-' + arguments[0]).parentNode.hidden", id);
  assert.equal(await hidden('forces'), false);
  const without = await picture();
  await choose('forces', 'arrows');
  const shown = await picture();
  assert.notEqual(shown, without);
  const link = await address();
  assert.match(link, /&forces=arrows/);
  await open(link);
  assert.equal(await picture(), shown);
  await choose('forces', 'hidden');
  assert.equal(await picture(), without);
  // A scene without contacts has nothing to choose.
  await open('#scene=fixture_wind&forces=arrows');
  assert.equal(await hidden('forces'), true);
  assert.doesNotMatch(await address(), /forces/);
  await no_errors();
});

test('Series_HasAPlotForEveryColumnThatFollowsTheFrame', async () => {
  await open('#scene=fixture_head', 1400, 1800);
  const titles = await browser.run(`
    return [...document.querySelectorAll('#scene-series .small-plot')].map((p) =>
      p.querySelector('svg .role-title-text')?.textContent ?? p.textContent);`);
  assert.deepEqual(titles, [
    'tip x (m)',
    'kinetic energy (J)',
    'length error (relative)',
    'contact (m): no value',
  ]);
  const rule = () =>
    browser.run(`return document.querySelector('#scene-series svg .mark-rule.role-mark line')
      .getAttribute('transform')`);
  const at_start = await rule();
  await choose('scrub', 20);
  assert.ok(await comes(async () => (await rule()) !== at_start));
  // A click on the first quarter of a plot goes there.
  const box = await browser.run(`
    const plot = document.querySelector('#scene-series svg .background');
    plot.scrollIntoView({ block: 'center', behavior: 'instant' });
    const { x, y, width, height } = plot.getBoundingClientRect();
    return [x + width / 4, y + height / 3];`);
  await browser.click_at(...box);
  assert.ok(await comes(async () => Math.abs((await frame()) - 39 / 4) <= 1), await address());
});

for (const width of [390, 768]) {
  test(`Scene_HasNoHorizontalScroll_${width}`, async () => {
    await open('#scene=fixture_head', width);
    const [content, view] = await browser.run(
      'return [document.documentElement.scrollWidth, window.innerWidth]',
    );
    assert.equal(view, width);
    assert.ok(content <= width, `${content} px wide`);
    const [canvas] = await browser.run(
      "return [document.getElementById('scene-canvas').clientWidth]",
    );
    assert.ok(canvas > 0.8 * width);
  });
}

test('Links_OfThePageGoBackToTheMeasurements', async () => {
  await open('#swing');
  const hidden = () => browser.run("return document.getElementById('panel-scenes').hidden");
  assert.equal(await hidden(), true);
  await browser.run("location.hash = '#scene=fixture_wind&frame=4'");
  assert.ok(await comes(async () => !(await hidden())));
  assert.equal(await frame(), 4);
  await browser.run("location.hash = '#swing'");
  assert.ok(await comes(hidden));
});

test('FillWindow_LeavesOnlyThePicture', async () => {
  await open('#scene=fixture_head&frame=10&full=picture', 800, 600);
  const [width, height, tools] = await browser.run(`
    const canvas = document.getElementById('scene-canvas');
    return [canvas.clientWidth, canvas.clientHeight,
      document.getElementById('scene-play').offsetParent === null];`);
  assert.ok(width > 700 && height > 500, `${width} x ${height}`);
  assert.equal(tools, true);
  await browser.press(keys.escape);
  assert.ok(await browser.run("return document.getElementById('scene-play').offsetParent !== null"));
});

// '#' starts the last part of an address, '%' an encoded character, '-' an option.
test('Picture_IsTakenOfAPageAndIntoAFileOfAnyName', () => {
  const folder = join(directory, '-a #%41');
  mkdirSync(folder);
  copyFileSync(join(directory, 'report.html'), join(folder, '-p\u00e9#.html'));
  const { status, stderr } = spawnSync(
    join(report_root, 'picture.sh'),
    ['-p\u00e9#.html', 'scene=fixture_wind&frame=3', '-o#1.png', '300,200'],
    { cwd: folder, encoding: 'utf8' },
  );
  assert.equal(status, 0, stderr);
  const png = readFileSync(join(folder, '-o#1.png'));
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [300, 200]);
  // A page that was not found gives a grey picture of an error: far smaller.
  assert.ok(png.length > 4000, `${png.length} bytes`);
  const missing = spawnSync(
    join(report_root, 'picture.sh'),
    ['none.html', 'scene=a', 'o.png'],
    { cwd: folder, encoding: 'utf8' },
  );
  assert.equal(missing.status, 2);
  assert.match(missing.stderr, /none\.html: no such page/);
});

// All of the strand, at every azimuth, and no more room than it needs where it is seen
// broadside (from -y).
test('Scenes_FillTheCanvasWithoutBeingCut', async () => {
  for (const [width, height] of [
    [1200, 500],
    [500, 1200],
  ]) {
    for (const azimuth of [-90, 0]) {
      await open(`#scene=fixture_wind&frame=9&view=${azimuth},15,1&full=picture`, width, height);
      const [left, right, top, bottom] = await browser.run(`
        const canvas = document.getElementById('scene-canvas');
        const { width, height } = canvas;
        const { data } = canvas.getContext('2d').getImageData(0, 0, width, height);
        const box = [1, 0, 1, 0];
        for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) {
          const k = 4 * (y * width + x);
          // The strand's brown: clearly more red than blue.
          if (data[k + 3] < 200 || data[k] < data[k + 2] + 25) continue;
          box[0] = Math.min(box[0], x / width); box[1] = Math.max(box[1], x / width);
          box[2] = Math.min(box[2], y / height); box[3] = Math.max(box[3], y / height);
        }
        return box;`);
      const where = `${width} ${height} ${azimuth}: ${[left, right, top, bottom]}`;
      assert.ok(left > 0.01 && right < 0.99 && top > 0.01 && bottom < 0.99, where);
      if (azimuth === -90) assert.ok(Math.max(right - left, bottom - top) > 0.6, where);
    }
  }
});
