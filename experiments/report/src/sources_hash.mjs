// Hash over everything that decides what the bundles in dist/ contain. It is written into each
// bundle; tests/report compares it with the sources, so a stale bundle is caught without npm.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

const roots = ['.npmrc', 'build.mjs', 'figures', 'package-lock.json', 'package.json', 'src'];

function files_under(base, relative) {
  const entries = readdirSync(join(base, relative), { withFileTypes: true });
  return entries.flatMap((entry) => {
    const path = `${relative}/${entry.name}`;
    return entry.isDirectory() ? files_under(base, path) : [path];
  });
}

export function sources_hash(base) {
  const files = roots
    .flatMap((root) => (/^(figures|src)$/.test(root) ? files_under(base, root) : [root]))
    .sort();
  const hash = createHash('sha256');
  for (const file of files) {
    hash.update(`${file}\n`).update(readFileSync(join(base, file))).update('\n');
  }
  return hash.digest('hex');
}
