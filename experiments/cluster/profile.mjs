// What a user's cluster asks for: a file of lines `key = value`, # begins a comment.
import { InputError, read_text } from '../report/src/input.mjs';

const keys = {
  partition: 'text', // of Slurm
  account: 'text',
  qos: 'text',
  options: 'text', // further options of sbatch, as in --constraint=avx512 --exclude=n7
  setup: 'text', // a line of shell before each part, as in module load gcc/12
  minutes: 'number', // of a part, instead of the pilot's estimate
  memory_mb: 'number', // of a part, instead of the pilot's estimate
  most_tasks: 'number', // parts of a sweep, at most
};
const none = { most_tasks: 1000 };

function value_of(text, kind, place) {
  const quoted = text.match(/^"([^"\\]*)"$/);
  if (kind === 'text' && quoted) return quoted[1];
  if (kind === 'number' && /^[1-9][0-9]*$/.test(text)) return Number(text);
  const wanted = kind === 'text' ? 'a text in quotes' : 'a whole number above 0';
  throw new InputError(`${place}: ${text} is not ${wanted}; write it so`);
}

export function read_profile(file) {
  if (file === undefined) return none;
  const profile = { ...none };
  const given = new Set();
  read_text(file, 2 ** 16)
    .split('\n')
    .forEach((line, i) => {
      const place = `${file}:${i + 1}`;
      const text = line.replace(/^\s+|\s+$/g, '');
      if (text === '' || text.startsWith('#')) return;
      const [, key, value] = text.match(/^(\w+)\s*=\s*("[^"]*"|\S+)\s*(?:#.*)?$/) ?? [];
      if (key === undefined)
        throw new InputError(`${place}: not 'key = value'; as in partition = "short"`);
      if (!(key in keys))
        throw new InputError(
          `${place}: no key '${key}'; there are ${Object.keys(keys).join(', ')}`,
        );
      if (given.has(key))
        throw new InputError(`${place}: '${key}' is set twice; set it once`);
      given.add(key);
      profile[key] = value_of(value, keys[key], place);
    });
  return profile;
}
