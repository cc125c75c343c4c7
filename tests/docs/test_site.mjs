// The built documentation site in headless Chromium, opened from disk:
//   TRESS_SITE=build/docs/html node --test tests/docs/test_site.mjs
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { after, before, test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { pathToFileURL } from 'node:url';
import { Browser } from '../../experiments/report/src/chromium.mjs';

const site = resolve(process.env.TRESS_SITE ?? 'build/docs/html');
const skip = !existsSync(join(site, 'index.html')) && 'no site: ./tress docs builds it';
const axe = new URL('../../docs/site/node_modules/axe-core/axe.min.js', import.meta.url);
const pictures = process.env.TRESS_PICTURES; // a folder for screenshots
const pages = [
  'index',
  'start/first_strand',
  'start/how_to_choose',
  'theory/rod',
  'theory/models/der',
  'theory/integrators',
  'theory/glossary',
  'results/hard_cases',
  'reference/scene_file',
  'reference/cpp/system',
];
const widths = { phone: 390, desktop: 1400 };
const themes = ['light', 'dark'];
const browsers = {};

before(async () => {
  if (skip) return;
  for (const theme of themes)
    browsers[theme] = await Browser.start({ dark: theme === 'dark' });
});
after(() => Promise.all(Object.values(browsers).map((browser) => browser.stop())));

async function settled(browser, condition) {
  for (let attempt = 0; attempt < 500; ++attempt) {
    if (await browser.run(condition)) return true;
    await pause(20);
  }
  return false;
}

/// Opens a page of the site and waits for its mathematics.
async function visit(browser, page, width, height = 900) {
  await browser.devtools('Emulation.setDeviceMetricsOverride', {
    width,
    height,
    deviceScaleFactor: 1,
    mobile: false,
  });
  await browser.command('/url', { url: `${pathToFileURL(site)}/${page}` });
  const typeset = `return document.readyState === 'complete' && (!window.MathJax?.startup ||
    document.querySelectorAll('.math').length === 0 || document.querySelector('mjx-container') !== null)`;
  assert.ok(await settled(browser, typeset), `${page}: its mathematics is not set`);
}

/// Every page on a phone and on a desktop, every other one light; the first both ways.
const each = (use) => async () => {
  for (const [i, page] of pages.entries())
    for (const [j, [name, width]] of Object.entries(widths).entries())
      for (const [k, theme] of themes.entries())
        if (i === 0 || (i + j + k) % 2 === 0)
          await use({ browser: browsers[theme], theme, name, width, page });
};

test(
  'pages fit a phone and a desktop, in light and dark, without a network',
  { skip },
  each(async ({ browser, theme, name, width, page }) => {
    await browser.requests();
    await visit(browser, `${page}.html`, width);
    const seen = await browser.run(`return {
      wide: document.documentElement.scrollWidth,
      bad: document.querySelectorAll('mjx-merror, .problematic, .system-message').length,
      ground: getComputedStyle(document.body).backgroundColor,
      lost: [...document.images].filter((image) => image.complete && image.naturalWidth === 0).map(({ src }) => src),
    }`);
    assert.ok(seen.wide <= width, `${page}, ${name}: ${seen.wide} pixels wide`);
    assert.equal(seen.bad, 0, `${page}: mathematics or text that could not be set`);
    assert.deepEqual(seen.lost, [], page);
    const [red] = seen.ground.match(/\d+/);
    assert.equal(Number(red) < 128, theme === 'dark', `${page}: ${theme}: ${seen.ground}`);
    const away = (await browser.requests()).filter((url) => !/^(file|data|about):/.test(url));
    assert.deepEqual(away, [], page);
    if (pictures) {
      mkdirSync(pictures, { recursive: true });
      const file = `${page.replaceAll('/', '_')}_${name}_${theme}.png`;
      const { data } = await browser.devtools('Page.captureScreenshot', {});
      writeFileSync(join(pictures, file), Buffer.from(data, 'base64'));
    }
  }),
);

test('the search finds words of the field, ids and keys', { skip }, async () => {
  for (const [words, page] of [
    ['gravito-bending', 'theory/rod.html'],
    ['rattle', 'theory/integrators.html'],
    ['friction_law', 'reference/scene_file.html'],
  ]) {
    await visit(browsers.light, `search.html?q=${words}`, widths.desktop);
    assert.ok(
      await settled(
        browsers.light,
        `return [...document.querySelectorAll('#search-results li a')].some(({ href }) => href.includes('${page}'))`,
      ),
      `${words}: ${page} is not among the results`,
    );
  }
});

test('the button of the theme changes it', { skip }, async () => {
  await visit(browsers.light, 'index.html', widths.desktop);
  const theme = 'return document.body.dataset.theme';
  const first = await browsers.light.run(theme);
  await browsers.light.run("document.querySelector('.theme-toggle').click()");
  assert.notEqual(await browsers.light.run(theme), first);
  await browsers.light.run('localStorage.clear()');
});

test(
  'axe has no complaints',
  { skip: skip || (!existsSync(axe) && 'no axe-core: npm ci --prefix docs/site') },
  async () => {
    const found = [];
    for (const theme of themes) {
      // In the dark only colours differ.
      const light = theme === 'light';
      const rules = light ? {} : { runOnly: ['color-contrast'] };
      for (const page of light ? [...pages, 'search'] : ['index', 'reference/cpp/system']) {
        await visit(browsers[theme], `${page}.html`, widths.desktop);
        await browsers[theme].devtools('Runtime.evaluate', { expression: readFileSync(axe, 'utf8') });
        const complaints = await browsers[theme].run(`
          return axe.run(document, { resultTypes: ['violations'], ...arguments[0] }).then(({ violations }) =>
            violations.map(({ id, nodes }) =>
              id + ': ' + nodes.slice(0, 3).map(({ html }) => html.slice(0, 200)).join(' ')))`, rules);
        found.push(...complaints.map((text) => `${page}, ${theme}: ${text}`));
      }
    }
    assert.deepEqual(found, []);
  },
);
