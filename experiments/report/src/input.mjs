// Reads files of a results directory. Every complaint is one line: file, problem, remedy.
import { readFileSync, statSync } from 'node:fs';

export class InputError extends Error {}

// Of one file, and of all scenes together: a page is one text, which must stay below the
// longest that browsers and node take (some 512 MiB).
const mebibyte = 2 ** 20;
export const size_limit = 256 * mebibyte;

const kind_of = (stat) => (stat.isDirectory() ? 'a folder' : 'not a regular file');

// The text of a regular UTF-8 file of bounded size; a byte order mark is dropped.
export function read_text(path, limit = size_limit) {
  let bytes;
  try {
    const stat = statSync(path);
    if (!stat.isFile())
      throw new InputError(`${path}: ${kind_of(stat)}; rename or remove it`);
    if (stat.size > limit)
      throw new InputError(
        `${path}: ${Math.ceil(stat.size / mebibyte)} MiB, more than the ` +
          `${Math.floor(limit / mebibyte)} MiB left for it in a page; write fewer rows or frames`,
      );
    bytes = readFileSync(path);
  } catch (error) {
    if (error instanceof InputError) throw error;
    throw new InputError(`${path}: cannot be read (${error.code}); mend or remove it`);
  }
  let text;
  try {
    text = new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    text = '\0';
  }
  if (text.includes('\0'))
    throw new InputError(`${path}: not UTF-8 text; write it again or remove it`);
  return text;
}

export function read_json(path, limit) {
  const text = read_text(path, limit);
  try {
    return JSON.parse(text);
  } catch (error) {
    const [why] = error.message.split('\n');
    throw new InputError(`${path}: not valid JSON (${why}); write it again or remove it`);
  }
}

// `make()`, or undefined after a warning about `table` (may be missing) when it throws an
// InputError.
export function read_or_warn(make, warn, table) {
  try {
    return make();
  } catch (error) {
    if (!(error instanceof InputError)) throw error;
    warn(error.message, table);
    return undefined;
  }
}
