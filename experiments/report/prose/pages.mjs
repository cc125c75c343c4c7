// Every page made from a template, and the answers to its slots.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { all_objects } from '../src/objects.mjs';
import { InputError } from '../src/input.mjs';
import { load_results } from '../src/load.mjs';
import { queries } from './queries/all.mjs';
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

// Where a template names a number that no query computed.
export function untraced(file, template) {
  return untraced_numbers(template).map(
    ({ line, text }) =>
      `${file}:${line}: '${text}' is typed by hand; compute it with {{ page.query }}, or add ` +
      'the definition or input that it is to experiments/report/prose/allowed.mjs',
  );
}

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

// [{page, text}], every page as it must be.
export function written_pages(root) {
  const warnings = [];
  const tables = all_objects(load_results(join(root, 'results'), (text) => warnings.push(text)));
  if (warnings.length > 0) throw new InputError(warnings.join('\n'));
  const answer = answers(tables, root);
  const problems = [];
  const pages = page_files(root).map(({ name, template, page }) => {
    const text = readFileSync(join(root, template), 'utf8');
    problems.push(...untraced(template, text));
    return { page, text: made_from(name) + fill(text, template, answer) };
  });
  if (problems.length > 0) throw new InputError(problems.join('\n'));
  return pages;
}
