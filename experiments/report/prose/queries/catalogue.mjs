// The list that every experiment prints with --list, as committed.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

export const snapshot = 'docs/templates/catalogue.txt';

export const list = (_, root) => {
  const text = readFileSync(join(root, snapshot), 'utf8').trimEnd();
  return `\`\`\`text\n${text}\n\`\`\``;
};
