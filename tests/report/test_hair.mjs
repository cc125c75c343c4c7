// Light scattered by a hair, as the tables of the player's shader hold it:
// `node --test tests/report/test_hair.mjs`.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  azimuthal,
  brown_hair,
  fresnel,
  later_paths,
  longitudinal,
  path,
  scattered,
  tables_of,
} from '../../experiments/report/src/hair/fibre.mjs';

const degree = Math.PI / 180;
const white_hair = { ...brown_hair, absorption: [0, 0, 0] };
const white = tables_of(white_hair);
const brown = tables_of(brown_hair);

// The middles of n intervals of [from, to], and their width.
const middles = (from, to, n) =>
  Array.from({ length: n }, (_, i) => from + ((i + 0.5) / n) * (to - from));
const sum = (list, of) => list.reduce((total, x) => total + of(x), 0);

test('Fresnel_IsThatOfADielectric', () => {
  assert.ok(Math.abs(fresnel(1, 1.55) - (0.55 / 2.55) ** 2) < 1e-15);
  assert.ok(Math.abs(fresnel(0, 1.55) - 1) < 1e-15);
  // At Brewster's angle only the part across the plane is left, half of ((n^2-1)/(n^2+1))^2.
  const n2 = 1.55 ** 2;
  const wanted = 0.5 * ((n2 - 1) / (n2 + 1)) ** 2;
  assert.ok(Math.abs(fresnel(Math.cos(Math.atan(1.55)), 1.55) - wanted) < 1e-15);
});

// Table 1 of [Marschner 2003]: in theta_h the lobes lie at alpha, -alpha/2 and -3 alpha/2,
// in theta_r at -theta_i and twice that. M's maximum is that of
// exp(cos(theta_i + theta_r) / v) / sqrt(cos(theta_r)), v the variance: off the mirrored
// direction by v tan(theta_i) / 2 to first order, of which the second order is below half here.
test('Lobes_LieAtThePublishedAngles', () => {
  const step = 0.1;
  const shifts = [2, -1, -3].map((times) => times * brown_hair.tilt);
  for (const incoming of [-30, 0, 30])
    [0, 1, 2].forEach((p) => {
      if (p === 2 && incoming !== 0) return; // so wide that the root of the cosine rules
      const variance = (2 * [1, 0.5, 2][p] * brown_hair.width) ** 2;
      const values = middles(-80, 80, 160 / step).map((out) => [
        longitudinal(brown_hair, p, incoming * degree, out * degree),
        out,
      ]);
      const [, peak] = values.reduce((best, value) =>
        value[0] > best[0] ? value : best,
      );
      const wanted = -incoming + shifts[p] / degree;
      const allowed =
        step + (0.75 * variance * Math.abs(Math.tan(incoming * degree))) / degree;
      assert.ok(
        Math.abs(peak - wanted) <= allowed,
        `${p} ${incoming}: ${peak}, ${wanted}`,
      );
    });
});

// Middle rule of n intervals d wide: d^2/24 times the difference of the slopes at the ends,
// where M cos(theta_i) falls to 0 with the slope M <= 1/v on one side at least; the Bessel
// function is good to 2e-7.
test('Longitudinal_IsADensity', () => {
  for (const p of [0, 1, 2])
    for (const out of [-70, -20, 0, 45, 85]) {
      const angles = middles(-Math.PI / 2, Math.PI / 2, 400);
      const all =
        (Math.PI / 400) *
        sum(angles, (i) => longitudinal(brown_hair, p, i, out * degree) * Math.cos(i));
      const variance = (2 * [1, 0.5, 2][p] * brown_hair.width) ** 2;
      const allowed = ((Math.PI / 400) ** 2 / 24) * (1.1 / variance) + 1e-6;
      assert.ok(Math.abs(all - 1) < allowed, `${p} ${out}: ${all}`);
    }
});

// Of R phi = -2 asin(h), so that N = F cos(phi / 2) / 4; of TT N = A / (2 |dphi/dh|), the
// paper's sum over the roots of phi(h). A bin holds more than 100 of the 20000 offsets, and the blur over one
// bin moves a density by half its second derivative times the bin squared: together below 3 %.
test('Azimuthal_IsThePapersSumOverRoots', () => {
  const bins = 128;
  const bin = Math.PI / bins;
  const sharp = { ...brown_hair, blur: bin };
  const { r, tt } = azimuthal(sharp, 0, bins, 20000);
  for (const k of [10, 40, 70, 100]) {
    const half = Math.abs(Math.cos(((k + 0.5) * bin) / 2));
    const wanted = (fresnel(half, sharp.index) * half) / 4;
    assert.ok(Math.abs(r[k] - wanted) < 0.03 * wanted, `R ${k}: ${r[k]}, ${wanted}`);
  }
  for (const h of [0.1, 0.3, 0.5, 0.7]) {
    const { phi, parts } = path(sharp, 1, 0, h);
    const slope =
      (path(sharp, 1, 0, h + 1e-5).phi - path(sharp, 1, 0, h - 1e-5).phi) / 2e-5;
    const k = Math.floor(Math.abs(phi) / bin);
    for (const c of [0, 1, 2]) {
      const wanted = parts[c] / (2 * Math.abs(slope));
      assert.ok(
        Math.abs(tt[c][k] - wanted) < 0.03 * wanted,
        `TT ${h}: ${tt[c][k]}, ${wanted}`,
      );
    }
  }
});

// Light of radiance 1 from everywhere: what a hair sends out, by the shader's own tables.
function furnace(tables, out) {
  const incoming = middles(-Math.PI / 2, Math.PI / 2, 120);
  const around = middles(0, Math.PI, 48);
  const cell = (Math.PI / 120) * (Math.PI / 48) * 2; // phi and -phi
  return [0, 1, 2].map((c) =>
    sum(
      incoming,
      (i) => Math.cos(i) * cell * sum(around, (phi) => scattered(tables, i, out, phi)[c]),
    ),
  );
}

test('Furnace_KeepsTheEnergyOfAHairWithoutAbsorption', (context) => {
  const inclinations = [-85, -60, 0, 15, 30, 45, 60, 75, 80, 85, 88];
  const found = inclinations.map((out) => [out, furnace(white, out * degree)[0]]);
  context.diagnostic(
    `white hair: ${found.map(([o, e]) => `${o}: ${e.toFixed(4)}`).join(', ')}`,
  );
  for (const [out, energy] of found)
    assert.ok(Math.abs(energy - 1) < 0.05, `${out} degrees: ${energy}`);
  // Over all inclinations, by what of the hair is seen.
  const all = middles(-Math.PI / 2, Math.PI / 2, 12);
  const seen = (out) => Math.cos(out) ** 2;
  const mean = sum(all, (out) => seen(out) * furnace(white, out)[0]) / sum(all, seen);
  context.diagnostic(`mean ${mean.toFixed(4)}`);
  assert.ok(Math.abs(mean - 1) < 0.05, `${mean}`);
});

test('Furnace_OfBrownHairLosesBlueFirst', () => {
  const [red, green, blue] = furnace(brown, 0);
  assert.ok(1 > red && red > green && green > blue && blue > 0, `${[red, green, blue]}`);
  brown.albedo.forEach((part, c) => {
    const measured = furnace(brown, 0)[c];
    assert.ok(Math.abs(part - measured) < 0.05, `${c}: ${part}, ${measured}`);
  });
});

// R, TT, TRT and what comes later are all of the light, at every offset and inclination.
test('Paths_ShareTheLightOfEveryRay', () => {
  for (const theta of [0, 0.5, 1.2])
    for (const h of [0, 0.4, 0.9]) {
      const lobes = sum([0, 1, 2], (p) => path(white_hair, p, theta, h).parts[0]);
      const all = lobes + later_paths(white_hair, theta, h)[0];
      assert.ok(Math.abs(all - 1) < 1e-12, `${theta} ${h}: ${all}`);
    }
});
