// Templates: Markdown in which {{ page.query }} stands for what the query computes from the
// tables, and no number or number word is typed by hand.
import { InputError } from '../src/input.mjs';
import { allowed } from './allowed.mjs';
import { number_words } from './number_words.mjs';

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

// A region of definitions and settings, which names its reason.
const inputs = /<!-- inputs: \S[^>]*-->[\s\S]*?<!-- end of inputs -->/g;

// Not prose: inputs, code, comments, targets of links.
const set_apart = [
  inputs,
  /^```[\s\S]*?^```/gm,
  /<!--[\s\S]*?-->/g,
  /`[^`\n]*`/g,
  /\]\([^)\n]*\)/g,
];

const is_number = /\S*\d\S*/g;
const without = (patterns, text) =>
  patterns.reduce((rest, pattern) => rest.replaceAll(pattern, blank), text);
// A slot stays as braces: "about {{ }}" is an estimate of what a query computed.
const prose_of = (template) =>
  without(set_apart, template.replace(slot, (whole) => `{{${' '.repeat(whole.length - 4)}}}`));
const amounts_in = (text) =>
  [...text.matchAll(is_number), ...text.matchAll(number_words)].sort((a, b) => a.index - b.index);

// Where prose has a number or a number word that nobody computed and nothing allows:
// [{line, text}].
export function untraced_numbers(template) {
  const prose = without(
    allowed.map(({ text }) => text),
    prose_of(template),
  );
  return amounts_in(prose).map((match) => ({
    line: line_of(prose, match.index),
    text: match[0].trim(),
  }));
}

// How many slots a text has, and how many amounts stand in regions of inputs and are allowed.
export const counted = (template) => ({
  slots: [...template.matchAll(slot)].length,
  inputs: [...template.matchAll(inputs)].reduce(
    (sum, [region]) => sum + amounts_in(without([/<!--[\s\S]*?-->/g, /`[^`\n]*`/g], region)).length,
    0,
  ),
  allowed: amounts_in(prose_of(template)).length - untraced_numbers(template).length,
});
