// Templates: Markdown in which {{ page.query }} stands for what the query says of the
// tables, and no number is typed by hand.
import { InputError } from '../src/input.mjs';
import { allowed } from './allowed.mjs';

const slot = /\{\{\s*([\w.]+)\s*\}\}/g;

const line_of = (text, index) => text.slice(0, index).split('\n').length;

// The template with every slot filled. `answer(name)` returns a text or throws; what it
// says is wrong comes with file and line.
export function fill(template, file, answer) {
  return template.replace(slot, (whole, name, index) => {
    try {
      return answer(name);
    } catch (error) {
      throw new InputError(
        `${file}:${line_of(template, index)}: {{ ${name} }}: ${error.message}`,
      );
    }
  });
}

const blank = (text) => text.replace(/[^\n]/g, ' ');

// Not prose: slots, code, comments, targets of links.
const set_apart = [
  slot,
  /^```[\s\S]*?^```/gm,
  /<!--[\s\S]*?-->/g,
  /`[^`\n]*`/g,
  /\]\([^)\n]*\)/g,
];

// Where the template's own prose has a number that nobody computed: [{line, text}].
export function untraced_numbers(template) {
  const prose = [...set_apart, ...allowed.map(({ text }) => text)].reduce(
    (text, pattern) => text.replaceAll(pattern, blank),
    template,
  );
  return [...prose.matchAll(/\S*\d\S*/g)].map((match) => ({
    line: line_of(prose, match.index),
    text: match[0],
  }));
}
