// The command `node film.mjs PAGE-OR-RUN ADDRESS OUT`: see usage below.
import {
  copyFileSync,
  existsSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  renameSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { spawnSync } from 'node:child_process';
import { parseArgs } from 'node:util';
import { ArrayBufferTarget, Muxer } from 'webm-muxer';
import { Browser } from './chromium.mjs';
import { InputError } from './input.mjs';
import { most_levels } from './packing.mjs';

export const sources = TRESS_SOURCES;

const usage = `usage: ./tress film PAGE-OR-RUN ADDRESS OUT [options]
  PAGE-OR-RUN   a page that ./tress report wrote, or one scene as simulate writes it,
                results/scenes/NAME.json
  ADDRESS       what is seen, as in the address of the page: 'scene=NAME&view=-60,15,1&
                colour=hair'; '' is the first scene as it opens
  OUT           film.webm, or a new or empty folder for 00000.png, 00001.png ...
  --size W,H    pixels, even numbers for a film (default 1280,720)
  --scale X     lines and letters X times as large, for prints (default 1)
  --rate N      pictures a second (default 25)
  --speed X     seconds of the scene in a second of the film (default 1)
  --from S, --to S   seconds of the scene (default all of it)
  --dark        the page's dark colours
needs chromium and chromedriver (./tress setup installs them)
exit code: 0 done, 2 a bad argument
example: ./tress film results/report.html 'scene=full_head&colour=hair' head.webm`;

const longest = 20000; // pictures

function number(text, name, least, most) {
  const value = Number(text);
  if (text.trim() === '' || !(value >= least && value <= most))
    throw new InputError(`--${name} ${text}: must be a number from ${least} to ${most}`);
  return value;
}

function options_of(argv) {
  const text = { type: 'string' };
  const options = {
    size: { ...text, default: '1280,720' },
    scale: { ...text, default: '1' },
    rate: { ...text, default: '25' },
    speed: { ...text, default: '1' },
    from: text,
    to: text,
    dark: { type: 'boolean', default: false },
    help: { type: 'boolean', short: 'h' },
  };
  let parsed;
  try {
    parsed = parseArgs({ args: argv, options, allowPositionals: true });
  } catch (error) {
    throw new InputError(`${error.message.split('.')[0]}; see --help`);
  }
  const { values, positionals } = parsed;
  if (values.help) return { help: true };
  if (positionals.length !== 3)
    throw new InputError(
      "three arguments are needed: PAGE-OR-RUN 'scene=NAME' OUT; see --help",
    );
  const size = /^(\d+),(\d+)$/.exec(values.size)?.slice(1).map(Number);
  if (size === undefined || size.some((pixels) => pixels < 64 || pixels > 8192))
    throw new InputError(
      `--size ${values.size}: must be WIDTH,HEIGHT of 64 to 8192 pixels`,
    );
  const [source, address, out] = positionals;
  const film = out.endsWith('.webm');
  if (film && size.some((pixels) => pixels % 2 === 1))
    throw new InputError(`--size ${values.size}: a film needs even numbers`);
  return {
    source, address, out: resolve(out), film, size, dark: values.dark,
    scale: number(values.scale, 'scale', 1, 8),
    rate: number(values.rate, 'rate', 1, 240),
    speed: number(values.speed, 'speed', 1e-6, 1e6),
    from: values.from === undefined ? -Infinity : number(values.from, 'from', 0, 1e9),
    to: values.to === undefined ? Infinity : number(values.to, 'to', 0, 1e9),
  }; // prettier-ignore
}

function check_out(out, film) {
  if (!existsSync(dirname(out)))
    throw new InputError(`${out}: its folder does not exist; make it or choose another`);
  if (!existsSync(out)) return;
  if (film && !statSync(out).isFile())
    throw new InputError(`${out}: is not a file; rename it`);
  if (!film && (!statSync(out).isDirectory() || readdirSync(out).length > 0))
    throw new InputError(
      `${out}: is there and no empty folder; choose another, or one.webm`,
    );
}

// The page itself, or one made of a single run in `folder`.
function page_of(source, folder) {
  if (!existsSync(source) || !statSync(source).isFile())
    throw new InputError(
      `${source}: no such file; give a page or results/scenes/NAME.json`,
    );
  if (!source.endsWith('.json')) return resolve(source);
  mkdirSync(join(folder, 'scenes'));
  for (const path of [source, source.replace(/\.json$/, '.meta.json')])
    if (existsSync(path)) copyFileSync(path, join(folder, 'scenes', basename(path)));
  const command = fileURLToPath(new URL('./report.mjs', import.meta.url));
  const { status, stderr } = spawnSync(
    process.execPath,
    [command, folder, '--no-figures', '--levels', String(most_levels)],
    { encoding: 'utf8' },
  );
  if (status !== 0)
    throw new InputError(
      stderr
        .trim()
        .split('\n')[0]
        .replace(/^report: /, ''),
    );
  return join(folder, 'report.html');
}

// The page's scenes, and whether the one wanted is there.
async function check_scene(browser, address, source) {
  const names = await browser.run(
    `return [...(document.getElementById('scene-name')?.options ?? [])].map(({ value }) => value)`,
  );
  if (names.length === 0)
    throw new InputError(`${source}: holds no scene; run simulate, then ./tress report`);
  const wanted = new URLSearchParams(address);
  for (const key of ['scene', 'beside'])
    if (wanted.has(key) && !names.includes(wanted.get(key)))
      throw new InputError(
        `${key}=${wanted.get(key)}: no such scene in ${source}; there are ${names.join(', ')}`,
      );
}

// Film in WebM: the browser's own encoder of VP9, a picture at a time.
class Film {
  static async start(browser, { size: [width, height], rate }) {
    const codec = 'vp09.00.41.08';
    const fits = await browser.run(
      `const [codec, width, height, framerate] = arguments;
      const config = { codec, width, height, framerate, bitrate: 8 * width * height };
      if (typeof VideoEncoder === 'undefined') return false;
      return VideoEncoder.isConfigSupported(config).then(({ supported }) => {
        if (!supported) return false;
        window.film_chunks = [];
        window.film_encoder = new VideoEncoder({
          output: (chunk) => {
            const bytes = new Uint8Array(chunk.byteLength);
            chunk.copyTo(bytes);
            let text = '';
            for (const byte of bytes) text += String.fromCharCode(byte);
            film_chunks.push([btoa(text), chunk.type, chunk.timestamp]);
          },
          error: (error) => (window.film_error = error.message),
        });
        film_encoder.configure(config);
        return true;
      });`,
      codec,
      width,
      height,
      rate,
    );
    if (!fits)
      throw new InputError(
        'this Chromium encodes no VP9; give a folder for PNG pictures',
      );
    const film = new Film();
    film.browser = browser;
    film.rate = rate;
    film.muxer = new Muxer({
      target: new ArrayBufferTarget(),
      video: { codec: 'V_VP9', width, height, frameRate: rate },
    });
    return film;
  }

  async add(png, i) {
    const chunks = await this.browser.run(
      `const [png, i, rate] = arguments;
      const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
      return createImageBitmap(new Blob([bytes], { type: 'image/png' })).then(async (bitmap) => {
        const frame = new VideoFrame(bitmap, {
          timestamp: (1e6 * i) / rate, duration: 1e6 / rate });
        film_encoder.encode(frame, { keyFrame: i % (10 * rate) === 0 });
        frame.close();
        await film_encoder.flush();
        if (window.film_error) throw new Error(film_error);
        return film_chunks.splice(0);
      });`,
      png,
      i,
      this.rate,
    );
    for (const [data, type, timestamp] of chunks)
      this.muxer.addVideoChunkRaw(Buffer.from(data, 'base64'), type, timestamp);
  }

  finish() {
    this.muxer.finalize();
    return Buffer.from(this.muxer.target.buffer);
  }
}

async function pictures(browser, options, take) {
  const { start, seconds } = await browser.run(
    `const { start, seconds } = document.getElementById('scene-canvas').dataset;
    return { start: Number(start), seconds: Number(seconds) };`,
  );
  const from = Math.max(start, options.from);
  const to = Math.min(start + seconds, options.to);
  if (!(from <= to))
    throw new InputError(
      `--from, --to: the scene lasts from ${start} to ${start + seconds} s`,
    );
  const count = Math.floor(((to - from) / options.speed) * options.rate + 1e-6) + 1;
  if (count > longest)
    throw new InputError(
      `${count} pictures, more than ${longest}; give --speed or --rate`,
    );
  for (let i = 0; i < count; ++i) {
    await browser.run(
      `document.getElementById('scene-canvas').dispatchEvent(
        new CustomEvent('scene-time', { detail: arguments[0] }))`,
      from + (i * options.speed) / options.rate,
    );
    const { data } = await browser.devtools('Page.captureScreenshot', { format: 'png' });
    await take(data, i);
  }
  return count;
}

async function film(options) {
  check_out(options.out, options.film);
  const folder = mkdtempSync(join(tmpdir(), 'tress-film-'));
  let browser;
  try {
    const page = page_of(options.source, folder);
    browser = await Browser.start({ dark: options.dark });
    const address = options.address.replace(/^#/, '');
    const parts = new URLSearchParams(address);
    const scene = parts.get('scene') ?? '';
    parts.delete('scene');
    parts.set('full', 'picture');
    // The page knows an address of scenes by its beginning.
    const hash = `#scene=${encodeURIComponent(scene)}&${parts}`;
    const [width, height] = options.size.map((pixels) =>
      Math.round(pixels / options.scale),
    );
    await browser.open(pathToFileURL(page) + hash, width, height, options.scale);
    await check_scene(browser, address, options.source);
    const reel = options.film ? await Film.start(browser, options) : undefined;
    if (!options.film) mkdirSync(options.out, { recursive: true });
    const count = await pictures(browser, options, (png, i) =>
      reel
        ? reel.add(png, i)
        : writeFileSync(
            join(options.out, `${String(i).padStart(5, '0')}.png`),
            Buffer.from(png, 'base64'),
          ),
    );
    if (reel) {
      writeFileSync(`${options.out}.part`, reel.finish());
      renameSync(`${options.out}.part`, options.out);
    }
    console.error(`${options.out}: ${count} pictures`);
  } finally {
    await browser?.stop();
    rmSync(folder, { recursive: true, force: true });
  }
}

try {
  const options = options_of(process.argv.slice(2));
  if (options.help) console.log(usage);
  else await film(options);
} catch (error) {
  if (!(error instanceof InputError)) throw error;
  console.error(`film: ${error.message}`);
  process.exitCode = 2;
}
