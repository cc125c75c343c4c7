// Bad texts, each [name, text], and special files: what programs are given to read.

/// Numbers in [0, 1), the same for the same seed (Marsaglia's xorshift, 32 bits).
export function random(seed) {
  let x = (seed * 2654435761 + 1) >>> 0 || 1;
  return () => {
    x ^= x << 13;
    x >>>= 0;
    x ^= x >>> 17;
    x ^= x << 5;
    x >>>= 0;
    return x / 4294967296;
  };
}

function noise(bytes, seed) {
  const next = random(seed);
  return Buffer.from(Array.from({ length: bytes }, () => Math.floor(256 * next())));
}

const bytes = (...values) => Buffer.from(values);
const levels = 31_000;

/// No text of any kind that a program of ours reads.
export const garbage = [
  ['nothing', ''],
  ['blanks', ' \t\n\n'],
  ['a NUL byte', 'a\0b = 1\n'],
  ['a byte order mark', '\uFEFF'],
  ['noise', noise(4096, 1)],
  ['more noise', noise(70_000, 2)],
  ['the head of a picture', bytes(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a)],
  ['half a character', Buffer.concat([Buffer.from('title = "'), bytes(0xe2, 0x82)])],
  ['half a character in a comment', Buffer.concat([Buffer.from('# '), bytes(0xf0, 0x9f)])],
  ['a surrogate', Buffer.concat([Buffer.from('a = "'), bytes(0xed, 0xa0, 0x80, 0x22)])],
  ['an overlong slash', Buffer.concat([Buffer.from('a = "'), bytes(0xc0, 0xaf, 0x22)])],
  ['Latin 1', Buffer.from('titel = "Stra\xdfe"\n', 'latin1')],
  ['UTF-16', Buffer.from('title = "a"\n', 'utf16le')],
  ['JSON', '{"title": "a", "strand": {"elements": 3}}\n'],
  ['YAML', 'title: a\nstrand:\n  - elements: 3\n'],
  ['XML', '<?xml version="1.0"?>\n<scene title="a"/>\n'],
  ['a table', 't_s,x_m\n0,1\n1,2\n'],
  ['one long line', 'x'.repeat(1_000_000)],
  ['one long quoted line', '"' + 'x'.repeat(1_000_000)],
  ['carriage returns', 'title = "a"\relements = 3\r'],
  ['an escape sequence', 'title = "a"\n\x1b[31m = 1\n'],
];

/// No TOML, or TOML that nothing asks for.
export const malformedToml = [
  ['a string without end', 'title = "a\n'],
  ['a long string without end', 'title = """a\n'],
  ['a list without end', 'elements = [1, 2\n'],
  ['a table without end', 'settings = {a = 1\n'],
  ['a header without end', '[settings\n'],
  ['a key without value', 'title =\n'],
  ['a value without key', '= 1\n'],
  ['a key twice', 'title = "a"\ntitle = "a"\n'],
  ['a table twice', 'title = "a"\n[settings]\n[settings]\n'],
  ['a table that was a value', 'title = "a"\n[title.b]\n'],
  ['a number of 400 digits', `seed = ${'9'.repeat(400)}\n`],
  ['a hexadecimal number too large', 'seed = 0xffffffffffffffffffffff\n'],
  ['an impossible date', 'title = 2026-02-31\n'],
  ['a wrong escape', 'title = "\\q"\n'],
  ['a surrogate by its number', 'title = "\\ud800"\n'],
  ['a long key', `${'k'.repeat(1_000_000)} = 1\n`],
  ['a long number', `seed = 1${'0'.repeat(1_000_000)}\n`],
  ['many keys', Array.from({ length: 50_000 }, (_, i) => `k${i} = 1\n`).join('')],
  ['many tables', Array.from({ length: 20_000 }, (_, i) => `[t${i}]\n`).join('')],
  ['many of one table', 'title = "a"\n' + '[[nothing]]\n'.repeat(20_000)],
  ['a deep key', `${'a.'.repeat(levels)}a = 1\n`],
  ['a deep key of quoted parts', `${'"a".'.repeat(levels)}a = 1\n`],
  ['a deep key with blanks', `${'a . '.repeat(levels)}a = 1\n`],
  ['a deep header', `[${'a.'.repeat(levels)}a]\n`],
  ['a deep header of many', `[[${'a.'.repeat(levels)}a]]\n`],
  ['a deep key in a table', `a = {${'a.'.repeat(levels)}a = 1}\n`],
  ['a deep key behind a string', `a = [""""b""""", {${'a.'.repeat(levels)}a = 1}]\n`],
  ['a deep key behind a comment', `# "\n${'a.'.repeat(levels)}a = 1\n`],
  ['a deep list', `a = ${'['.repeat(levels)}\n`],
  ['a deep list that ends', `a = ${'['.repeat(levels)}${']'.repeat(levels)}\n`],
  ['deep tables', `a = ${'{a='.repeat(levels)}\n`],
  ['deep tables of deep keys', `b = ${'{a.a.a.a.a.a.a.a.a.a=['.repeat(200)}\n`],
  ['more than 4 MiB', `title = "a"\n${'#'.repeat(4 << 20)}`],
];

/// No table, whatever its columns should be.
export const malformedCsv = [
  ['a quote without end', 'a,b\n1,"2\n'],
  ['a stray quote', 'a,b\n1,2"3\n'],
  ['a character after a quote', 'a,b\n"1"2,3\n'],
  ['too few cells', 'a,b\n1\n'],
  ['too many cells', 'a,b\n1,2,3\n'],
  ['a column twice', 'a,a\n1,2\n'],
  ['many columns', `${Array.from({ length: 5000 }, (_, i) => `c${i}`).join(',')}\n`],
  ['many lines', `a\n${'1\n'.repeat(4_000_000)}`],
  ['more than 16 MiB', `a\n${'1'.repeat(17 << 20)}`],
];

/// Not to be read at all: [name, file or what to make of it].
export const special = [
  ['no file', null],
  ['a folder', { folder: true }],
  ['a pipe', { pipe: true }],
  ['/dev/zero', { link: '/dev/zero' }],
  ['/dev/urandom', { link: '/dev/urandom' }],
  ['a terminal', { link: '/dev/tty' }],
  ['a link to itself', { link: 'itself' }],
];

/// Values that fit no key of a scene: numbers out of all ranges, and other types.
export const wrongValues = ['nan', 'inf', '-inf', '1e999', '-1e308', '1979-05-27', '{}', '[[]]',
  '""', '[nan, 0, 0]'];

/// A scene with all tables, every value on a line of its own.
/// One that runs as a head of hair.
export const headScene = `title = "a head"
duration_s = 0.05
frames_1_s = 30
checkpoint_s = 0.02
[model]
tangent = "stiff"
[integrator]
id = "semi_implicit_euler"
dt_s = 0.01
[groom]
count = 3
length_m = 0.1
elements = 2
[root]
motion = "fixed"
[effects.gravity]
`;

export const scene = `title = "a strand"
duration_s = 0.05
frames_1_s = 30
checkpoint_s = 0.02
seed = 1
[model]
id = "super_helix"
[integrator]
id = "semi_implicit_euler"
dt_s = 0.001
newton_iterations = 20
[material]
name = "hair.asian"
internal_friction_kg_m3_s = 1e-10
radius_m = 40e-6
density_kg_m3 = 1300
youngs_modulus_pa = 2e9
[strand]
shape = "straight"
length_m = 0.1
elements = 3
position_m = [0, 0, 0]
root_tangent = [1, 0, 0]
[groom]
count = 3
length_m = 0.1
elements = 2
[root]
motion = "shake"
amplitude_m = 0.02
frequency_hz = 2
[effects.gravity]
gravity_m_s2 = [0, 0, -9.81]
[effects.linear_drag]
[[effects.body]]
shape = "sphere"
radius_m = 0.05
`;

export const grids = [
  ['an empty grid', ''],
  ['words for a grid', 'signed distances\n'],
  ['half a grid', '4 4 4\n0 0 0\n0.1\n1 2 3\n'],
  ['more than a grid', `4 4 4\n0 0 0\n0.1\n${'1 '.repeat(65)}\n`],
  ['a small grid', `3 3 3\n0 0 0\n0.1\n${'1 '.repeat(27)}\n`],
  ['a grid of 1e18', '1000000 1000000 1000000\n0 0 0\n0.1\n'],
  ['a grid beyond all numbers', '99999999999999999999 4 4\n'],
  ['a negative grid', '-4 -4 -4\n0 0 0\n0.1\n'],
  ['a grid that is not finite', `4 4 4\n0 0 0\n0.1\nnan ${'1 '.repeat(63)}\n`],
  ['a grid without spacing', `4 4 4\n0 0 0\n0\n${'1 '.repeat(64)}\n`],
  ['a grid of one word', '4'.repeat(5_000_000)],
  ['a grid of comments', '#\n'.repeat(2_000_000)],
  ['noise for a grid', noise(100_000, 3)],
  ['NUL bytes for a grid', Buffer.alloc(5_000_000)],
];
