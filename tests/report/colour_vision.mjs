// How well two colours are told apart, also by people with a deficiency of colour vision.

// Linear sRGB as seen without red or without green cones: Machado, Oliveira and Fernandes, "A
// physiologically-based model for simulation of color vision deficiency", 2009, severity 1.
const visions = {
  usual: [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  protanopia: [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  deuteranopia: [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
};

const linear_of = (hex) =>
  [1, 3, 5]
    .map((i) => parseInt(hex.slice(i, i + 2), 16) / 255)
    .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const luminance_row = [0.2126, 0.7152, 0.0722];
const xyz_rows = [[0.4124, 0.3576, 0.1805], luminance_row, [0.0193, 0.1192, 0.9505]];
const white = [0.9505, 1, 1.089];

function lab_of(rgb) {
  const [x, y, z] = xyz_rows
    .map((row, i) => dot(row, rgb) / white[i])
    .map((t) => (t > 0.008856 ? Math.cbrt(t) : 7.787 * t + 16 / 116));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

const seen = (hex, vision) =>
  lab_of(
    visions[vision].map((row) => Math.min(1, Math.max(0, dot(row, linear_of(hex))))),
  );

// Relative luminance as CIE L*, from 0 to 100.
export const lightness = (hex) => lab_of(linear_of(hex))[0];

// WCAG 2: from 1 to 21.
export function contrast(a, b) {
  const [low, high] = [a, b]
    .map((hex) => dot(luminance_row, linear_of(hex)))
    .sort((x, y) => x - y);
  return (high + 0.05) / (low + 0.05);
}

// The difference in L*, a*, b* that half of all viewers notice between marks of a size in degrees:
// Stone, Szafir and Setlur, "An engineering model for color difference as a function of size",
// 2014. It grows in proportion to the share of viewers.
const noticed = (degrees) =>
  [
    [10.16, 1.5],
    [10.68, 3.08],
    [10.7, 5.74],
  ].map(([large, small]) => 0.5 * (large + small / degrees));

// At 96 pixels per inch and 60 cm a pixel is 0.0253 degrees. The smallest marks of series that
// must be told apart are 42 square pixels, 6.5 across; the smallest cells 12 by 18.
export const degrees = { mark: 0.16, cell: 0.3 };

// The least difference of two colours over all kinds of vision, in such noticeable differences.
export const told_apart = (a, b, size = degrees.mark) =>
  Math.min(
    ...Object.keys(visions).map((vision) => {
      const [p, q] = [a, b].map((hex) => seen(hex, vision));
      const unit = noticed(size);
      return Math.hypot(...p.map((x, i) => (x - q[i]) / unit[i]));
    }),
  );
