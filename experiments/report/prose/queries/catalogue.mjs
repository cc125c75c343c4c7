// The list that every experiment prints with --list, as committed.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { rows_of } from '../markdown.mjs';

export const snapshot = 'docs/templates/catalogue.txt';

const text_of = (root) => readFileSync(join(root, snapshot), 'utf8').trimEnd();

// How many names the part of the list under this heading has.
const names_under = (root, heading) => {
  const after = text_of(root).split(new RegExp(`^${heading}.*$`, 'm'))[1];
  const part = after.split(/^[A-Z]/m)[0];
  return String([...part.matchAll(/^ {2}\w/gm)].length);
};

export const integrators = (_, root) => names_under(root, 'INTEGRATORS');

export const strand_models = (tables) =>
  String(new Set(rows_of(tables, 'validation').map((row) => row.model)).size);

export const list = (_, root) => {
  const text = text_of(root);
  return `\`\`\`text\n${text}\n\`\`\``;
};
