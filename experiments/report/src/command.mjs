// report.mjs RESULTS [--out FILE] [--no-figures]: one self-contained page, one SVG per
// figure next to the CSVs. A file that cannot be used is a warning on stderr and a gap on
// the page.
import { existsSync, renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { InputError } from './input.mjs';
import { load_results } from './load.mjs';
import { all_objects } from './objects.mjs';
import { body_html } from './page.mjs';
import { packed } from './packed.mjs';
import { most_levels, page_levels } from './packing.mjs';
import { load_scenes } from './scene_file.mjs';
import { scene_data_html } from './scenes_page.mjs';
import { mixed_commits } from './provenance.mjs';
import { Warnings } from './warnings.mjs';

const usage = `usage: node report.mjs RESULTS [--out FILE] [--no-figures] [--levels N]
  RESULTS       directory that holds the CSV files; the SVG figures are written there
  --out FILE    the page (default RESULTS/report.html)
  --no-figures  the page alone, which draws its own figures: no SVG
  --levels N    positions of scenes to 1/N of the longest side of their box; ${page_levels},
                up to ${most_levels}
A file that cannot be read is a warning, and named on the page in its place.
exit code: 0 the page was written, 2 a bad argument, or files and none of them usable
example: node experiments/report/dist/report.mjs results/ --out results/report.html`;

function levels_of(text) {
  const levels = Number(text);
  if (!Number.isInteger(levels) || levels < 256 || levels > most_levels)
    throw new InputError(
      `--levels ${text}: must be a whole number from 256 to ${most_levels}`,
    );
  return levels;
}

function options_of(argv) {
  const options = {
    directory: undefined,
    out: undefined,
    figures: true,
    levels: page_levels,
  };
  for (let i = 0; i < argv.length; ++i) {
    if (argv[i] === '--help' || argv[i] === '-h') return { help: true };
    if (argv[i] === '--out') {
      if (argv[i + 1] === undefined) throw new InputError('--out: no file given');
      options.out = argv[++i];
    } else if (argv[i] === '--levels') {
      options.levels = levels_of(argv[++i]);
    } else if (argv[i] === '--no-figures') {
      options.figures = false;
    } else if (argv[i].startsWith('-')) {
      throw new InputError(
        `${argv[i]}: unknown option; known are --out, --no-figures, --levels and --help`,
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

// The whole file or none: a regular file appears under its name when it is complete.
function write(path, text, remedy) {
  const direct = existsSync(path) && !statSync(path).isFile();
  const place = direct ? path : `${path}.part`;
  try {
    writeFileSync(place, text);
    if (!direct) renameSync(place, path);
  } catch (error) {
    if (!direct) rmSync(place, { force: true });
    throw new InputError(`${path}: cannot write (${error.code}); ${remedy}`);
  }
}

// The page: the template with text and data filled in. Values of one column lie together:
// they compress better.
function page_html(template, { tables, objects, scenes, levels }, warnings) {
  const data = Object.fromEntries(
    Object.entries(tables).map(([name, { columns, rows, glossary }]) => [
      name,
      { columns, glossary, values: columns.map((_, c) => rows.map((row) => row[c])) },
    ]),
  );
  const values = {
    BODY: body_html(tables, objects, scenes, warnings),
    DATA: packed(Buffer.from(JSON.stringify(data))),
    SCENES: scene_data_html(scenes, levels),
  };
  return template.replace(/<!--TRESS_(BODY|DATA|SCENES)-->/g, (_, slot) => values[slot]);
}

// Writes one SVG for each; returns how many. What cannot be written is one warning.
function write_figures(directory, drawn, warn) {
  const failed = drawn.filter(({ id, svg }) => {
    try {
      write(join(directory, `${id}.svg`), svg);
      return false;
    } catch (error) {
      if (!(error instanceof InputError)) throw error;
      return true;
    }
  });
  if (failed.length > 0)
    warn(
      `${directory}: cannot write ${failed.map(({ id }) => `${id}.svg`).join(', ')}; ` +
        'make room for them there or give --no-figures',
    );
  return drawn.length - failed.length;
}

const counted = (count, noun) => `${count} ${noun}${count === 1 ? '' : 's'}`;

async function report({ directory, out, figures, levels }, { template, render, say }) {
  const warnings = new Warnings(directory, say);
  const warn = (text, table) => warnings.add(text, table);
  const tables = load_results(directory, warn);
  const scenes = load_scenes(directory, warn);
  const count = Object.keys(tables).length;
  if (warnings.list.length > 0 && count + scenes.length === 0)
    throw new InputError(`${directory}: nothing to draw: no file in it could be used`);
  const mixed = mixed_commits(tables);
  if (mixed !== '') say(`report: ${mixed.replace(/\p{Cc}+/gu, ' ')}`);
  const objects = all_objects(tables);
  const html = page_html(template(), { tables, objects, scenes, levels }, warnings);
  write(out, html, 'choose another place with --out');
  const drawn = figures ? await render(objects, warnings) : [];
  const written = write_figures(directory, drawn, warn);
  say(
    `${out}: ${counted(count, 'table')}, ${counted(written, 'figure')}, ${counted(scenes.length, 'scene')}` +
      (warnings.list.length > 0 ? `, ${counted(warnings.list.length, 'warning')}` : ''),
  );
}

// The exit code. `template()`: the page without its data; `render(objects, warnings)`: the
// figures as [{id, svg}]; `say`: where lines go.
export async function run(argv, { template, render, say = console.error }) {
  try {
    const options = options_of(argv);
    if (options.help) console.log(usage);
    else await report(options, { template, render, say });
    return 0;
  } catch (error) {
    if (!(error instanceof InputError)) throw error;
    say(`report: ${error.message}`);
    return 2;
  }
}
