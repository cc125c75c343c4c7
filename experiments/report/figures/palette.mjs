// Colours and marks of the series. Hue says the family (Okabe-Ito based, safe for
// colour-blind readers, legible on white and on near-black); shape and dash tell its
// members apart.

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
    colours: ['#1F7FC2', '#6CC0EE'],
    members: ['explicit_euler', 'symplectic_euler', 'velocity_verlet', 'rk4'],
  },
  {
    name: 'explicit, adaptive',
    colours: ['#009E73', '#4FC9A4'],
    members: ['gsl_rkf45', 'gsl_rk8pd', 'arkode_erk'],
  },
  {
    name: 'Adams',
    colours: ['#9C8500', '#C9B03A'],
    members: ['gsl_msadams', 'cvode_adams'],
  },
  {
    name: 'implicit, fixed step',
    colours: ['#D55E00', '#E69F00'],
    members: [
      'semi_implicit_euler',
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
    colours: ['#8C5A2B', '#C79A6B'],
    members: ['tr_bdf2', 'esdirk43'],
  },
  {
    name: 'implicit, adaptive',
    colours: ['#B6407F', '#DB8DBB'],
    members: ['cvode_bdf', 'arkode_dirk', 'ida', 'gsl_bsimp'],
  },
  { name: 'structure preserving', colours: ['#7A7F87'], members: ['rattle'] },
  {
    name: 'position-based',
    colours: ['#4C5BD4', '#8FA6D8'],
    members: [
      'predictor_corrector',
      'xpbd',
      'xpbd_bdf2',
      'vbd',
      'vbd_augmented',
      'stable_cosserat_rods',
    ],
  },
  { name: 'other', colours: ['#8E6CC9', '#B9A3E0'], members: [] },
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

// {domain, shapes} for the families of integrator names: a shape each.
export function family_style(names) {
  const used = new Set(names.map(family_name));
  const domain = families.map(({ name }) => name).filter((name) => used.has(name));
  return { domain, shapes: domain.map((_, i) => shapes[i]) };
}

// {domain, colours, shapes, dashes} for integrator names, ordered by family.
export function series_style(names) {
  const sorted = [...new Set(names)]
    .map((name) => ({ name, ...family_of(name) }))
    .sort(
      (a, b) => a.index - b.index || a.member - b.member || a.name.localeCompare(b.name),
    );
  const used = new Map();
  const entries = sorted.map(({ name, index }) => {
    const k = used.get(index) ?? 0;
    used.set(index, k + 1);
    const { colours } = families[index];
    return { name, colour: colours[k % colours.length], dash: dashes[k % dashes.length] };
  });
  return {
    domain: entries.map((e) => e.name),
    colours: entries.map((e) => e.colour),
    shapes: entries.map((_, i) => shapes[i % shapes.length]),
    dashes: entries.map((e) => e.dash),
  };
}

// {domain, range} of dashes for `compared` solvers, recursive solid; the other solvers of
// `rows` had no rival and stay solid.
export function solver_dashes(compared, rows) {
  const ranked = [...compared].sort(
    (a, b) => (b === 'recursive') - (a === 'recursive') || a.localeCompare(b),
  );
  const alone = [...new Set(rows.map((row) => row.solver))].filter(
    (solver) => !compared.includes(solver),
  );
  return {
    domain: [...ranked, ...alone],
    range: [
      ...ranked.map((_, i) => dashes[i % dashes.length]),
      ...alone.map(() => dashes[0]),
    ],
  };
}

const formulation_order = [
  'acceleration',
  'baumgarte',
  'projection',
  'index2_ggl',
  'index3',
  'rattle',
  'parametric',
];
const formulation_colours = [
  '#D55E00',
  '#E69F00',
  '#0072B2',
  '#009E73',
  '#B6407F',
  '#56B4E9',
  '#7A7F87',
  '#8E6CC9',
  '#9C8500',
];

export function formulation_style(names) {
  const rank = (name) => {
    const i = formulation_order.findIndex((prefix) => name.startsWith(prefix));
    return i < 0 ? formulation_order.length : i;
  };
  const domain = [...new Set(names)].sort(
    (a, b) => rank(a) - rank(b) || a.localeCompare(b),
  );
  return {
    domain,
    colours: domain.map((_, i) => formulation_colours[i % formulation_colours.length]),
  };
}

// Fills of cells that are told apart by lightness too (CIE L* 30, 53, 72, 88 in this
// order), and the colour of text on them.
export const cell_fills = {
  dark: { fill: '#00523a', text: '#ffffff' },
  strong: { fill: '#d9541e', text: '#ffffff' },
  middle: { fill: '#d9a93b', text: '#1d2127' },
  light: { fill: '#b5e6d1', text: '#1d2127' },
};

// Sequential ramp for max order 1..5 (light to dark is not used: it must read on both
// themes).
export const order_colours = ['#F2B134', '#E8743B', '#C9366F', '#8E3FB0', '#4C5BD4'];

// Solvers and tangents of the strand models; a later match of the same family takes the
// next shade.
const method_families = [
  {
    match: /(banded|klu)/,
    colours: ['#56B4E9', '#9C8500', '#C9366F', '#7A7F87', '#4C5BD4', '#8C6D31'],
  },
  { match: /^recursive(?!.*exact)/, colours: ['#1F7FC2', '#6CC0EE', '#8FA6D8'] },
  { match: /^composite(?!.*exact)/, colours: ['#E69F00', '#C9B03A', '#9C8500'] },
  { match: /^sparse(?!.*exact)/, colours: ['#8E6CC9', '#B9A3E0'] },
  { match: /^(?!articulated).*exact/, colours: ['#009E73', '#4FC9A4', '#7A9B2E'] },
  { match: /^articulated/, colours: ['#B6407F', '#DB8DBB', '#8E5A75'] },
  { match: /^less implicit/, colours: ['#D55E00'] },
  { match: /^/, colours: ['#7A7F87', '#B0B5BC'] },
];

// {domain, colours, shapes, dashes} for method names, ordered by family.
export function method_style(names) {
  const family = (name) => method_families.findIndex(({ match }) => match.test(name));
  const entries = method_families.flatMap(({ colours }, index) =>
    [...new Set(names)]
      .filter((name) => family(name) === index)
      .map((name, k) => ({
        name,
        colour: colours[k % colours.length],
        dash: dashes[k % dashes.length],
      })),
  );
  return {
    domain: entries.map((e) => e.name),
    colours: entries.map((e) => e.colour),
    shapes: entries.map((_, i) => shapes[i % shapes.length]),
    dashes: entries.map((e) => e.dash),
  };
}

// The same for models: a colour of its own for each, solid lines.
export function model_style(names) {
  const domain = [...new Set(names)];
  return {
    domain,
    colours: domain.map((_, i) => formulation_colours[(i + 2) % formulation_colours.length]),
    shapes: domain.map((_, i) => shapes[i % shapes.length]),
    dashes: domain.map(() => dashes[0]),
  };
}
