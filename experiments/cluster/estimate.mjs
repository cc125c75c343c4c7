// What sweeps of all rows take: core hours from some of their rows, as a table.
import { existsSync, mkdtempSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { read_text } from '../report/src/input.mjs';
import { core_hours, pilot, usual_parts } from './sweep.mjs';

const columns = [
  'experiment',
  'rows',
  'timed_rows', // spread over all
  'cut_off_rows', // of these, which ran into the timeout: what they take is more
  'row_s',
  'plan_s', // of every part
  'parts', // of about a quarter of an hour
  'core_hours',
  'memory_mb',
];

function measured(sweep, say) {
  const folder = mkdtempSync(join(tmpdir(), 'tress-estimate-'));
  try {
    const known = pilot({ ...sweep, folder }, (text) => say(`${sweep.experiment}: ${text}`));
    const parts = usual_parts(known, { most_tasks: 1000 });
    return {
      experiment: sweep.experiment,
      rows: known.rows,
      timed_rows: known.timed,
      cut_off_rows: known.cut_off,
      row_s: known.row_s.toPrecision(3),
      plan_s: known.plan_s.toPrecision(3),
      parts,
      core_hours: core_hours(known, parts).toPrecision(3),
      memory_mb: Math.ceil(known.largest_mb),
    };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/// Lines of an earlier table, by experiment.
function known_lines(file) {
  if (!existsSync(file)) return new Map();
  const [header, ...lines] = read_text(file, 2 ** 20).trim().split('\n');
  if (header !== columns.join(',')) return new Map();
  return new Map(lines.map((line) => [line.split(',')[0], line]));
}

/// Of each sweep, { experiment, program, args, repository }; says each, and writes `file`,
/// in which other experiments keep their lines.
export function write_estimates(all, file, say) {
  const lines = known_lines(file);
  for (const sweep of all) {
    const row = measured(sweep, say);
    say(
      `${row.experiment}: ${row.rows} rows, ${row.cut_off_rows > 0 ? 'more than ' : ''}` +
        `${row.core_hours} core hours`,
    );
    lines.set(row.experiment, columns.map((name) => row[name]).join(','));
  }
  writeFileSync(
    `${file}.part`,
    `${[columns.join(','), ...lines.values()].join('\n')}\n`,
  );
  renameSync(`${file}.part`, file);
  say(`wrote ${file}`);
  return 0;
}
