// The command `node report.mjs`: see usage in command.mjs.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { run } from './command.mjs';

export const sources = TRESS_SOURCES;

process.exitCode = await run(process.argv.slice(2), {
  template: () =>
    readFileSync(fileURLToPath(new URL('./page.html', import.meta.url)), 'utf8'),
  render: async (...args) => (await import('./render.mjs')).render_figures(...args),
});
