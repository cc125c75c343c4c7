// Shared by the report tests: a directory of fixture tables and the command under test.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const report_root = fileURLToPath(
  new URL('../../experiments/report/', import.meta.url),
);
const command = join(report_root, 'dist/report.mjs');
const generator = fileURLToPath(new URL('./make_fixture.mjs', import.meta.url));

export function run_report(...argv) {
  const { status, stderr } = spawnSync(process.execPath, [command, ...argv], {
    encoding: 'utf8',
  });
  return { status, stderr };
}

// The page alone: drawing figures takes seconds.
export const run_page = (...argv) => run_report(...argv, '--no-figures');

export const empty_directory = () => mkdtempSync(join(tmpdir(), 'tress-report-'));
export const remove = (directory) => rmSync(directory, { recursive: true, force: true });

export function fixture_directory() {
  const directory = empty_directory();
  const { status, stderr } = spawnSync(process.execPath, [generator, directory], {
    encoding: 'utf8',
  });
  if (status !== 0) throw new Error(stderr);
  return directory;
}
