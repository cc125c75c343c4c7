// Colours and marks of the series.

// Eight colours that people with deuteranopia and protanopia tell apart as well, on the light
// and on the dark background (tests/report/test_figures.mjs measures both). The last one, grey,
// is the colour of what a figure does not single out.
export const palette = [
  '#0083c8',
  '#d15900',
  '#3ab784',
  '#8c3184',
  '#d5a321',
  '#57b4e8',
  '#7a4a1f',
  '#777c83',
];
export const [blue, orange, green, purple, gold, sky, brown, grey] = palette;

// The series of all names that a figure does not single out.
export const others = 'others';

// Maps a name to itself, or to `others` where it is not among the first of `ranked`.
export function folded(ranked, most = palette.length) {
  const names = [...new Set(ranked)];
  const kept = new Set(names.length > most ? names.slice(0, most - 1) : names);
  return (name) => (kept.has(name) ? name : others);
}

const polygon = (corners, radius = 1, turn = 0) =>
  Array.from({ length: corners }, (_, k) => {
    const r = Array.isArray(radius) ? radius[k % radius.length] : radius;
    const angle = (2 * Math.PI * k) / corners + turn - Math.PI / 2;
    return `${k ? 'L' : 'M'}${(r * Math.cos(angle)).toFixed(3)},${(r * Math.sin(angle)).toFixed(3)}`;
  }).join('') + 'Z';

export const shapes = [
  'circle',
  'square',
  'triangle-up',
  'diamond',
  'cross',
  'triangle-down',
  polygon(10, [1, 0.45]),
  polygon(8, [1, 0.4]),
  polygon(6),
  'triangle-right',
  polygon(6, [1, 0.4]),
  'triangle-left',
  'M-0.9,-0.9L0.9,-0.9L-0.9,0.9L0.9,0.9Z',
  polygon(5),
  'M-0.9,-0.9L0.9,0.9L0.9,-0.9L-0.9,0.9Z',
  polygon(16, [1, 0.55]),
  'M-1,-0.35L1,-0.35L1,0.35L-1,0.35Z',
  'M-0.35,-1L0.35,-1L0.35,1L-0.35,1Z',
  'M-1,0.5A1,1,0,0,1,1,0.5Z',
  'M-1,-0.5A1,1,0,0,0,1,-0.5Z',
  'M0,-1L0.8,0L0.3,0L0.3,1L-0.3,1L-0.3,0L-0.8,0Z',
  'M0,1L0.8,0L0.3,0L0.3,-1L-0.3,-1L-0.3,0L-0.8,0Z',
  'M-1,-0.6L0,0.2L1,-0.6L1,0.2L0,1L-1,0.2Z',
  'M-0.9,-0.9L-0.3,-0.9L-0.3,0.3L0.9,0.3L0.9,0.9L-0.9,0.9Z',
  'M0.9,-0.9L0.3,-0.9L0.3,0.3L-0.9,0.3L-0.9,0.9L0.9,0.9Z',
  'M-0.9,-0.9L0.9,-0.9L0.9,-0.3L0.3,-0.3L0.3,0.9L-0.3,0.9L-0.3,-0.3L-0.9,-0.3Z',
  'M-0.9,0.9L0.9,0.9L0.9,0.3L0.3,0.3L0.3,-0.9L-0.3,-0.9L-0.3,0.3L-0.9,0.3Z',
  'M-1,-0.8L0,-0.25L1,-0.8L1,0.8L0,0.25L-1,0.8Z',
  'M-0.8,-1L0.8,-1L0.25,0L0.8,1L-0.8,1L-0.25,0Z',
  'M-0.9,-0.9L0.9,-0.9L0.9,-0.3L-0.3,-0.3L-0.3,0.9L-0.9,0.9Z',
  'M-0.9,-0.9L-0.3,-0.9L-0.3,0.3L0.3,0.3L0.3,-0.9L0.9,-0.9L0.9,0.9L-0.9,0.9Z',
  polygon(14, [1, 0.3]),
  polygon(12, [1, 0.7]),
  polygon(7),
  'M-1,0A1,1,0,0,1,1,0L0.5,0A0.5,0.5,0,0,0,-0.5,0Z',
  'M-1,0A1,1,0,0,0,1,0L0.5,0A0.5,0.5,0,0,1,-0.5,0Z',
  'M-0.9,-0.9L0.9,0L-0.9,0.9L-0.3,0Z',
  'M0.9,-0.9L-0.9,0L0.9,0.9L0.3,0Z',
];

const dashes = [
  [1, 0],
  [6, 3],
  [2, 2],
  [9, 3, 2, 3],
  [4, 4],
  [1, 3],
];

export const families = [
  {
    name: 'explicit, fixed step',
    colour: blue,
    members: ['explicit_euler', 'symplectic_euler', 'velocity_verlet', 'rk4', 'arkode_mri'],
  },
  {
    name: 'explicit, adaptive',
    colour: sky,
    members: ['gsl_rkf45', 'gsl_rk8pd', 'arkode_erk'],
  },
  {
    name: 'Adams',
    colour: green,
    members: ['gsl_msadams', 'cvode_adams'],
  },
  {
    name: 'implicit, fixed step',
    colour: orange,
    members: [
      'linearly_implicit_euler',
      'backward_euler',
      'implicit_midpoint',
      'linearly_implicit_midpoint',
      'bdf2',
      'newmark',
      'generalized_alpha',
    ],
  },
  {
    name: 'implicit, step or tolerance',
    colour: purple,
    members: ['tr_bdf2', 'esdirk43', 'guarded', 'guarded_esdirk43', 'radau5', 'rodas5p'],
  },
  {
    name: 'implicit, adaptive',
    colour: gold,
    members: ['cvode_bdf', 'arkode_dirk', 'arkode_ark', 'ida', 'gsl_bsimp'],
  },
  { name: 'structure preserving', colour: brown, members: ['rattle'] },
  {
    name: 'position-based',
    colour: grey,
    members: [
      'predictor_corrector',
      'xpbd',
      'xpbd_bdf2',
      'vbd',
      'vbd_augmented',
      'stable_cosserat_rods',
    ],
  },
  { name: 'other', colour: '#1d9aa0', members: [] },
];

// 'ida' matches 'ida', 'ida_index3', 'ida (order 2)'; the longest member name wins.
function family_of(name) {
  let best = { index: families.length - 1, member: -1, length: 0 };
  families.forEach((family, index) =>
    family.members.forEach((id, member) => {
      const matches =
        name === id || (name.startsWith(id) && !/[a-z0-9]/i.test(name[id.length]));
      if (matches && id.length > best.length) best = { index, member, length: id.length };
    }),
  );
  return best;
}

export const family_name = (name) => families[family_of(name).index].name;

const styled = (domain, colour_of) => ({
  domain,
  colours: domain.map((name, i) => colour_of(name, i)),
  shapes: domain.map((_, i) => shapes[i % shapes.length]),
  dashes: domain.map((_, i) => dashes[i % dashes.length]),
});

// The styles below are {domain, colours, shapes, dashes}: a colour and a shape for each name.

// Families of integrators, each in its own colour in every figure.
export function family_style(names) {
  const used = new Set(names);
  return styled(
    families.map(({ name }) => name).filter((name) => used.has(name)),
    (name) => families.find((family) => family.name === name).colour,
  );
}

// Names in the order given, `others` last and grey. A figure has no more names than there are
// colours; beyond that the shape alone tells two names apart.
export function name_style(names) {
  const known = [...new Set(names)].filter((name) => name !== others);
  return styled(names.includes(others) ? [...known, others] : known, (name, i) =>
    name === others ? grey : palette[i % palette.length],
  );
}

// Integrators, ordered by family.
export const series_style = (names) =>
  name_style(
    [...names]
      .map((name) => ({ name, ...family_of(name) }))
      .sort(
        (a, b) => a.index - b.index || a.member - b.member || a.name.localeCompare(b.name),
      )
      .map(({ name }) => name),
  );

const formulation_order = [
  'acceleration',
  'baumgarte',
  'projection',
  'index2_ggl',
  'index3',
  'rattle',
  'parametric',
];
const formulation_colours = [orange, gold, blue, green, purple, sky, grey, brown];

export function formulation_style(names) {
  const rank = (name) => {
    const i = formulation_order.findIndex((prefix) => name.startsWith(prefix));
    return i < 0 ? formulation_order.length : i;
  };
  const domain = [...new Set(names)].sort(
    (a, b) => rank(a) - rank(b) || a.localeCompare(b),
  );
  return styled(domain, (_, i) => formulation_colours[i % formulation_colours.length]);
}

// Fills of cells that are told apart by lightness too (CIE L* 30, 53, 68, 79 in this
// order), and the colour of text on them.
export const cell_fills = {
  dark: { fill: '#00523a', text: '#fefefe' },
  strong: { fill: '#d9541e', text: '#fefefe' },
  middle: { fill: '#cf9d2c', text: '#111111' },
  light: { fill: '#8cd0b1', text: '#111111' },
};

// Ramp of the strands in the player, light to dark is not used: it must read on both themes.
export const order_colours = ['#F2B134', '#E8743B', '#C9366F', '#8E3FB0', '#4C5BD4'];
