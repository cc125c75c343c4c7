// How long pictures of 2 000 hairs take in headless Chromium: `node
// tests/report/picture_times.mjs` writes results/player.csv, the limit that docs/player.md
// says; test_player.mjs draws the same.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { Browser } from '../../experiments/report/src/chromium.mjs';
import { fixture_directory, remove, run_page } from './support.mjs';

const size = { hairs: 2000, points: 20, width: 800, height: 600 };

const base64 = (array) => Buffer.from(array.buffer).toString('base64');

// Points within the box of -0.1 .. 0.1 m in every direction, one frame.
export function write_scene(directory, name, strands, more = {}) {
  const points = strands.flat();
  const words = points.flatMap((p) =>
    p.map((x) => Math.round(((x + 0.1) / 0.2) * 65535)),
  );
  const scene = {
    format: 'tress-strands-1', scene: name, title: name, source: '', model: 'made up',
    integrator: 'none', dt_s: null, times_s: [0], low: [-0.1, -0.1, -0.1],
    high: [0.1, 0.1, 0.1], strand_points: strands.map((strand) => strand.length),
    positions: base64(new Uint16Array(words)), channels: [], bodies: [],
    series: { columns: ['t_s'], rows: [[0]] }, ...more,
  }; // prettier-ignore
  writeFileSync(join(directory, 'scenes', `${name}.json`), JSON.stringify(scene));
}

export function write_many(directory) {
  const hair = (k) => {
    const [x, y] = [0.08 * Math.cos(2.4 * k), 0.08 * Math.sin(2.4 * k)];
    return Array.from({ length: size.points }, (_, i) => [x, y, 0.09 - 0.009 * i]);
  };
  write_scene(
    directory,
    'many',
    Array.from({ length: size.hairs }, (_, k) => hair(k)),
  );
}

// Milliseconds of a picture of the scene `many`, drawn one way: 'canvas' or 'webgl'. Pixels
// are read back, so that every picture is done.
export async function picture_ms(browser, page, by, colour = 'strand') {
  await browser.open(
    `${page}#scene=many&colour=${colour}&full=picture&draw=${by}`,
    size.width,
    size.height,
  );
  return browser.run(`
    const canvas = document.getElementById('scene-canvas');
    const pictures = 10;
    const begin = performance.now();
    for (let i = 0; i < pictures; ++i) {
      canvas.dispatchEvent(new CustomEvent('scene-time', { detail: 0 }));
      canvas.getContext('2d').getImageData(0, 0, 1, 1);
    }
    return (performance.now() - begin) / pictures;`);
}

async function write_table() {
  const directory = fixture_directory();
  mkdirSync(join(directory, 'scenes'), { recursive: true });
  write_many(directory);
  const { status, stderr } = run_page(directory);
  if (status !== 0) throw new Error(stderr);
  const page = `file://${join(directory, 'report.html')}`;
  const browser = await Browser.start();
  const lines = ['draw,colour,hairs,points,width,height,picture_ms'];
  try {
    for (const [by, colour] of [
      ['canvas', 'strand'],
      ['webgl', 'strand'],
      ['webgl', 'hair'],
    ]) {
      const all = [];
      for (let i = 0; i < 5; ++i) all.push(await picture_ms(browser, page, by, colour));
      const ms = all.sort((a, b) => a - b)[2];
      lines.push([by, colour, ...Object.values(size), ms].join(','));
      console.log(lines.at(-1));
    }
  } finally {
    await browser.stop();
    remove(directory);
  }
  writeFileSync(
    fileURLToPath(new URL('../../results/player.csv', import.meta.url)),
    `${lines.join('\n')}\n`,
  );
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await write_table();
