// Colours of the 3D picture: the page's own, and the ramp of a channel.
import { order_colours } from '../../../figures/palette.mjs';

const parse = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
const mix = (a, b, part) => a.map((x, i) => (1 - part) * x + part * b[i]);
export const css = (rgb, part = 1) => `rgb(${rgb.map(Math.round).join(' ')} / ${part})`;

// Low to high; on a dark page lighter, as thin strands need.
const stops = [...order_colours].reverse().map(parse);
const stops_on_dark = stops.map((rgb) => mix(rgb, [255, 255, 255], 0.25));

function ramp(part, colours) {
  const at = part * (colours.length - 1);
  const i = Math.min(Math.floor(at), colours.length - 2);
  return mix(colours[i], colours[i + 1], at - i);
}

// Without a channel: browns that tell neighbouring strands apart, darker on a light page.
const hair = {
  light: [parse('#4a2c17'), parse('#a8703c')],
  dark: [parse('#a8784a'), parse('#ecc894')],
};

export function page_theme_colours() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => parse(style.getPropertyValue(name).trim());
  const card = colour('--card');
  const text = colour('--text');
  const dark = card[0] < 128;
  const [first, last] = dark ? hair.dark : hair.light;
  const channel = dark ? stops_on_dark : stops;
  const body = {
    light: mix(card, text, dark ? 0.38 : 0.1),
    dark: mix(card, text, dark ? 0.12 : 0.36),
    line: text,
    line_part: 0.16,
    floor: mix(card, text, 0.25),
    floor_part: 0.45,
  };
  return {
    background: card,
    text: css(text),
    muted: css(colour('--muted')),
    force: dark ? '#ff8f6b' : '#c2370f',
    body,
    hair: (part) => mix(first, last, part),
    channel: (part) => ramp(part, channel),
    channel_bar: `linear-gradient(to right, ${channel.map(css).join(', ')})`,
  };
}
