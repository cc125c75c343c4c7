// The command lines that the pages tell their readers to type.
//
//   node page_commands.mjs ROOT PAGE [PATTERN]   those of a page, one a line, that match
//
// They stand in fences without a language: text, scenes and sources in fences have one.
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

/// Every page of Markdown but templates and what tests read, relative to the repository.
export function pages(root) {
  const found = [];
  const look = (folder) => {
    for (const entry of readdirSync(join(root, folder), { withFileTypes: true })) {
      const path = folder === '' ? entry.name : `${folder}/${entry.name}`;
      if (entry.isDirectory()) {
        if (!/^(build|node_modules|templates|tests|\..*)$/.test(entry.name)) look(path);
      } else if (entry.name.endsWith('.md')) {
        found.push(path);
      }
    }
  };
  look('');
  return found.sort();
}

const begins_command = /^\s*(\.\/tress|build\/|experiments\/\S+\.sh|cmake|mpirun|node) /;

/// [{page, line, text, output}] of a page's text; `output`: the lines of a fence
/// ```text output that follows, which the command prints. Throws Error on an open fence, and on a command
/// that is set apart by spaces and so would not be found.
export function commands_of(page, text) {
  const found = [];
  let fence; // its language
  for (const [i, content] of text.split('\n').entries()) {
    const place = `${page}:${i + 1}`;
    const mark = /^\s*```(.*)$/.exec(content);
    if (mark) {
      fence = fence === undefined ? mark[1].trim() : undefined;
      if (fence === 'text output' && found.length === 0)
        throw new Error(`${place}: output of no command`);
    } else if (fence === 'text output') {
      found.at(-1).output.push(content);
    } else if (fence === '' && content.trim() !== '') {
      if (!/^[\w./]/.test(content)) {
        throw new Error(
          `${place}: no command; give the fence a language, as in \`\`\`text`,
        );
      }
      found.push({ page, line: i + 1, text: content, output: [] });
    } else if (
      fence === undefined &&
      /^ {4}/.test(content) &&
      begins_command.test(content)
    ) {
      throw new Error(`${place}: put the command into a fence, where its test finds it`);
    }
  }
  if (fence !== undefined) throw new Error(`${page}: a fence without an end`);
  return found;
}

export const page_commands = (root, page) =>
  commands_of(page, readFileSync(join(root, page), 'utf8'));

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [root, page, pattern = ''] = process.argv.slice(2);
  const found = page_commands(root, page).filter(({ text }) =>
    new RegExp(pattern).test(text),
  );
  if (found.length === 0)
    throw new Error(`${page} has no command that matches '${pattern}'`);
  for (const { text } of found) console.log(text);
}
