// Writes dist/: report.mjs and film.mjs (commands), render.mjs (SVG in Node), page.html
// (template), live.html (page of ./tress play), notices. Developers who change the page run `npm ci && npm run build` and commit dist/.
import { build } from 'esbuild';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { packed } from './src/packed.mjs';
import { sources_hash } from './src/sources_hash.mjs';

const base = fileURLToPath(new URL('.', import.meta.url));
const at = (path) => `${base}${path}`;
const hash = sources_hash(base);

const common = {
  bundle: true,
  write: false,
  metafile: true,
  minify: true,
  charset: 'utf8',
  format: 'esm',
  legalComments: 'none',
  absWorkingDir: base,
  define: { TRESS_SOURCES: JSON.stringify(hash) },
};
const node = { ...common, platform: 'node', target: 'node18' };

const report = await build({
  ...node,
  entryPoints: ['src/report.mjs'],
  external: ['./render.mjs'],
});
const render = await build({ ...node, entryPoints: ['src/render.mjs'] });
const film = await build({ ...node, entryPoints: ['src/film.mjs'] });
const browser = { ...common, platform: 'browser', target: 'es2022', format: 'iife' };
const page = await build({ ...browser, entryPoints: ['src/browser/main.mjs'] });
const start = await build({ ...browser, entryPoints: ['src/browser/start.mjs'] });

const live = await build({ ...browser, entryPoints: ['src/browser/live/main.mjs'] });

// The package that a file belongs to, undefined for our own.
const package_of = (path) =>
  [...path.matchAll(/node_modules\/((?:@[^/]+\/)?[^/]+)/g)].at(-1)?.[1];

// Some packages come with others inside: the source map beside a file names them.
function sources_of(input) {
  const map = at(`${input}.map`);
  if (package_of(input) === undefined || !existsSync(map)) return [input];
  return [input, ...JSON.parse(readFileSync(map, 'utf8')).sources];
}

// Licence texts of every bundled package, each text once.
function notices(inputs) {
  const packages = [
    ...new Set(inputs.flatMap(sources_of).map(package_of).filter(Boolean)),
  ].sort();
  const texts = new Map();
  for (const name of packages) {
    const folder = at(`node_modules/${name}/`);
    const file =
      existsSync(folder) &&
      readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    if (!file) throw new Error(`${name}: no licence file`);
    const text = readFileSync(folder + file, 'utf8').trim();
    texts.set(text, [...(texts.get(text) ?? []), name]);
  }
  return [...texts]
    .map(([text, names]) => `${names.join(', ')}\n\n${text}\n`)
    .join(`\n${'-'.repeat(72)}\n\n`);
}

const inputs = [report, render, film, page, start, live].flatMap(({ metafile }) =>
  Object.keys(metafile.inputs),
);
const notice = notices(inputs);
const [program, starting] = [page, start].map(({ outputFiles }) =>
  outputFiles[0].text.trim(),
);
const hash_of = (text) =>
  `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

// A page from its source: `scripts` may run, `parts` replace their names.
function page_of(path, scripts, connect, parts) {
  const policy =
    "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:; " +
    `${connect}style-src 'unsafe-inline'; script-src ${scripts.map(hash_of).join(' ')}`;
  const all = {
    TRESS_SOURCES_VALUE: hash,
    '/*TRESS_STYLE*/': readFileSync(at('src/browser/style.css'), 'utf8'),
    TRESS_POLICY_VALUE: policy,
    ...parts,
  };
  return Object.entries(all).reduce(
    (text, [name, value]) => text.replace(name, () => value),
    readFileSync(at(path), 'utf8'),
  );
}

const html = page_of('src/browser/page.html', [starting, program], '', {
  '/*TRESS_PROGRAM*/': packed(Buffer.from(program)),
  '/*TRESS_START*/': starting,
  TRESS_NOTICES_VALUE: notice.replaceAll('<', '&lt;').replaceAll('--', '- -'),
});
const live_program = live.outputFiles[0].text.trim();
const live_html = page_of(
  'src/browser/live/live.html',
  [live_program],
  "connect-src 'self'; ",
  { '/*TRESS_PROGRAM*/': live_program },
);

mkdirSync(at('dist'), { recursive: true });
writeFileSync(at('dist/report.mjs'), report.outputFiles[0].text);
writeFileSync(at('dist/film.mjs'), film.outputFiles[0].text);
writeFileSync(at('dist/render.mjs'), render.outputFiles[0].text);
writeFileSync(at('dist/page.html'), html);
writeFileSync(at('dist/live.html'), live_html);
writeFileSync(at('dist/NOTICES.txt'), notice);
