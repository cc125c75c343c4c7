// The unit ball as triangles: {ball, indices}. Of each corner x, y, z and the half that it
// belongs to, -1 or 1; the equator is there twice, with a band between, so that the halves
// moved apart are a capsule.
export function unit_ball(around = 64, rings = 16) {
  const ball = [];
  const indices = [];
  const angles = Array.from({ length: rings + 1 }, (_, i) => (Math.PI / 2) * (i / rings));
  const latitudes = [
    ...angles.map((a) => [a - Math.PI / 2, -1]),
    ...angles.map((a) => [a, 1]),
  ];
  for (const [latitude, half] of latitudes)
    for (let k = 0; k <= around; ++k) {
      const [wide, turn] = [Math.cos(latitude), (2 * Math.PI * k) / around];
      ball.push(wide * Math.cos(turn), wide * Math.sin(turn), Math.sin(latitude), half);
    }
  const row = around + 1;
  for (let j = 0; j + 1 < latitudes.length; ++j)
    for (let k = 0; k < around; ++k) {
      const a = j * row + k;
      indices.push(a, a + 1, a + row, a + row, a + 1, a + row + 1);
    }
  return { ball, indices };
}
