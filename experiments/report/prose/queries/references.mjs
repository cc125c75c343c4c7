// Sources that headers, catalogues, tests and scenes cite, gathered from their texts.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { parse_csv } from '../../src/csv.mjs';
import { InputError } from '../../src/input.mjs';
import { table } from '../markdown.mjs';

const folders = ['math', 'contract', 'linear', 'models', 'integrators', 'simulation', 'experiments'];
const published = 'results/peers_published.csv'; // its column cited_as
const bibliography = 'docs/templates/references.txt';
const year = '(?:1[6-9]|20)\\d\\d';

// Headers, sources, scenes and the report's programs, relative to the repository.
function files(root) {
  const list = (folder, ending) =>
    readdirSync(join(root, folder), { withFileTypes: true })
      .sort((a, b) => (a.name < b.name ? -1 : 1))
      .flatMap((entry) => {
        const path = `${folder}/${entry.name}`;
        if (entry.isDirectory()) return entry.name === 'report' ? [] : list(path, ending);
        return ending.test(entry.name) ? [path] : [];
      });
  return [...folders.flatMap((folder) => list(folder, /\.(h|cpp)$/)), ...list('scenes', /\.toml$/),
    ...list('experiments/report/src', /\.mjs$/)];
}

// What is cited in one file: in brackets in comments, as the source of a published test or
// of a scene, and as that of a line of a catalogue.
function cited(path, text) {
  const joined = text.replace(/\n\s*\/\/\/? ?/g, ' ').replace(/"\s*\n\s*"/g, '');
  const of = (pattern) => [...joined.matchAll(pattern)].map((match) => match[1]);
  const brackets = path.endsWith('.toml') ? [] : of(new RegExp(`\\[([A-Z][^\\[\\]]{3,150}${year}[^\\[\\]]{0,80})\\]`, 'g'));
  const sources = of(/\bsource = "([^"]+)"/g);
  const lines = path.endsWith('catalogue.cpp') ? of(new RegExp(`"([A-Z][^"]*\\b${year}\\b[^"]*)"`, 'g')) : [];
  return [...brackets, ...sources, ...lines].flatMap((all) => all.split(';'));
}

// What the published figures of other simulators cite.
function cited_by_figures(root) {
  const { columns, rows } = parse_csv(readFileSync(join(root, published), 'utf8'), published);
  const at = columns.findIndex(({ name }) => name === 'cited_as');
  return rows.map((row) => row[at] ?? '');
}

// "Bergou et al. 2008, 2010, eq. 3" -> two of {authors, year, place}; none where it has no
// author and year.
export function citations(text) {
  const authors = `[A-Z][\\p{L}.&,' -]*?`;
  const found = text.replace(/\s+/g, ' ').trim().match(new RegExp(`((?:(?:van der|von|de|den) )?${authors}),? (${year}(?:, ${year})*)(.*)$`, 'u'));
  if (found === null) return [];
  const [, who, years, place] = found;
  return years.split(', ').map((one) => ({ authors: who.trim(), year: one,
    place: place.replace(/^[,:]? */, '').trim() }));
}

// By which the same publication is known: catalogues write Chung-Hulbert.
const surname = (authors) => authors.match(/\p{Lu}\p{L}+/u)?.[0] ?? authors;

// Publications by surname and year, and the line on which each stands.
export function works(text) {
  const lines = text.split('\n').map((line, i) => [line, i + 1]).filter(([line]) => line !== '' && !line.startsWith('#'));
  return new Map(lines.map(([line, number]) => {
    const [key, work, ...rest] = line.split('\t');
    if (work === undefined || rest.length > 0) throw new InputError(`${bibliography}:${number}: expected "Surname year<tab>publication"`);
    return [key, work];
  }));
}

// Citations without a publication, or publications that nothing cites, as an error.
export function match(cited_keys, known) {
  const missing = cited_keys.filter((key) => !known.has(key));
  const unused = [...known.keys()].filter((key) => !cited_keys.includes(key));
  if (missing.length > 0) throw new InputError(`${bibliography}: nothing stands there for ${missing.join(', ')}: add a line`);
  if (unused.length > 0) throw new InputError(`${bibliography}: nothing cites ${unused.join(', ')}: remove the line`);
}

export function list(_, root) {
  const all = new Map();
  const places = [
    ...files(root).map((path) => [path, cited(path, readFileSync(join(root, path), 'utf8'))]),
    [published, cited_by_figures(root)],
  ];
  for (const [path, texts] of places) {
    for (const text of texts) {
      for (const { authors, year: when } of citations(text)) {
        const key = `${surname(authors)} ${when}`;
        const entry = all.get(key) ?? { authors, when, where: new Set() };
        if (authors.length > entry.authors.length) entry.authors = authors;
        entry.where.add(`\`${path}\``);
        all.set(key, entry);
      }
    }
  }
  const known = works(readFileSync(join(root, bibliography), 'utf8'));
  match([...all.keys()], known);
  const rows = [...all].sort(([a], [b]) => a.localeCompare(b, 'en'))
    .map(([key, { authors, when, where }]) => [`${authors} ${when}`, known.get(key), [...where].join(', ')]);
  return table(['cited as', 'publication', 'cited in'], rows);
}
