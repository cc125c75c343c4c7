// CSV reader: RFC 4180 quotes, header row, '.' decimal. Every complaint names file and
// line, and what to do.
import { InputError } from './input.mjs';

const remedy = 'run the experiment again or remove the file';

// A field as a message quotes it: on one line, not longer than that.
const shortened = (field) => {
  const text = field.replace(/\s+/g, ' ');
  return text.length > 40 ? `${text.slice(0, 37)}...` : text;
};

// Splits `text` into records of {line, fields}; blank lines are skipped.
function records(text, refuse) {
  const out = [];
  let fields = [],
    field = '',
    line = 1,
    start = 1,
    quoted = false,
    was_quoted = false;
  const end_record = () => {
    fields.push(field);
    if (fields.length > 1 || field !== '' || was_quoted)
      out.push({ line: start, fields });
    fields = [];
    field = '';
    was_quoted = false;
  };
  for (let i = 0; i < text.length; ++i) {
    const c = text[i];
    if (c === '\n') ++line;
    if (quoted) {
      if (c !== '"') field += c;
      else if (text[i + 1] === '"') field += text[++i];
      else quoted = false;
    } else if (c === '"' && field === '') {
      quoted = was_quoted = true;
    } else if (c === ',') {
      fields.push(field);
      field = '';
    } else if (c === '\n') {
      end_record();
      start = line;
    } else if (c !== '\r') {
      field += c;
    }
  }
  if (quoted) throw refuse(start, 'a quote is opened and never closed');
  end_record();
  return out;
}

const special = { nan: 'nan', '-nan': 'nan', inf: 'inf', '+inf': 'inf', '-inf': '-inf' };
const number_pattern = /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/;

// A finite number, null for an empty field, 'nan' / 'inf' / '-inf', or undefined.
export function parse_number(text) {
  const trimmed = text.trim();
  if (trimmed === '') return null;
  if (number_pattern.test(trimmed)) {
    const value = Number(trimmed);
    return Number.isFinite(value) ? value : value > 0 ? 'inf' : '-inf';
  }
  return special[trimmed.toLowerCase()];
}

// {columns: [{name, numeric}], rows: [[...]]}. `required` columns must exist; columns in
// `numeric` must hold numbers; the other required ones are text, whatever they hold; any
// other column is numeric when all its fields are.
export function parse_csv(text, file, { required = [], numeric = [] } = {}) {
  const refuse = (line, what) => new InputError(`${file}:${line}: ${what}; ${remedy}`);
  const all = records(text.replace(/^\uFEFF/, ''), refuse);
  if (all.length === 0) throw refuse(1, 'empty, expected a header row');
  const names = all[0].fields.map((name) => name.trim());
  const duplicate = names.find((name, i) => names.indexOf(name) !== i);
  if (duplicate !== undefined) throw refuse(1, `column '${shortened(duplicate)}' appears twice`);
  const missing = required.filter((name) => !names.includes(name));
  if (missing.length > 0)
    throw refuse(1, `column '${missing[0]}' is missing from the header`);
  const body = all.slice(1);
  for (const { line, fields } of body) {
    if (fields.length !== names.length)
      throw refuse(line, `${fields.length} fields where the header has ${names.length}`);
  }
  const columns = names.map((name, i) => ({
    name,
    numeric:
      numeric.includes(name) ||
      (!required.includes(name) &&
        body.some(({ fields }) => fields[i].trim() !== '') &&
        body.every(({ fields }) => parse_number(fields[i]) !== undefined)),
  }));
  const rows = body.map(({ line, fields }) =>
    fields.map((field, i) => {
      if (!columns[i].numeric) return field;
      const value = parse_number(field);
      if (value === undefined)
        throw refuse(line, `'${shortened(field)}' in column '${names[i]}' is not a number`);
      return value;
    }),
  );
  return { columns, rows };
}
