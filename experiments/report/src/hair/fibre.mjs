// Light scattered by one hair [Marschner 2003]: S cos(theta_i) as the sum over the lobes R,
// TT and TRT of M(theta_i, theta_r) N(theta_d, phi), 1/sr. Angles in radians: theta above
// the plane across the hair, positive towards its tip; phi between the directions to the
// light and to the eye, seen along the hair; theta_d = |theta_r - theta_i| / 2.
//
// M is the function of [D'Eon 2011] in place of the paper's Gaussian, which does not keep
// the energy of light that comes in obliquely; widths and tilts are the paper's. N sums the
// paths over the offset h across the hair, as the paper does through the roots of phi(h), and
// is blurred about the hair: that bounds its caustics, which the paper takes out by hand. Paths of more than one inner reflection, which the paper leaves out,
// go evenly to all azimuths with the lobe TRT, so that no energy is lost. The hair is round:
// glints of an elliptic one are left out.
//
// theta_d is not one angle where light leaves obliquely through a wide lobe: R, reflected
// there more and more, takes up the light of other theta_d than TT gives up, and the sum
// of the lobes is off what came in. M is divided by that sum for a hair without absorption,
// as M of [D'Eon 2011] is by its own; the scale is that of theta_r alone.
//
// The tables below are all that the shader has: `scattered` reads them as it does.

const degree = Math.PI / 180;

// Table 1 of the paper; absorption per radius (red, green, blue) of brown hair, chosen by eye.
export const brown_hair = {
  index: 1.55,
  tilt: -7.5 * degree, // of R in theta_h = (theta_i + theta_r) / 2: twice that in theta_r
  width: 7.5 * degree, // of R in theta_h
  blur: 12 * degree, // about the hair
  absorption: [0.2, 0.42, 0.9],
};

// Tilt and width of R, TT, TRT, times those of R.
const tilts = [1, -1 / 2, -3 / 2];
const widths = [1, 1 / 2, 2];

// Part of the unpolarised light that a dielectric of this index reflects, by the cosine of
// the angle of incidence.
export function fresnel(cosine, index) {
  const inner = Math.sqrt(Math.max(0, 1 - (1 - cosine * cosine) / (index * index)));
  const across = (cosine - index * inner) / (cosine + index * inner);
  const along = (index * cosine - inner) / (index * cosine + inner);
  return 0.5 * (across * across + along * along);
}

// exp(-x) I0(x), for all x >= 0 to 1e-7 [Abramowitz 1964, 9.8.1 and 9.8.2].
function bessel_i0_scaled(x) {
  const sum = (coefficients, t) => coefficients.reduceRight((s, c) => s * t + c, 0);
  if (x < 3.75)
    return (
      Math.exp(-x) *
      sum(
        [1, 3.5156229, 3.0899424, 1.2067492, 0.2659732, 0.0360768, 0.0045813],
        (x / 3.75) ** 2,
      )
    );
  return (
    sum(
      [
        0.39894228, 0.01328592, 0.00225319, -0.00157565, 0.00916281, -0.02057706,
        0.02635537, -0.01647633, 0.00392377,
      ],
      3.75 / x,
    ) / Math.sqrt(x)
  );
}

// M of lobe p, 1/rad: the integral of M cos(theta_i) over theta_i is 1 [D'Eon 2011].
export function longitudinal({ tilt, width }, p, theta_i, theta_r) {
  const variance = (2 * widths[p] * width) ** 2;
  const turned = theta_r - 2 * tilts[p] * tilt;
  const a = Math.abs(Math.cos(theta_i) * Math.cos(turned)) / variance;
  const b = (Math.sin(theta_i) * Math.sin(turned)) / variance;
  // exp(-b) I0(a) / (2 v sinh(1 / v)) without numbers too large.
  return (
    (bessel_i0_scaled(a) * Math.exp(a - b - 1 / variance)) /
    (variance * (1 - Math.exp(-2 / variance)))
  );
}

// The path of order p (R: 0) that enters at h in (-1, 1): where it leaves about the hair,
// and the parts of red, green and blue that arrive there.
export function path({ index, absorption }, p, theta_d, h) {
  const cosine_d = Math.cos(theta_d);
  const seen_index = Math.sqrt(index * index - Math.sin(theta_d) ** 2) / cosine_d;
  const inside = h / seen_index;
  const phi = 2 * p * Math.asin(inside) - 2 * Math.asin(h) + p * Math.PI;
  const reflected = fresnel(cosine_d * Math.sqrt(1 - h * h), index);
  if (p === 0) return { phi, parts: [reflected, reflected, reflected] };
  // Once through the hair, in radii; the refracted ray's own inclination lengthens it.
  const length =
    (2 * Math.sqrt(1 - inside * inside)) /
    Math.sqrt(1 - (Math.sin(theta_d) / index) ** 2);
  const parts = absorption.map(
    (a) => (1 - reflected) ** 2 * reflected ** (p - 1) * Math.exp(-a * length * p),
  );
  return { phi, parts };
}

// What stays in the hair for a third inner path and all later ones, a geometric series.
export function later_paths({ index, absorption }, theta_d, h) {
  const third = path({ index, absorption }, 3, theta_d, h).parts;
  const second = path({ index, absorption }, 2, theta_d, h).parts;
  return third.map((part, c) => (second[c] > 0 ? part / (1 - part / second[c]) : 0));
}

export const sizes = { azimuths: 128, inclinations: 48, thetas: 128 };
const offset_count = 400; // across the hair

// Circular convolution with a Gaussian of this standard deviation (bins); the density is
// even in phi and given for 0 .. pi.
function blurred(density, deviation) {
  const n = density.length;
  const reach = Math.ceil(4 * deviation);
  const weights = Array.from({ length: 2 * reach + 1 }, (_, i) =>
    Math.exp(-(((i - reach) / deviation) ** 2) / 2),
  );
  const all = weights.reduce((sum, w) => sum + w, 0);
  const mirrored = (i) => (i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i);
  return density.map(
    (_, i) =>
      weights.reduce((sum, w, k) => sum + w * density[mirrored(i + k - reach)], 0) / all,
  );
}

// N of the lobes at one theta_d, 1/rad: of R [value], of TT and TRT [red, green, blue], each
// at the middles of the bins of phi in 0 .. pi.
export function azimuthal(hair, theta_d, bins = sizes.azimuths, offsets = offset_count) {
  const bin = Math.PI / bins;
  const lobes = [0, 1, 2].map(() => [0, 1, 2].map(() => new Array(bins).fill(0)));
  const later = [0, 0, 0];
  for (let i = 0; i < offsets; ++i) {
    // h and -h leave at phi and -phi: half of the hair is enough.
    const h = (i + 0.5) / offsets;
    for (let p = 0; p < 3; ++p) {
      const { phi, parts } = path(hair, p, theta_d, h);
      const folded = Math.abs(Math.atan2(Math.sin(phi), Math.cos(phi)));
      const k = Math.min(bins - 1, Math.floor(folded / bin));
      for (let c = 0; c < 3; ++c) lobes[p][c][k] += parts[c] / (2 * offsets * bin);
    }
    later_paths(hair, theta_d, h).forEach((part, c) => (later[c] += part / offsets));
  }
  const [[r], tt, trt] = lobes.map((lobe) =>
    lobe.map((density) => blurred(density, hair.blur / bin)),
  );
  return {
    r,
    tt,
    trt: trt.map((density, c) => density.map((x) => x + later[c] / (2 * Math.PI))),
  };
}

// Parts of the light that the lobes R, TT and TRT (and what comes later) of a hair without
// absorption carry; their sum is 1.
function shares(hair, theta_d, offsets = 100) {
  const white = { ...hair, absorption: [0] };
  const sums = [0, 0, 0];
  for (let i = 0; i < offsets; ++i) {
    const h = (i + 0.5) / offsets;
    for (let p = 0; p < 3; ++p) sums[p] += path(white, p, theta_d, h).parts[0] / offsets;
    sums[2] += later_paths(white, theta_d, h)[0] / offsets;
  }
  return sums;
}

// M of the three lobes at `thetas` inclinations of light and eye, over what a hair without
// absorption would send out to that eye.
function longitudinal_tables(hair) {
  const { thetas } = sizes;
  const along = new Float32Array(4 * thetas * thetas);
  const theta = (i) => ((i + 0.5) / thetas - 0.5) * Math.PI;
  // theta_d is half of a number of places.
  const carried = Array.from({ length: thetas }, (_, i) =>
    shares(hair, ((i / thetas) * Math.PI) / 2),
  );
  for (let row = 0; row < thetas; ++row) {
    const lobes = Array.from({ length: thetas }, (_, k) =>
      [0, 1, 2].map((p) => longitudinal(hair, p, theta(k), theta(row))),
    );
    const sent = lobes.reduce((sum, lobe, k) => {
      const parts = carried[Math.abs(row - k)];
      return sum + Math.cos(theta(k)) * lobe.reduce((s, m, p) => s + m * parts[p], 0);
    }, 0);
    const scale = thetas / (Math.PI * sent);
    lobes.forEach((lobe, k) =>
      along.set(
        lobe.map((m) => scale * m),
        4 * (row * thetas + k),
      ),
    );
  }
  return along;
}

// The tables as pictures of four numbers a place, row after row. `through`: TT and R over
// phi (columns) and theta_d in 0 .. pi / 2 (rows); `back`: TRT; `along`: M of R, TT, TRT over
// theta_i (columns) and theta_r (rows) in -pi / 2 .. pi / 2. Values at the middles of places.
// `albedo`: the part of light from everywhere that leaves the hair, seen from its side.
export function tables_of(hair) {
  const { azimuths, inclinations, thetas } = sizes;
  const through = new Float32Array(4 * azimuths * inclinations);
  const back = new Float32Array(4 * azimuths * inclinations);
  for (let row = 0; row < inclinations; ++row) {
    const { r, tt, trt } = azimuthal(hair, ((row + 0.5) / inclinations) * (Math.PI / 2));
    for (let k = 0; k < azimuths; ++k) {
      const at = 4 * (row * azimuths + k);
      through.set([tt[0][k], tt[1][k], tt[2][k], r[k]], at);
      back.set([trt[0][k], trt[1][k], trt[2][k], 0], at);
    }
  }
  const side = azimuthal(hair, 0);
  const bin = Math.PI / azimuths;
  const albedo = [0, 1, 2].map((c) =>
    side.r.reduce((sum, r, k) => sum + 2 * bin * (r + side.tt[c][k] + side.trt[c][k]), 0),
  );
  return {
    through: { width: azimuths, height: inclinations, data: through },
    back: { width: azimuths, height: inclinations, data: back },
    along: { width: thetas, height: thetas, data: longitudinal_tables(hair) },
    albedo,
  };
}

// The place (x, y), parts of the width and height, as a texture of linear filter that is
// clamped to its edge gives it.
function looked_up({ width, height, data }, x, y) {
  const kept = (i, n) => Math.max(0, Math.min(n - 1, i));
  const [fx, fy] = [x * width - 0.5, y * height - 0.5];
  const [x0, y0] = [Math.floor(fx), Math.floor(fy)];
  const at = (i, j, c) => data[4 * (kept(j, height) * width + kept(i, width)) + c];
  return [0, 1, 2, 3].map((c) => {
    const row = (j) => at(x0, j, c) + (fx - x0) * (at(x0 + 1, j, c) - at(x0, j, c));
    return row(y0) + (fy - y0) * (row(y0 + 1) - row(y0));
  });
}

// S cos(theta_i), 1/sr, of red, green, blue, of each lobe: what the shader adds up.
export function scattered_by_lobe({ through, back, along }, theta_i, theta_r, phi) {
  const theta_d = Math.abs(theta_r - theta_i) / 2;
  const [x, y] = [phi / Math.PI, theta_d / (Math.PI / 2)];
  const m = looked_up(along, theta_i / Math.PI + 0.5, theta_r / Math.PI + 0.5);
  const [red, green, blue, r] = looked_up(through, x, y);
  const trt = looked_up(back, x, y);
  return [
    [r, r, r].map((n) => m[0] * n),
    [red, green, blue].map((n) => m[1] * n),
    trt.slice(0, 3).map((n) => m[2] * n),
  ];
}

export const scattered = (tables, theta_i, theta_r, phi) =>
  scattered_by_lobe(tables, theta_i, theta_r, phi).reduce((sum, lobe) =>
    sum.map((s, c) => s + lobe[c]),
  );
