// real_builds.mjs BUILD [--runs n]: does ./tress compare find a kernel that does a tenth more
// work, and nothing in a build beside itself? BUILD has the benchmarks (preset bench). The
// slowed program is compiled from the same sources, but for a header in which every tenth
// element of a strand is shaped twice; a run with it to four without. Writes
// results/compare_itself.csv; a row is a run.
import { execFileSync, spawnSync } from 'node:child_process';
import {
  copyFileSync,
  mkdirSync,
  mkdtempSync,
  readFileSync,
  rmSync,
  writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parse_csv } from '../../experiments/report/src/csv.mjs';

const repository = fileURLToPath(new URL('../../', import.meta.url));
const program = 'experiments/benchmarks/bench_strands';
const header = 'models/reduced/kinematics.h';
const work = '      shape_segment(i, q);\n';
const twice = '      if (i % 10 == 0) shape_segment(i, q);\n';
// The slowed one, and five that do none of its work.
const slowed = 'geometry/bend_twist/20';
const filter = [
  `(geometry|motion|matrices)/bend_twist/20`,
  'residual/recursive/exact/bend_twist/20',
  '(linearize|solve)/recursive/stiff/bend_twist/20',
].map((name) => `^${name}$`).join('|'); // prettier-ignore

const [build_given, ...words] = process.argv.slice(2);
if (build_given === undefined || (words.length > 0 && words[0] !== '--runs')) {
  console.error('give: node tests/compare/real_builds.mjs build/bench [--runs n]');
  process.exit(2);
}
const build = resolve(build_given);
const runs = Number(words[1] ?? 20);
const scratch = mkdtempSync(join(tmpdir(), 'tress-builds-'));

/// A folder that ./tress compare takes for a build.
function folder(name) {
  const path = join(scratch, name);
  mkdirSync(dirname(join(path, program)), { recursive: true });
  return path;
}

function copy(name) {
  const path = folder(name);
  copyFileSync(join(build, program), join(path, program));
  return path;
}

/// The build's own commands, with the changed header before the others.
function compile_slowed() {
  const path = folder('slowed');
  const text = readFileSync(join(repository, header), 'utf8');
  const changed = text.replace(work, work + twice);
  if (changed === text) throw new Error(`${header} has lost '${work.trim()}'`);
  mkdirSync(dirname(join(scratch, header)), { recursive: true });
  writeFileSync(join(scratch, header), changed);
  const object = join(scratch, 'slowed.o');
  const commands = execFileSync('ninja', ['-t', 'commands', program], {
    cwd: build,
    encoding: 'utf8',
  }).split('\n');
  const compile = commands.find((line) => / -c \S*bench_strands\.cpp$/.test(line));
  const own = compile.match(/ -o (\S+)/)[1];
  const link = commands.find((line) => line.includes(` -o ${program} `));
  for (const command of [
    compile.replace(' -I', ` -I${scratch} -I`).replace(` -o ${own}`, ` -o ${object}`),
    link.replace(` ${own}`, ` ${object}`).replace(` -o ${program}`, ` -o ${path}/${program}`),
  ])
    execFileSync('bash', ['-c', command], { cwd: build, stdio: 'inherit' });
  return path;
}

/// Rows judged, verdicts that are wrong, and what the slowed row says.
function compare(a, b, is_slowed) {
  const stem = join(scratch, 'out');
  const run = spawnSync(
    process.execPath,
    [join(repository, 'experiments/compare/compare.mjs'), a, b, '--filter', filter,
      '--out', stem],
    { encoding: 'utf8' },
  ); // prettier-ignore
  if (![0, 3].includes(run.status)) throw new Error(run.stderr);
  const { columns, rows } = parse_csv(readFileSync(`${stem}.csv`, 'utf8'), stem);
  const judged = rows.map((row) =>
    Object.fromEntries(columns.map(({ name }, i) => [name, row[i]])),
  );
  const of_kernel = judged.find(({ row }) => row === slowed);
  const wrong = judged.filter(
    ({ row, verdict }) => verdict !== (is_slowed && row === slowed ? 'slower' : 'same'),
  );
  return [judged.length, wrong.length, of_kernel.verdict, of_kernel.ratio, of_kernel.low,
    of_kernel.high]; // prettier-ignore
}

try {
  const own = copy('own');
  const others = { itself: copy('same'), slowed: compile_slowed() };
  const lines = ['beside,rows,wrong,verdict,ratio,ratio_low,ratio_high'];
  for (const [beside, other] of Object.entries(others))
    for (let i = 0; i < (beside === 'slowed' ? runs / 4 : runs); ++i) {
      lines.push([beside, ...compare(own, other, beside === 'slowed')].join(','));
      console.log(lines.at(-1));
    }
  writeFileSync(join(repository, 'results/compare_itself.csv'), `${lines.join('\n')}\n`);
} finally {
  rmSync(scratch, { recursive: true, force: true });
}
