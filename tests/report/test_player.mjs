// The scenes' picture by WebGL in headless Chromium: `node --test tests/report/test_player.mjs`.
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Browser } from '../../experiments/report/src/chromium.mjs';
import { Camera } from '../../experiments/report/src/browser/scenes/camera.mjs';
import {
  on_hair,
  towards_light,
} from '../../experiments/report/src/browser/scenes/light.mjs';
import {
  brown_hair,
  scattered,
  tables_of,
} from '../../experiments/report/src/hair/fibre.mjs';
import { picture_ms, write_many, write_scene as written_scene } from './picture_times.mjs';
import { fixture_directory, remove, run_page } from './support.mjs';

let directory, browser, url;

const base64 = (array) => Buffer.from(array.buffer).toString('base64');

const write_scene = (...what) => written_scene(directory, ...what);

// A line across the picture, seen from -y, 7 degrees off the vertical, and specks in a corner
// that make it one of so many that it is drawn thin.
const slope = 7 * (Math.PI / 180);
const line = Array.from({ length: 9 }, (_, i) => {
  const s = (i / 8 - 0.5) * 0.15;
  return [s * Math.sin(slope), 0, s * Math.cos(slope)];
});
const speck = (at) => [at, at.map((x, i) => x + (i === 2 ? 1e-5 : 0))];
const specks = Array.from({ length: 999 }, () => speck([-0.09, 0, -0.09]));

before(async () => {
  directory = fixture_directory();
  mkdirSync(join(directory, 'scenes'), { recursive: true });
  write_scene('thin', [line, ...specks]);
  write_scene('thick', [line, ...specks], { radius_m: Array(1000).fill(2.5e-3) });
  write_scene('fibre', [line], { radius_m: [2.5e-3] });
  const channel = (name, unit, high, values) => ({
    name,
    unit,
    low: 0,
    high,
    values: base64(new Uint8Array(values)),
  });
  write_scene('own_steps', [line], {
    radius_m: [2.5e-3],
    channels: [
      channel('step', 's', 0.01, Array(9).fill(255)),
      channel(
        'error in time',
        'of the length',
        2e-3,
        line.map((_, i) => (i < 4 ? 255 : 0)),
      ),
      channel('error in space', 'of the length', 0, Array(9).fill(0)),
    ],
  });
  assert.equal(run_page(directory).status, 0);
  url = `file://${join(directory, 'report.html')}`;
  browser = await Browser.start();
});

after(async () => {
  await browser?.stop();
  remove(directory);
});

const open = (hash) => browser.open(url + hash, 640, 520);
const drawn_by = () =>
  browser.run("return document.getElementById('scene-canvas').dataset.drawn");
const colours_offered = () =>
  browser.run(`return [...document.getElementById('scene-colour').options].map(
    ({ textContent }) => textContent)`);
const address = () => browser.run('return location.hash');

// Rows y0 <= y < y1 (parts of the height) as linear light, red, of the middle of the picture.
const middle_rows = (y0, y1) =>
  browser.run(
    `const canvas = document.getElementById('scene-canvas');
    const { width, height } = canvas;
    const [x, from, to] = [width / 4, arguments[0] * height, arguments[1] * height]
      .map(Math.round);
    const wide = Math.round(width / 2);
    const { data } = canvas.getContext('2d').getImageData(x, from, wide, to - from);
    const linear = (c) => (c <= 10.3 ? c / 3294.6 : ((c / 255 + 0.055) / 1.055) ** 2.4);
    return Array.from({ length: to - from }, (_, r) =>
      Array.from({ length: wide }, (_, k) => {
        const i = 4 * (r * wide + k);
        return data[i + 3] === 0 ? 1 : linear(data[i]); // the white page shows through
      }));`,
    y0,
    y1,
  );

// What covers a pixel takes that part of the background's light away. The thick line shows
// the strand's colour. Error of a row: three or four pixels near the background, each half a
// level of 255, 2.3e-3 of linear light there, added at random: 5e-3 of the line's colour's
// distance from white, which is above 0.7, times 1.2 pixels; all rows together far less.
for (const by of ['webgl', 'canvas'])
  test(`ThinLines_CoverTheirWidthWhereverTheyLie_${by}`, async () => {
    const view = `&view=-90,0,1&colour=strand&full=picture&draw=${by}`;
    await open(`#scene=thick${view}`);
    assert.equal(await drawn_by(), by);
    const colour = Math.min(...(await middle_rows(0.45, 0.55)).flat());
    assert.ok(colour < 0.3, `${colour}`);
    await open(`#scene=thin${view}`);
    const widths = (await middle_rows(0.35, 0.65)).map((row) =>
      row.reduce((sum, light) => sum + (1 - light) / (1 - colour), 0),
    );
    const wanted = 1.2 / Math.cos(slope);
    const mean = widths.reduce((a, b) => a + b, 0) / widths.length;
    assert.ok(widths.length > 100);
    assert.ok(Math.abs(mean - wanted) < 0.01 * wanted, `${mean}, ${wanted}`);
    for (const width of widths)
      assert.ok(Math.abs(width - wanted) < 0.04 * wanted, `${width}, ${wanted}`);
  });

// A thick hair through the middle of the picture has the colour that the tested tables give
// for its inclinations to light and eye. Levels of 255: one for rounding, one for halves of
// floats and the texture's eight-bit weights.
test('Hair_HasTheColourOfTheTables', async () => {
  const tables = tables_of(brown_hair);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const off = (a, u) => a.map((x, i) => x - dot(a, u) * u[i]);
  const tip = [Math.sin(slope), 0, Math.cos(slope)];
  const srgb = (c) => 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
  for (const view of ['-90,0,1', '-60,40,1', '20,-65,1']) {
    const camera = new Camera([0, 0, 0], 1);
    camera.read(view);
    const seen = camera.projection(640, 520);
    const [light, eye] = [towards_light(seen), seen.forward.map((x) => -x)];
    const [a, b] = [off(light, tip), off(eye, tip)];
    const phi = Math.acos(dot(a, b) / Math.sqrt(dot(a, a) * dot(b, b)));
    const direct = scattered(
      tables,
      Math.asin(dot(light, tip)),
      Math.asin(dot(eye, tip)),
      phi,
    );
    const wanted = direct.map((s, c) =>
      srgb(Math.min(1, on_hair.sun * s + on_hair.sky * tables.albedo[c])),
    );
    await open(`#scene=fibre&view=${view}&colour=hair&full=picture`);
    const found = await browser.run(`
      const canvas = document.getElementById('scene-canvas');
      const { width, height } = canvas;
      return [...canvas.getContext('2d').getImageData(width / 2, height / 2, 1, 1).data];`);
    wanted.forEach((level, c) =>
      assert.ok(Math.abs(found[c] - level) <= 2, `${view}: ${found}, ${wanted}`),
    );
  }
  assert.equal(await drawn_by(), 'webgl');
  assert.deepEqual(await colours_offered(), ['as hair in light', 'one colour a strand']);
  assert.match(await address(), /colour=hair/);
});

test('WithoutWebgl_TheCanvasDraws', async () => {
  const { identifier } = await browser.devtools('Page.addScriptToEvaluateOnNewDocument', {
    source: `const old = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind === 'webgl2' ? null : old.call(this, kind, ...rest);
      };`,
  });
  await open('#scene=fixture_head&colour=hair&draw=webgl');
  assert.equal(await drawn_by(), 'canvas');
  assert.deepEqual(await colours_offered(), [
    'curvature (1/m)',
    'load of gravity (N/m)',
    'one colour a strand',
  ]);
  assert.match(await address(), /colour=curvature&draw=webgl/);
  await browser.devtools('Page.removeScriptToEvaluateOnNewDocument', { identifier });
});

// How long a picture takes, without a bound: that is the machine's.
test('Frames_OfTwoThousandHairsAreTimed', async (t) => {
  write_many(directory);
  assert.equal(run_page(directory).status, 0);
  for (const by of ['webgl', 'canvas']) {
    const ms = await picture_ms(browser, url, by);
    assert.equal(await drawn_by(), by);
    t.diagnostic(
      `2 000 hairs of 20 points at 800 x 600 by ${by}: ${ms.toFixed(1)} ms a picture`,
    );
  }
});

// Errors and steps are channels of the recording, offered where it has them.
test('StrandErrorsAndSteps_AreColoursOfRunsThatHaveThem', async () => {
  await open('#scene=own_steps&view=-90,0,1&colour=error+in+time&full=picture');
  assert.deepEqual(await colours_offered(), [
    'step (s)',
    'error in time (of the length)',
    'as hair in light',
    'one colour a strand',
  ]);
  const bar = () =>
    browser.run(
      "return document.getElementById('scene-bar').innerText.split(/\\s*\\n\\s*/)",
    );
  assert.deepEqual(await bar(), ['error in time (of the length)', '0', '0.002']);
  const darkest = async (from, to) =>
    Math.min(...(await middle_rows(from, to)).map((row) => Math.min(...row)));
  // The line's upper half has no error, its lower half the largest, which is more red.
  const [none, most] = [await darkest(0.3, 0.4), await darkest(0.6, 0.7)];
  assert.ok(most > none + 0.3, `${none}, ${most}`);
  await open('#scene=thick&colour=error+in+time');
  assert.ok((await colours_offered()).every((name) => !/error|step/.test(name)));
  assert.match(await address(), /colour=(?!error)/);
});

test('Picture_FollowsTheDifferenceOfTwoRuns', async () => {
  await open('#scene=thin&beside=thick&full=1');
  const offered = await colours_offered();
  assert.ok(offered.includes('difference (m)'), `${offered}`);
  // The two lie at the same places.
  assert.match(
    await browser.run("return document.getElementById('scene-bar').innerText"),
    /difference \(m\)\s+0\s+0$/,
  );
  assert.match(await address(), /colour=difference&beside=thick/);
  await open('#scene=thin&beside=fixture_wind');
  assert.ok(!(await colours_offered()).includes('difference (m)'));
});

test('Loop_BeginsAgainAndIsInTheAddress', async () => {
  await open('#scene=fixture_wind&frame=28&loop=1');
  await browser.run(`document.getElementById('scene-speed').value = '2';
    document.getElementById('scene-play').click();`);
  const frame = "return Number(document.getElementById('scene-canvas').dataset.frame)";
  let least = 29;
  for (let i = 0; i < 100 && least > 20; ++i)
    least = Math.min(least, await browser.run(frame));
  assert.ok(least <= 20, `${least}`);
  await browser.run("document.getElementById('scene-play').click()");
  assert.match(await address(), /&loop=1/);
});

// A film draws the picture of a time at once, also between two frames.
test('SceneTime_IsDrawnBeforeTheEventReturns', async () => {
  await open('#scene=fixture_wind');
  const [first, second, text] = await browser.run(`
    const canvas = document.getElementById('scene-canvas');
    const at = (time) => {
      canvas.dispatchEvent(new CustomEvent('scene-time', { detail: time }));
      return canvas.toDataURL();
    };
    return [at(0.1), at(0.1125), document.getElementById('scene-time').textContent];`);
  assert.notEqual(first, second);
  assert.match(text, /^0\.11[23] s, frame 4 of 29/);
});
