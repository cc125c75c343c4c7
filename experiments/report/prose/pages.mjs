// Every page made from a template, and the answers to its slots.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { all_objects } from '../src/objects.mjs';
import { InputError } from '../src/input.mjs';
import { load_results } from '../src/load.mjs';
import { allowed } from './allowed.mjs';
import { literals } from './literals.mjs';
import { queries } from './queries/all.mjs';
import { provenance } from './queries/machine.mjs';
import { fill, untraced_numbers } from './template.mjs';

// The page of a template: that of a study lies in the study's folder.
function page_of(name) {
  if (name === 'README.md') return name;
  if (name === 'results.md') return 'results/README.md';
  const study = /^studies\/(.*)\.md$/.exec(name);
  return study ? `experiments/${study[1]}/README.md` : `docs/${name}`;
}

const made_from = (template) =>
  `<!-- Made by ./tress report from docs/templates/${template} and results/: edit those. -->\n`;

// {template, page} relative to the repository, by name.
export function page_files(root) {
  const list = (folder) =>
    readdirSync(join(root, 'docs/templates', folder))
      .filter((name) => name.endsWith('.md'))
      .sort()
      .map((name) => (folder === '' ? name : `${folder}/${name}`));
  return [...list(''), ...list('studies')].map((name) => ({
    name,
    template: `docs/templates/${name}`,
    page: page_of(name),
  }));
}

// Pages that somebody wrote by hand, and sources whose texts fill slots. What a page is made
// of elsewhere has a check of its own: the program prints scenes/README.md and the list of
// the catalogue, and a test compares them.
export const written_by_hand = [
  'CONTRIBUTING.md',
  'experiments/benchmarks/README.md',
  'experiments/calibrate/data/README.md',
  'experiments/report/README.md',
];
// Pages of the manual: definitions, formulas, commands and what these print. They have no
// result of a table; a page with results is made from a template.
export const is_manual = (page) =>
  page === 'CHANGELOG.md' || page === 'docs/index.md' || /^docs\/(theory|start|reference|about)\//.test(page);
// Where a page of the manual states a share or a time, as results do.
export function results_in_manual(page, text) {
  const plain = allowed.reduce(
    (rest, { text: known }) => rest.replace(known, ''),
    text.replace(/^```[\s\S]*?^```/gm, (fence) => fence.replace(/[^\n]/g, '')),
  );
  return plain.split('\n').flatMap((line, i) =>
    [...line.matchAll(/[\d.]+ ?(?:%|[mµn]s\b)/g)].map(
      ([found]) => `${page}:${i + 1}: '${found}' may be a result; compute it on a page made from a template`,
    ),
  );
}

// These print texts of other sources, and what columns mean.
const quoting = ['columns.mjs', 'python.mjs', 'references.mjs'];
export const text_sources = (root) =>
  ['experiments/report/prose/queries', 'experiments/report/src/findings'].flatMap((folder) =>
    readdirSync(join(root, folder))
      .filter((name) => name.endsWith('.mjs') && !quoting.includes(name))
      .sort()
      .map((name) => `${folder}/${name}`),
  );

// Where a text names a number or a number word that no query computed.
export function untraced(file, template) {
  return untraced_numbers(template).map(
    ({ line, text }) =>
      `${file}:${line}: '${text}' is typed by hand; compute it with {{ page.query }}, or add ` +
      'the definition or input that it is to experiments/report/prose/allowed.mjs',
  );
}

export const untraced_literals = (file, source) =>
  literals(source).flatMap(({ line, text }) =>
    untraced_numbers(text).map(
      (one) => `${file}:${line + one.line - 1}: '${one.text}' in a text that is printed; compute it`,
    ),
  );

export function answers(tables, root) {
  return (name) => {
    const [page, query] = name.split('.');
    const found = queries[page]?.[query];
    if (typeof found !== 'function') {
      const known = Object.keys(queries[page] ?? queries).join(', ');
      throw new Error(`no such query; there are: ${known}`);
    }
    return found(tables, root);
  };
}

// A page without the marks of its regions of inputs.
const without_marks = (text) =>
  text
    .replace(/^<!-- (?:inputs: [^>]*|end of inputs) -->\n/gm, '')
    .replace(/ ?<!-- (?:inputs: [^>]*|end of inputs) -->/g, '');

// The same tables; the name of each that is read goes into `read`.
const watched = (tables, read) =>
  new Proxy(tables, {
    get(all, name) {
      if (typeof name === 'string' && Object.hasOwn(all, name)) read.add(name);
      return all[name];
    },
  });

// [{page, text, tables}], every page as it must be, and the tables that it was made from.
export function written_pages(root) {
  const warnings = [];
  const tables = all_objects(load_results(join(root, 'results'), (text) => warnings.push(text)));
  if (warnings.length > 0) throw new InputError(warnings.join('\n'));
  const problems = [];
  const pages = page_files(root).map(({ name, template, page }) => {
    const text = readFileSync(join(root, template), 'utf8');
    problems.push(...untraced(template, text));
    const read = new Set();
    const filled = without_marks(
      fill(text, template, answers(watched(tables, read), root)),
    ).trimEnd();
    const source = provenance([...read], root);
    return {
      page,
      text: `${made_from(name)}${filled}\n${source === '' ? '' : `\n${source}\n`}`,
      tables: [...read].sort(),
    };
  });
  if (problems.length > 0) throw new InputError(problems.join('\n'));
  return pages;
}
