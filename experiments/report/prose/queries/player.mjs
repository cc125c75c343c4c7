// How long a picture of the page's player takes.
import { number, row_of } from '../markdown.mjs';

const smooth_1_s = 30;

export const pictures = (tables) => {
  const row = (draw, colour) => row_of(tables, 'player', { draw, colour });
  const [canvas, webgl, hair] = [
    row('canvas', 'strand'),
    row('webgl', 'strand'),
    row('webgl', 'hair'),
  ];
  const rate = (one) => number(1000 / one.picture_ms, 2);
  const enough = canvas.picture_ms <= 1000 / smooth_1_s ? 'at least' : 'not';
  return (
    `With software rendering, ${number(canvas.hairs)} hairs of ${number(canvas.points)} points at ` +
    `${number(canvas.width)} x ${number(canvas.height)} are drawn ${rate(canvas)} times a second on the canvas (${enough} the ${smooth_1_s} ` +
    `that look smooth), ${rate(webgl)} times with WebGL, and ${rate(hair)} times as hair in light, in headless Chromium.`
  );
};
