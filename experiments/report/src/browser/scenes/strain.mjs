// Strain of the outer side of a bent strand: its curvature times its radius.
export function bending_strain({ channels, radius_m, starts, points }) {
  const curvature = channels.find(
    ({ name, unit }) => name === 'curvature' && unit === '1/m',
  );
  if (curvature === undefined || radius_m === undefined) return [];
  const radius = new Float64Array(points);
  radius_m.forEach((r, k) => radius.fill(r, starts[k], starts[k + 1]));
  const most = radius_m.reduce((a, b) => Math.max(a, b), 0);
  if (!(most > 0) || curvature.low !== 0) return [];
  const values = curvature.values.map((value, i) => (value * radius[i % points]) / most);
  return [
    { name: 'bending strain', unit: '', low: 0, high: curvature.high * most, values },
  ];
}
