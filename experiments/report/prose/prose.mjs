// prose.mjs [--check] [ROOT]: README.md, results/README.md and docs/ from docs/templates/
// and results/*.csv. --check writes nothing and fails when a page is not what templates
// and tables say.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { InputError } from '../src/input.mjs';
import { written_pages } from './pages.mjs';

const usage = `usage: node prose.mjs [--check] [ROOT]
  ROOT     the repository (default: the one that holds this program)
  --check  writes nothing; exit code 3 when a page differs from templates and tables`;

// The first line in which two texts differ, as a message.
function difference(page, is, should) {
  const [a, b] = [is, should].map((text) => text.split('\n'));
  const at = b.findIndex((line, i) => line !== a[i]);
  const line = at < 0 ? b.length : at;
  return (
    `${page}:${line + 1}: says "${a[line] ?? ''}", tables and template say ` +
    `"${b[line] ?? ''}"; run: ./tress report`
  );
}

function main(argv) {
  if (argv.includes('--help') || argv.includes('-h')) {
    console.log(usage);
    return;
  }
  const unknown = argv.find((word) => word.startsWith('-') && word !== '--check');
  if (unknown !== undefined) throw new InputError(`${unknown}: unknown option; see --help`);
  const check = argv.includes('--check');
  const root =
    argv.find((word) => !word.startsWith('-')) ??
    fileURLToPath(new URL('../../..', import.meta.url));
  const pages = written_pages(root);
  const stale = pages.filter(
    ({ page, text }) =>
      !existsSync(join(root, page)) || readFileSync(join(root, page), 'utf8') !== text,
  );
  if (check) {
    for (const { page, text } of stale) {
      const file = join(root, page);
      console.error(difference(page, existsSync(file) ? readFileSync(file, 'utf8') : '', text));
    }
    if (stale.length > 0) process.exitCode = 3;
    return;
  }
  for (const { page, text } of stale) {
    mkdirSync(dirname(join(root, page)), { recursive: true });
    writeFileSync(join(root, page), text);
  }
  console.error(`prose: ${pages.length} pages, ${stale.length} of them changed`);
}

try {
  main(process.argv.slice(2));
} catch (error) {
  if (!(error instanceof InputError)) throw error;
  console.error(`prose: ${error.message}`);
  process.exitCode = 2;
}
