// Random scenes: single strands over length, radius, modulus, curl, friction, drive, contact
// and wind; hairs, wires, soft rods, small grooms. The same seed gives the same scenes.

/// mulberry32: numbers in [0, 1).
function generator(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/// Young's modulus, radius, density and length of a kind are drawn between these, uniformly in
/// their logarithms; tau (s) is internal friction over E I, drag in kg/(m s). Measured hair has
/// E/G = 4.4; isotropic materials have Poisson's ratio.
const kinds = {
  hair: { weight: 5, E: [2.7e9, 5.3e9], radius: [30e-6, 45e-6], density: [1300, 1320],
    length: [0.05, 0.3], shear: 4.4, tau: [1e-3, 3e-3], drag: [8e-5, 2e-4], curl: 150 },
  'soft hair': { weight: 2, E: [1e7, 5e8], radius: [35e-6, 60e-6], density: [1300, 1320],
    length: [0.05, 0.25], shear: 4.4, tau: [1e-3, 2e-2], drag: [2e-5, 2e-4], curl: 150 },
  wire: { weight: 2, E: [5e10, 2.1e11], radius: [5e-5, 3e-4], density: [6450, 7850],
    length: [0.1, 0.6], poisson: 0.3, tau: [1e-6, 1e-4], drag: [1e-5, 2e-4], curl: 20 },
  rod: { weight: 2, E: [3e5, 3e6], radius: [1e-3, 5e-3], density: [1070, 1200],
    length: [0.1, 0.4], poisson: 0.48, tau: [1e-3, 2e-2], drag: [1e-3, 1e-1], curl: 30 },
  groom: { weight: 1, E: [2.7e9, 5.3e9], radius: [30e-6, 45e-6], density: [1300, 1320],
    length: [0.05, 0.2], shear: 4.4, tau: [1e-3, 3e-3], drag: [8e-5, 2e-4], curl: 80 },
};

export function random_scene(seed) {
  const random = generator(seed * 7919 + 17);
  for (let i = 0; i < 8; i++) random();
  const between = ([low, high]) => low * Math.exp(random() * Math.log(high / low));
  const linear = (low, high) => low + random() * (high - low);
  const pick = (list) => list[Math.floor(random() * list.length)];
  const number = (x) => Number(x.toPrecision(4));
  const bag = Object.entries(kinds).flatMap(([name, kind]) => Array(kind.weight).fill(name));
  const name = pick(bag);
  const kind = kinds[name];
  const [E, radius, length] = [between(kind.E), between(kind.radius), between(kind.length)];
  const friction = between(kind.tau) * E * (Math.PI / 4) * radius ** 4;
  const down = random() < 0.5;
  const lines = [
    `title = "${name} ${seed}"`,
    `duration_s = ${number(linear(0.5, 2))}`,
    '[model]', 'id = "super_helix"',
    '[integrator]', 'id = "backward_euler"', 'dt_s = 0.002',
    '[material]', 'name = "custom"', `radius_m = ${number(radius)}`,
    `youngs_modulus_pa = ${number(E)}`,
    kind.shear ? `shear_modulus_pa = ${number(E / kind.shear)}` : `poisson_ratio = ${kind.poisson}`,
    `density_kg_m3 = ${number(between(kind.density))}`,
    `internal_friction_kg_m3_s = ${number(friction)}`,
    name === 'groom' ? '[groom]' : '[strand]',
    ...(name === 'groom' ? [`count = ${Math.floor(linear(5, 80))}`] : []),
    `length_m = ${number(length)}`, 'elements = 20',
    ...(name === 'groom' ? [] : [`root_tangent = ${down ? '[0, 0, -1]' : '[1, 0, 0]'}`]),
  ];
  if (random() < 0.5) {
    if (name === 'groom') {
      lines.push('shape = "wavy"', `wave_1_m = ${number(linear(5, kind.curl))}`,
        `wavelength_m = ${number(linear(0.03, 0.08))}`);
    } else {
      lines.push('shape = "helix"', `curl_radius_m = ${number(1 / linear(10, kind.curl))}`,
        `curl_pitch_m = ${number(linear(0.02, 0.1))}`);
    }
  }
  const drives = {
    fixed: [],
    shake: [`direction = [${pick(['1, 0, 0', '0, 1, 0', '1, 1, 0'])}]`,
      `amplitude_m = ${number(linear(0.005, 0.03))}`, `frequency_hz = ${number(linear(1, 3))}`],
    swing: ['direction = [1, 0, 0]', `amplitude_m = ${number(linear(0.02, 0.06))}`,
      `frequency_hz = ${number(linear(0.5, 2))}`],
    stop: ['direction = [0, 1, 0]', `speed_m_s = ${number(linear(0.5, 2))}`,
      `time_s = ${number(linear(0.01, 0.05))}`],
  };
  const drive = name === 'groom' ? 'fixed' : pick(Object.keys(drives));
  lines.push('[root]', `motion = "${drive}"`, ...drives[drive], '[effects.gravity]');
  if (random() < 0.25) {
    lines.push('[effects.wind]',
      `velocity_m_s = [${number(linear(0.5, 3))}, ${number(linear(0, 1))}, 0]`,
      'profile = "sine"', `frequency_hz = ${number(linear(0.5, 2))}`, 'law = "quadratic"',
      `strand_radius_m = ${number(radius)}`);
  }
  lines.push('[effects.linear_drag]', `drag_kg_m_s = ${number(between(kind.drag))}`);
  if (name !== 'groom' && !down && random() < 0.3) {
    lines.push('[effects.body]', 'shape = "sphere"',
      `centre_m = [${number(0.5 * length)}, ${number(0.05 * length)}, ${number(-0.35 * length)}]`,
      `radius_m = ${number(0.3 * length)}`, `friction = ${number(linear(0, 0.4))}`);
  }
  return { name: name.replace(' ', '_'), text: lines.join('\n') + '\n' };
}
