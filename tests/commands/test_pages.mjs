// test_pages.mjs ROOT BUILD --run PAGE...: runs every command of these pages, in a copy of the
// repository, which they may change; build/release there is BUILD. Output that a page shows
// must be printed, but for its numbers and units of time. What is not run as it stands is in
// command_rules.mjs. --check PAGE...: each command has one rule at most, each
// rule a command, and these are the pages that have something to run.
import { spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { before, rules } from './command_rules.mjs';
import { page_commands, pages } from './page_commands.mjs';

const [root, build] = process.argv.slice(2, 4).map((path) => resolve(path));
const [how, ...named] = process.argv.slice(4);

const rules_of = ({ page, text }) =>
  rules.filter((rule) => rule.page === page && text.startsWith(rule.command));

function as_run(command) {
  const { text } = command;
  const [rule = {}] = rules_of(command);
  if (rule.left_out) return undefined;
  const { instead } = rule;
  const said = instead ? instead + text.slice(rule.command.length) : text;
  return {
    command: rule.more ? `${said} ${rule.more}` : said,
    exits: [0, ...(rule.exits ?? [])],
    output: command.output,
  };
}

/// A text whose numbers and units of time depend on the machine no more.
const masked = (text) =>
  text
    .replace(/\d[\d.]*(e[-+]?\d+)?/g, '#')
    .replace(/# ([mµun]?s)\b/g, '# s');

/// Lines of a page's output that a command did not print; "..." there stands for any text.
function not_printed(output, printed) {
  const lines = masked(printed).split('\n');
  const literal = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
  return output.filter((line) => {
    const pattern = new RegExp(`^${masked(line).split('...').map(literal).join('.*')}$`);
    return !lines.some((printed_line) => pattern.test(printed_line));
  });
}

function check(tested) {
  const complaints = [];
  const commands = pages(root).flatMap((page) => page_commands(root, page));
  for (const command of commands) {
    const place = `${command.page}:${command.line}`;
    if (rules_of(command).length > 1)
      complaints.push(`${place}: two rules for one command`);
  }
  for (const rule of rules) {
    const place = `command_rules.mjs: ${rule.page}: '${rule.command}'`;
    const kinds = ['more', 'instead', 'exits', 'left_out'].filter((kind) => rule[kind]);
    if (!commands.some((command) => rules_of(command).includes(rule))) {
      complaints.push(`${place} begins no command there`);
    }
    if (kinds.length === 0) complaints.push(`${place} says nothing`);
    if ((rule.instead || rule.exits) && !rule.why)
      complaints.push(`${place} does not say why`);
    if (rule.by && !readFileSync(join(root, rule.by), 'utf8').includes(rule.page)) {
      complaints.push(`${place}: ${rule.by} does not read that page`);
    }
  }
  const run = [...new Set(commands.filter(as_run).map(({ page }) => page))].sort();
  for (const page of Object.keys(before)) {
    if (!run.includes(page))
      complaints.push(`command_rules.mjs: before: ${page} runs nothing`);
  }
  if (String(run) !== String([...tested].sort())) {
    complaints.push(`CMakeLists.txt: pages ${tested} are run, of ${run}`);
  }
  const left_out = commands.filter((command) => !as_run(command)).length;
  console.log(
    `${commands.length} commands on ${pages(root).length} pages, ${left_out} left out`,
  );
  return complaints;
}

function copy_of_repository() {
  const work = mkdtempSync(join(tmpdir(), 'tress-pages-'));
  mkdirSync(join(work, 'tress/build'), { recursive: true });
  const left = [
    './build',
    './.git',
    './results/scenes',
    'node_modules',
    './results/compare',
  ];
  const tar = `tar -C '${root}' ${left.map((path) => `--exclude=${path}`).join(' ')} -c .`;
  bash(`${tar} | tar -C '${work}/tress' -x`, work);
  symlinkSync(build, join(work, 'tress/build/release'));
  return work;
}

function bash(command, cwd) {
  const options = {
    cwd,
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'pipe'],
    maxBuffer: 1 << 28,
  };
  return spawnSync('bash', ['-o', 'pipefail', '-c', command], options);
}

/// Complaints about the commands of a page, none after the first.
function run_page(page) {
  const work = copy_of_repository();
  try {
    const commands = [
      ...(before[page] ?? []).map((command) => ({ command, exits: [0], output: [] })),
      ...page_commands(root, page).map(as_run),
    ];
    for (const { command, exits, output } of commands.filter(Boolean)) {
      const since = performance.now();
      const { status, stdout, stderr } = bash(command, join(work, 'tress'));
      console.log(`${((performance.now() - since) / 1000).toFixed(1)} s  ${command}`);
      if (!exits.includes(status)) {
        return [`${page}: exit code ${status} of: ${command}\n${stdout}${stderr}`];
      }
      const missing = not_printed(output, stdout + stderr);
      if (missing.length > 0) {
        return [`${page}: '${missing[0]}' is not printed by: ${command}\n${stdout}${stderr}`];
      }
    }
    return [];
  } finally {
    rmSync(work, { recursive: true, force: true });
  }
}

const complaints = how === '--run' ? named.flatMap(run_page) : check(named);
for (const complaint of complaints) console.error(complaint);
process.exitCode = complaints.length > 0 ? 1 : 0;
