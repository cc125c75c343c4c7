// same_rows.mjs ONE OTHER: are two tables the same text, in the same order, but for the
// columns that the manifest calls timings?
import { readFileSync } from 'node:fs';
import { parse_csv } from '../../experiments/report/src/csv.mjs';

function lasting(file) {
  const { timings } = JSON.parse(readFileSync(file.replace(/csv$/, 'meta.json'), 'utf8'));
  const { columns, rows } = parse_csv(readFileSync(file, 'utf8'), file);
  const kept = columns
    .map(({ name }, i) => [name, i])
    .filter(([name]) => !timings.includes(name));
  return [
    kept.map(([name]) => name),
    ...rows.map((row) => kept.map(([, i]) => row[i])),
  ].map((cells) => JSON.stringify(cells));
}

const [one, other] = process.argv.slice(2).map(lasting);
const first = one.findIndex((line, i) => line !== other[i]);
if (one.length !== other.length || first >= 0) {
  console.log(
    `${one.length - 1} and ${other.length - 1} rows; first difference in line ${first + 1}:`,
  );
  console.log(`${one[first]}\n${other[first]}`);
  process.exit(1);
}
console.log(`${one.length - 1} rows are the same`);
