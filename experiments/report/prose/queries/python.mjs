// The Python module's public names, from its sources: signatures and docstrings.
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { table } from '../markdown.mjs';

const folder = 'python/tress';

// What the compiled part provides has no docstring there.
const compiled = {
  load_plugin: 'load_plugin(file): loads the models, integrators and effects of a plug-in; call it first',
  scene_defaults: 'scene_defaults(): a short scene to start from, as text',
  scene_schema: 'scene_schema(): the page scenes/README.md, as text',
}; // prettier-ignore

const indent_of = (line) => /^ */.exec(line)[0].length;

// The docstring that begins at this line, without its indentation; '': none does.
function docstring(lines, at) {
  const open = /^\s*"""(.*)$/.exec(lines[at] ?? '');
  if (!open) return '';
  if (open[1].endsWith('"""')) return open[1].slice(0, -3);
  const rest = [];
  let i = at + 1;
  for (; !lines[i].trimEnd().endsWith('"""'); ++i) rest.push(lines[i]);
  rest.push(lines[i].trimEnd().slice(0, -3));
  const indent = indent_of(lines[at]);
  return [open[1], ...rest.map((line) => line.slice(indent))].join('\n').trimEnd();
}

// Classes, functions and methods without an underscore: [{kind, name, signature, text,
// owner}], methods after their class.
export function names_of(source) {
  const lines = source.split('\n');
  const found = [];
  let owner;
  lines.forEach((line, i) => {
    const match = /^( {4})?(class|def) (\w+)(.*)$/.exec(line);
    if (line !== '' && indent_of(line) === 0 && !/^[)\]}#@"]/.test(line))
      owner = undefined;
    if (!match) return;
    const [, inner, kind, name] = match;
    if (kind === 'class') owner = name;
    if (inner && owner === undefined) return;
    let end = i;
    while (!lines[end].trimEnd().endsWith(':')) ++end;
    const whole = lines
      .slice(i, end + 1)
      .map((part) => part.trim())
      .join(' ');
    const property = lines[i - 1]?.trim() === '@property';
    const signature = whole
      .replace(/^(class|def) /, '')
      .replace(/:$/, '')
      .replace(/\( /, '(')
      .replace(/,? \)$/, ')')
      .replace(/\((self|cls)(, )?/, '(');
    if (!name.startsWith('_'))
      found.push({
        name,
        signature: kind === 'class' || property ? name : signature,
        text: docstring(lines, end + 1),
        owner: inner ? owner : undefined,
      });
  });
  return found;
}

const public_names = (root) =>
  [
    .../__all__ = \[([^\]]*)\]/
      .exec(readFileSync(join(root, folder, '__init__.py'), 'utf8'))[1]
      .matchAll(/"(\w+)"/g),
  ].map(([, name]) => name);

const fenced = (text) => `\`\`\`text\n${text}\n\`\`\``;
const one_line = (text) => text.replace(/\s+/g, ' ').replaceAll('``', '`');

// A section for each name of __all__: its docstring, and of a class a table of its methods.
export const api = (_, root) => {
  const all = readdirSync(join(root, folder))
    .filter((file) => file.endsWith('.py'))
    .sort()
    .flatMap((file) => names_of(readFileSync(join(root, folder, file), 'utf8')));
  return public_names(root)
    .map((name) => {
      const at = all.find((one) => one.name === name && one.owner === undefined);
      if (at === undefined && compiled[name] === undefined)
        throw new Error(`${folder}: nothing defines ${name}`);
      const text = at?.text ?? compiled[name];
      if (text === '') throw new Error(`${folder}: ${name} has no docstring`);
      const methods = all
        .filter(({ owner }) => owner === name)
        .map((one) => [`\`${one.signature}\``, one_line(one.text)]);
      return [
        `## \`${at?.signature ?? name}\``,
        fenced(text),
        ...(methods.length > 0 ? [table(['', ''], methods)] : []),
      ].join('\n\n');
    })
    .join('\n\n');
};
