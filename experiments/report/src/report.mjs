// report.mjs RESULTS [--out FILE] [--no-figures]: one self-contained page, one SVG per
// figure beside the CSVs.
import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { all_objects, InputError } from './csv.mjs';
import { load_results } from './load.mjs';
import { body_html } from './page.mjs';
import { load_scenes } from './scene_file.mjs';
import { scene_data_html } from './scenes_page.mjs';

export const sources = TRESS_SOURCES;

const usage = `usage: node report.mjs RESULTS [--out FILE] [--no-figures]
  RESULTS       directory that holds the CSV files; the SVG figures are written there
  --out FILE    the page (default RESULTS/report.html)
  --no-figures  the page alone, which draws its own figures: no SVG
example: node experiments/report/dist/report.mjs results/ --out results/report.html`;

function options_of(argv) {
  const options = { directory: undefined, out: undefined, figures: true };
  for (let i = 0; i < argv.length; ++i) {
    if (argv[i] === '--help' || argv[i] === '-h') return { help: true };
    if (argv[i] === '--out') {
      if (argv[i + 1] === undefined) throw new InputError('--out: no file given');
      options.out = argv[++i];
    } else if (argv[i] === '--no-figures') {
      options.figures = false;
    } else if (argv[i].startsWith('-')) {
      throw new InputError(
        `${argv[i]}: unknown option; known are --out, --no-figures and --help`,
      );
    } else if (options.directory === undefined) {
      options.directory = argv[i];
    } else {
      throw new InputError(`${argv[i]}: a second directory; give one`);
    }
  }
  if (options.directory === undefined)
    throw new InputError('no results directory given; see --help');
  return { ...options, out: options.out ?? join(options.directory, 'report.html') };
}

function write(path, text) {
  try {
    writeFileSync(path, text);
  } catch (error) {
    throw new InputError(
      `${path}: cannot write (${error.code}); choose another place with --out`,
    );
  }
}

// '<' must not end the script element that carries the data.
const embedded_json = (value) => JSON.stringify(value).replaceAll('<', '\\u003c');

const script_hash = (text) =>
  `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

// The page: the template with policy, text and data filled in.
export function page_html(template, tables, objects, scenes) {
  const script = /<script id="program">([\s\S]*?)<\/script>/.exec(template)[1];
  const policy =
    "default-src 'none'; base-uri 'none'; form-action 'none'; " +
    `img-src data:; style-src 'unsafe-inline'; script-src ${script_hash(script)}`;
  const data = Object.fromEntries(
    Object.entries(tables).map(([name, { columns, rows, glossary }]) => [
      name,
      { columns, rows, glossary },
    ]),
  );
  const values = {
    POLICY: policy,
    BODY: body_html(tables, objects, scenes),
    DATA: embedded_json(data),
    SCENES: scene_data_html(scenes, embedded_json),
  };
  return template.replace(
    /<!--TRESS_(POLICY|BODY|DATA|SCENES)-->|TRESS_(POLICY)_VALUE/g,
    (_, slot, attribute) => values[slot ?? attribute],
  );
}

async function main(argv) {
  const { help, directory, out, figures } = options_of(argv);
  if (help) {
    console.log(usage);
    return;
  }
  const tables = load_results(directory);
  const scenes = load_scenes(directory);
  const objects = all_objects(tables);
  const template = readFileSync(
    fileURLToPath(new URL('./page.html', import.meta.url)),
    'utf8',
  );
  const drawn = figures ? await (await import('./render.mjs')).render_figures(objects) : [];
  for (const { id, svg } of drawn) write(join(directory, `${id}.svg`), svg);
  write(out, page_html(template, tables, objects, scenes));
  console.error(
    `${out}: ${Object.keys(tables).length} tables, ${drawn.length} figures, ` +
      `${scenes.length} scenes`,
  );
}

main(process.argv.slice(2)).catch((error) => {
  if (!(error instanceof InputError)) throw error;
  console.error(`report: ${error.message}`);
  process.exitCode = 2;
});
