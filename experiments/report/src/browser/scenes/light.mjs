// The light of the picture, and colours between its sRGB [IEC 61966-2-1] and linear light.

// On hair: irradiance of a light across it, radiance from everywhere (of which a part reaches
// what lies deep), and how strongly hair shades; chosen by eye.
export const on_hair = { sun: 11, sky: 0.22, deep: 0.3, shadow: 1 };

// Unit vector towards the light, which comes from above and beside the eye.
export function towards_light({ right, up, forward }) {
  const v = [0, 1, 2].map((i) => 0.5 * up[i] - 0.4 * right[i] - 0.77 * forward[i]);
  return v.map((x) => x / Math.hypot(...v));
}

// Linear light of 0 .. 255.
export const linear_of = (c) =>
  c <= 10.31475 ? c / 3294.6 : ((c / 255 + 0.055) / 1.055) ** 2.4;
export const linear = (rgb) => rgb.map(linear_of);

const steps = 4096; // of linear light: finer than a level of 255 but near black

// The level 0 .. 255 of i / steps, and linear light of i / 4 levels.
export const levels = Uint8Array.from({ length: steps + 1 }, (_, i) => {
  const c = i / steps;
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
});
export const level_steps = steps;
export const quarter_levels = Float32Array.from({ length: 1021 }, (_, i) =>
  linear_of(i / 4),
);
