// skips.mjs EXPECTED.csv SHARD.xml...: which cases of the contract suite were skipped, by
// test and reason, over all shards, against the table of those that are meant to be. A
// contract that a model no longer keeps to, or a new one that nobody tests, would
// otherwise be one more skip among hundreds. With --rewrite first the table is written.
import { readFileSync, writeFileSync } from 'node:fs';

const rewrite = process.argv[2] === '--rewrite';
const [table, ...shards] = process.argv.slice(rewrite ? 3 : 2);

const plain = (text) =>
  text
    .replace(/&#x0A;/gi, '\n')
    .replace(/&quot;/g, '"')
    .replace(/&apos;/g, "'")
    .replace(/&lt;/g, '<')
    .replace(/&gt;/g, '>')
    .replace(/&amp;/g, '&');

// 'test,reason' -> number of cases
function counted(files) {
  const counts = new Map();
  let cases = 0;
  for (const file of files) {
    for (const [, name, body] of readFileSync(file, 'utf8').matchAll(
      /<testcase name="([^"]*)"[^>]*?(?:\/>|>(.*?)<\/testcase>)/gs,
    )) {
      cases += 1;
      const skipped = /<skipped message="([^"]*)"/.exec(body ?? '');
      if (skipped === null) continue;
      // "file:line\nreason"; the name is Test/parameter.
      const reason = plain(skipped[1]).split('\n').slice(1).join(' ').trim();
      const key = `${name.split('/')[0]},${reason}`;
      counts.set(key, (counts.get(key) ?? 0) + 1);
    }
  }
  return { counts, cases };
}

function expected() {
  const lines = readFileSync(table, 'utf8').trim().split('\n').slice(1);
  return new Map(
    lines.map((line) => {
      const end = line.lastIndexOf(',');
      return [line.slice(0, end), Number(line.slice(end + 1))];
    }),
  );
}

const { counts, cases } = counted(shards);
const keys = [...counts.keys()].sort();
if (rewrite) {
  const lines = keys.map((key) => `${key},${counts.get(key)}`);
  writeFileSync(table, ['test,reason,cases', ...lines, ''].join('\n'));
}
const known = expected();
let wrong = 0;
let skipped = 0;
for (const key of [...new Set([...keys, ...known.keys()])].sort()) {
  const now = counts.get(key) ?? 0;
  const meant = known.get(key) ?? 0;
  skipped += now;
  if (now !== meant) wrong += 1;
  const differs = now === meant ? '' : `  NOT AS EXPECTED: ${meant}`;
  console.log(`${String(now).padStart(5)}  ${key.replace(',', ': ')}${differs}`);
}
console.log(`${skipped} of ${cases} cases skipped`);
if (wrong > 0) {
  console.log(`look at each difference; then: node ${process.argv[1]} --rewrite ${table} ` +
    shards.join(' '));
}
process.exit(wrong > 0 || cases === 0 ? 1 : 0);
