// Bad inputs for every program: {program, kind, name, args, files}. `files` become those of
// the folder where the program runs: texts, null for none, {folder}, {pipe}, {link: to}.
// `maybe`: chance may have left the input legal.
import {
  garbage, grids, headScene, malformedCsv, malformedToml, random, scene, special, wrongValues,
} from './texts.mjs';

/// How each program is told which scene to look at, without running it where it can.
const readersOfScenes = {
  simulate: (file) => [file, '--out', 'out'],
  cost_of_accuracy: (file) => ['--scene', file, '--out', 't.csv'],
  stability_limit: (file) => ['--scene', file, '--quick', '--out', 't.csv'],
  hard_cases: (file) => ['--scene', file, '--quick', '--out', 't.csv'],
  work_precision: (file) => ['--scene', file, '--quick', '--out', 't.csv'],
  scaling: (file) => ['--scene', file, '--quick', '--out', 't.csv'],
  effect_audit: (file) => ['--scene', file, '--out', 't.csv'],
  head_accuracy: (file) => ['--scene', file, '--quick', '--out', 't.csv'],
  calibrate: (file) => ['--scene', file, '--quick', '--out', 't.csv'],
};
const advise = (file) => ['--advise', file, '--out', 't.csv'];

function* eachReader(file, { dry = false } = {}) {
  const more = dry ? ['--dry-run'] : [];
  for (const [program, args] of Object.entries(readersOfScenes)) {
    if (dry && program === 'simulate') continue;
    yield { program, args: [...args(file), ...more] };
  }
  yield { program: 'cost_of_accuracy', args: [...advise(file), ...more] };
}

function* wrongKeys() {
  const lines = scene.split('\n');
  for (let i = 0; i < lines.length; i++) {
    const [, key] = lines[i].match(/^(\w+) = /) ?? [];
    if (!key) continue;
    const withLine = (line) => lines.with(i, line).join('\n');
    yield [`${key} misspelt`, withLine(lines[i].replace(key, `${key.slice(0, -1)}q_`))];
    yield [`${key} twice`, withLine(`${lines[i]}\n${lines[i]}`)];
    for (const value of wrongValues) yield [`${key} = ${value}`, withLine(`${key} = ${value}`)];
  }
  for (const table of scene.match(/^\[+[\w.]+\]+$/gm)) {
    const name = table.replace(/[[\]]/g, '');
    yield [`${name} misspelt`, scene.replace(table, table.replace(name, `${name}q_`))];
    if (!name.includes('.')) yield [`${name} = 3`, `${name} = 3\n${scene}`];
  }
}

/// Spoils a text in one of six ways, up to three times.
function spoilt(text, next) {
  const pick = (n) => Math.floor(n * next());
  const line = () => {
    const lines = text.split('\n');
    return [lines, pick(lines.length)];
  };
  const ways = [
    () => { const at = pick(text.length); return text.slice(0, at) + text.slice(at + 1 + pick(4)); },
    () => { const at = pick(text.length); return text.slice(0, at) + '"\'[]{}=,.#-\n\\\0\x01\xff 0e_'[pick(22)] + text.slice(at); },
    () => { const [lines, i] = line(); return lines.toSpliced(i, 1).join('\n'); },
    () => { const [lines, i] = line(); return lines.toSpliced(i, 0, lines[pick(lines.length)]).join('\n'); },
    () => { const at = pick(text.length); return text.slice(0, at) + 'abcdefghijklmnopqrstuvwxyz'[pick(26)] + text.slice(at + 1); },
    () => text.slice(0, pick(text.length)),
  ];
  for (let n = 1 + pick(3); n > 0; n--) text = ways[pick(ways.length)]();
  return text;
}

function* scenes(shipped, seed, count) {
  const whole = (texts) => texts.map(([name, text]) => [name, { 'scene.toml': text }]);
  const fixed = [...whole(garbage), ...whole(malformedToml), ...whole([...wrongKeys()]),
    ...special.map(([name, what]) => [name, { 'scene.toml': what }])];
  const withGrid = `${scene}[[effects.body]]\nshape = "sdf"\nsdf_file = "grid.txt"\n`;
  for (const [name, what] of [...grids, ...special]) {
    fixed.push([`${name} as sdf_file`, { 'scene.toml': withGrid, 'grid.txt': what }]);
  }
  for (const [name, files] of fixed) {
    for (const run of eachReader('scene.toml')) yield { ...run, kind: 'scene', name, files };
  }
  const next = random(seed);
  for (let i = 0; i < count; i++) {
    const files = { 'scene.toml': spoilt(shipped[i % shipped.length], next) };
    for (const run of eachReader('scene.toml', { dry: true })) {
      yield { ...run, kind: 'spoilt scene', name: `number ${i}`, files, maybe: true };
    }
    // It has no dry run; those that effect_audit reads are left out.
    yield { program: 'simulate', args: readersOfScenes.simulate('scene.toml'),
      kind: 'spoilt scene', name: `number ${i}`, files, after: 'effect_audit' };
  }
}

/// Options files.
function* options(programs) {
  const wrong = [...garbage, ...malformedToml, ...special,
    ...['title = 3', 'models = 3', 'models = "none_such"', 'models = [[]]', 'models = {}',
      'integrators = ["none_such"]', 'elements = 0', 'elements = [1, -1]', 'elements = 1e308',
      'elements = nan', 'elements = "3:1"', 'timeout = 1e10', 'timeout = -1', 'timeout = true',
      'timeout = inf', 'repeat = 0', 'repeat = 1e308', 'seed = -1', 'seed = nan', 'quick = 1',
      'full = "yes"', 'settings = 5', 'settings = []', 'sede = 1', '[settings]\nstep = []',
      '[settings]\nstep = nan', '[settings]\nstep = -1', '[settings]\nnone_such = 1',
      'quick = true\nfull = true', 'jobs = 3'].map((text) => [text, `${text}\n`])];
  for (const program of programs) {
    if (program === 'simulate') continue;  // has options of its own
    for (const [name, what] of wrong) {
      if (['nothing', 'blanks', 'a byte order mark'].includes(name)) continue;  // legal
      yield { program, kind: 'options file', name, files: { 'options.toml': what },
        args: ['--options', 'options.toml', '--out', 't.csv'] };
    }
  }
}

const ofAll = ['--elments 3', '--set', '--set x', '--set =1', '--set none_such=1',
  '--set step=nan', '--set step=-1', '--set rtol=1e308', '--models none_such', '--models ,',
  '--integrators none_such', '--elements 0', '--elements -1', '--elements 1e308',
  '--elements nan', '--elements 3:1', '--elements 1:99999999', '--elements 1:2:0', '--jobs 0',
  '--jobs -1', '--jobs 99999999999999999999', '--jobs nan', '--repeat 0', '--repeat 1e308',
  '--repeat -3', '--shard 0/1', '--shard 2/1', '--shard 1', '--shard 1/99999999999',
  '--seed -1', '--seed 1e308', '--seed nan', '--seed 18446744073709551616', '--timeout 0',
  '--timeout -1', '--timeout nan', '--timeout inf', '--timeout 1e308', '--timeout 1e10',
  '--timeout 1e-300', '--progress loud', '--quick --full', '--retry-failed', 'stray',
  '--out .', '--out none/t.csv', '--out /proc/t.csv', '--out /dev/full', '--out /dev/null',
  '--out loop', '--out loop/t.csv', '--out pipe', '--out file/t.csv', `--out ${'n'.repeat(300)}`,
  '--out - --resume', '--merge a.csv', '--merge --out t.csv', '--options', '-x', '--', '-',
  '--plugin', '--plugin none.so', '--plugin .', '--plugin file', '--plugin pipe', '--plugin loop',
  '--plugin /dev/zero'];
const ofSimulate = ['--threads 0', '--threads -1', '--threads 1e9', '--threads nan',
  '--hairs -1', '--hairs 1e308', '--hairs nan', '--progress loud', '--elments 3', '-x', '--out',
  '--as none', '--as', '--device none', '--device', '--bits 16', '--bits nan', '--bits 1e308', '--lanes 0', '--lanes -8',
  '--lanes 3', '--lanes 16', '--bits 32 --lanes 4', '--frames 16', '--frames', '--frames nan',
  'scene.toml --as head --out o', 'head.toml --as head --out o --hairs 3',
  'head.toml --as head --out o --error-bars', 'head.toml --as head --out file',
  'none.toml', 'scene.toml none.toml', 'scene.toml --out file', 'scene.toml --out loop',
  'scene.toml --out loop/o', 'scene.toml --out /proc/o', 'scene.toml --out /dev/null/o',
  'scene.toml --plugin none.so', 'scene.toml --plugin file', 'scene.toml --plugin pipe', '--plugin',
  'scene.toml --out file/o', 'scene.toml --out pipe', `scene.toml --out ${'n'.repeat(300)}`,
  ''];

function* commands(programs) {
  const files = { loop: { link: 'loop' }, pipe: { pipe: true }, file: 'text\n',
    'scene.toml': scene, 'head.toml': headScene };
  for (const program of programs) {
    for (const text of program === 'simulate' ? ofSimulate : ofAll) {
      const args = text.split(' ').filter((word) => word !== '');
      // '--' alone asks for all there is.
      const more = text === '--' ? ['stray'] : [];
      yield { program, kind: 'command line', name: text.slice(0, 40), files,
        args: [...args, ...more] };
    }
  }
}

/// Tables, their manifests and journals. `headers`: of the table of each program.
function* tables(headers) {
  const nowhere = ['--quick', '--shard', '9999/9999', '--out', 't.csv', '--resume'];
  // A part's table has a name of its own.
  const part = 't.9999-of-9999';
  const meta = '{"settings": "seed=1 quick"}';
  const wrongManifests = ['null', '[]', '""', '3', '{}', '{"settings": 5}',
    '{"settings": null}', '{"settings": ["seed=1 quick"]}', '{"settings": "seed=2"}',
    '{"settings": "seed=1 quick"', `${'['.repeat(200_000)}`, `${'{"a":'.repeat(200_000)}`]
    .map((text) => [text.slice(0, 40), text]);
  for (const [program, csv] of Object.entries(headers)) {
    const texts = [...garbage, ...malformedCsv, ...special,
      ['one column less', csv.replace(/^[^,]*,/, '')],
      ['one cell less', `${csv}1\n`]];
    for (const [name, what] of texts) {
      // What is not there is not resumed; nor is a table without a line, which has no rows.
      if (what !== null) {
        yield { program, kind: 'table to resume', name, files: { [`${part}.csv`]: what },
          args: nowhere };
      }
      yield { program, kind: 'table to merge', name, files: { 'a.csv': what, 'b.csv': csv },
        args: ['--merge', 'b.csv', 'a.csv', '--out', 't.csv'] };
    }
    for (const [name, what] of [...garbage, ...wrongManifests, ...special]) {
      if (what === null || what.link === 'itself') continue;  // no manifest, as it were
      yield { program, kind: 'manifest', name,
        files: { [`${part}.csv`]: csv, [`${part}.meta.json`]: what },
        args: nowhere };
    }
    for (const [name, what] of [...garbage, ...special]) {
      // A last line without an end is what a crash leaves, and dropped.
      const text = typeof what === 'string' || Buffer.isBuffer(what);
      if (what === null || (text && !what.includes('\n'))) continue;
      yield { program, kind: 'journal', name, args: nowhere,
        files: { [`${part}.csv`]: csv, [`${part}.meta.json`]: meta,
          [`${part}.csv.journal`]: what } };
    }
  }
}

function* records() {
  const line = (t, x) => `${t},${x}\n`;
  const head = 't_s,amplitude_m\n';
  const good = [1, 2, 3, 4, 5, 6].map((i) => line(i / 100, 0.01 * i)).join('');
  const wrong = [...garbage, ...malformedCsv, ...special,
    ['a header alone', head], ['four points', head + good.split('\n').slice(0, 4).join('\n')],
    ['another header', `a,b\n${good}`], ['an unknown parameter',
      `t_s,amplitude_m,none_such\n${good.replace(/\n/g, ',1\n')}`],
    ...['nan', 'inf', '1e999', '', 'x', '-1', '0', '0x1'].map((t) => [`t_s = ${t}`,
      head + good + line(t, 0.01)]),
    ...['nan', 'inf', '-inf', '1e999', '', 'x'].map((x) => [`amplitude_m = ${x}`,
      head + good + line(0.07, x)]),
    ...['0', '-1', 'nan', ''].map((sigma) => [`sigma_m = ${sigma}`,
      `t_s,amplitude_m,sigma_m\n${good.replace(/\n/g, `,${sigma}\n`)}`]),
    ...['0', '-1', 'nan', '1e308', 'x'].map((length) => [`length_m = ${length}`,
      `t_s,amplitude_m,length_m\n${good.replace(/\n/g, `,${length}\n`)}`])];
  for (const [name, what] of wrong) {
    yield { program: 'calibrate', kind: 'record', name, files: { 'data.csv': what },
      args: ['--set', 'data=data.csv', '--out', 't.csv'] };
  }
}

/// What an interrupted run of `simulate` may have left.
function* states() {
  for (const [name, what] of [...garbage, ...special]) {
    if (what === null) continue;
    for (const ending of ['state', 'frames']) {
      if (ending === 'frames' && what === '') continue;  // goes with what made it: a lock
      yield { program: 'simulate', kind: `.${ending}`, name, maybe: what.link === 'itself',
        files: { 'scene.toml': scene, 'out/scene.state': 'x', [`out/scene.${ending}`]: what },
        args: ['scene.toml', '--out', 'out', '--resume'] };
    }
    for (const ending of ['state', 'h5', 'csv']) {
      // A table or frames to be written anew are not read.
      const read = ending === 'state';
      if (!read && (typeof what === 'string' || Buffer.isBuffer(what))) continue;
      yield { program: 'simulate', kind: `head's .${ending}`, name, maybe: what.link === 'itself',
        files: { 'scene.toml': headScene, [`out/scene.${ending}`]: what },
        args: ['scene.toml', '--as', 'head', '--out', 'out', ...(read ? ['--resume'] : [])] };
    }
  }
}

/// All of them, in an order that depends on nothing but the seed.
export function* corpus({ programs, shipped, headers, seed, count }) {
  yield* scenes(shipped, seed, count);
  yield* options(programs);
  yield* commands(programs);
  yield* tables(headers);
  yield* records();
  yield* states();
}
