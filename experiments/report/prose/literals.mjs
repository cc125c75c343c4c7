// The texts that a JavaScript source prints: its string literals, where `${...}` is a slot.
const escapes = /\\(?:u\{?[0-9a-fA-F]+\}?|x[0-9a-fA-F]{2}|[\s\S])/g;

// The place after a regular expression.
function after_regex(source, start) {
  let in_class = false;
  let i = start + 1;
  for (; source[i] !== '/' || in_class; ++i) {
    if (source[i] === '\\') ++i;
    else if (source[i] === '[') in_class = true;
    else if (source[i] === ']') in_class = false;
  }
  return i + 1;
}

// Reads source[at...] up to `end` (a quote, or '}' of a slot), and returns the place after
// it; every literal on the way goes into `found`.
function read_code(source, at, end, found) {
  let i = at;
  while (i < source.length && source[i] !== end) {
    const two = source.slice(i, i + 2);
    if (two === '//') i = source.indexOf('\n', i) + 1 || source.length;
    else if (two === '/*') i = source.indexOf('*/', i) + 2;
    else if (/['"`]/.test(source[i])) i = read_literal(source, i, found);
    else if (source[i] === '/' && /(^|[(,=:[!&|?{};>])\s*$/.test(source.slice(at, i)))
      i = after_regex(source, i);
    else if (source[i] === '{') i = read_code(source, i + 1, '}', found);
    else i += 1;
  }
  return i + 1;
}

function read_literal(source, start, found) {
  const quote = source[start];
  let text = '';
  let i = start + 1;
  while (i < source.length && source[i] !== quote) {
    if (source[i] === '\\') {
      text += source.slice(i, i + 2);
      i += 2;
    } else if (quote === '`' && source.startsWith('${', i)) {
      text += '{{ }}';
      i = read_code(source, i + 2, '}', found);
    } else {
      text += source[i];
      i += 1;
    }
  }
  found.push({ index: start, text: text.replace(escapes, (one) => (one === '\\`' ? '`' : ' ')) });
  return i + 1;
}

// [{line, text}] of all literals with more than one word: the others are names.
export function literals(source) {
  const found = [];
  read_code(source, 0, undefined, found);
  return found
    .filter(({ text }) => /\S\s+\S/.test(text.replaceAll('{{ }}', 'x')))
    .sort((a, b) => a.index - b.index)
    .map(({ index, text }) => ({ line: source.slice(0, index).split('\n').length, text }));
}
