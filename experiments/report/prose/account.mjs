// account.mjs [ROOT]: every number and number word of every page by its origin, and those
// that no query, definition or input accounts for. A page that differs from templates and
// tables counts as well: its numbers are not those of the tables.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { InputError } from '../src/input.mjs';
import { page_files, text_sources, untraced, untraced_literals, written_by_hand, written_pages } from './pages.mjs';
import { counted } from './template.mjs';

const usage = `usage: node account.mjs [ROOT]
  ROOT  the repository (default: the one that holds this program)
Prints for every page how many numbers come from queries, from regions of inputs and from
the list of definitions. Exit code 3 when one is unaccounted for or a page is out of date.`;

// [{page, slots, inputs, allowed, tables, problems}] of all pages and sources of texts.
export function account(root) {
  const read = (path) => readFileSync(join(root, path), 'utf8');
  const made = new Map(written_pages(root).map((one) => [one.page, one]));
  const from_templates = page_files(root).map(({ template, page }) => {
    const { text, tables } = made.get(page);
    const stale = existsSync(join(root, page)) && read(page) !== text;
    return {
      page,
      ...counted(read(template)),
      tables,
      problems: stale ? [`${page}: differs from templates and tables; run: ./tress report`] : [],
    };
  });
  const by_hand = written_by_hand.map((page) => ({
    page,
    ...counted(read(page)),
    tables: [],
    problems: untraced(page, read(page)),
  }));
  const sources = text_sources(root).map((page) => ({
    page,
    slots: 0,
    inputs: 0,
    allowed: 0,
    tables: [],
    problems: untraced_literals(page, read(page)),
  }));
  return [...from_templates, ...by_hand, ...sources];
}

function main(argv) {
  if (argv.includes('--help') || argv.includes('-h')) {
    console.log(usage);
    return;
  }
  const root = argv[0] ?? fileURLToPath(new URL('../../..', import.meta.url));
  const all = account(root);
  console.log('page: queries, inputs, definitions, unaccounted; tables');
  for (const { page, slots, inputs, allowed, tables, problems } of all)
    console.log(`${page}: ${slots}, ${inputs}, ${allowed}, ${problems.length}; ${tables.join(' ')}`);
  const problems = all.flatMap((one) => one.problems);
  problems.forEach((text) => console.error(text));
  console.log(`${problems.length} unaccounted on ${all.length} pages and sources of texts`);
  if (problems.length > 0) process.exitCode = 3;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  try {
    main(process.argv.slice(2));
  } catch (error) {
    if (!(error instanceof InputError)) throw error;
    console.error(`account: ${error.message}`);
    process.exitCode = 2;
  }
}
