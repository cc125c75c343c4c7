// Bodies as the eye sees them: what they hide, and their outlines on the picture.
import { pose_at } from './data.mjs';
import { add, cross, dot, project } from './camera.mjs';
import { css } from './colours.mjs';

const turn = 2 * Math.PI;
const corners = 96;

// Points of the circle about `centre` with the two half axes.
const circle = (centre, a, b, count = corners) =>
  Array.from({ length: count }, (_, k) =>
    add(add(centre, a, Math.cos((turn * k) / count)), b, Math.sin((turn * k) / count)),
  );

const scaled = (v, s) => [v[0] * s, v[1] * s, v[2] * s];
const unit = (v) => scaled(v, 1 / Math.hypot(...v));

// Two directions across `axis`.
function across(axis) {
  const a = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  return [a, cross(axis, a)];
}

// Where the eye at `e` sees the edge of the unit ball about the origin: the circle of
// points n with n.e = 1. Undefined from inside.
function edge_of_unit_ball(e) {
  const far = Math.hypot(...e);
  if (far <= 1) return undefined;
  const radius = Math.sqrt(1 - 1 / far ** 2);
  const [a, b] = across(scaled(e, 1 / far));
  return circle(scaled(e, 1 / far ** 2), scaled(a, radius), scaled(b, radius));
}

// Convex hull by Andrew's monotone chain.
function hull(points) {
  const sorted = [...points].sort((p, q) => p.x - q.x || p.y - q.y);
  const half = (list) => {
    const out = [];
    for (const p of list) {
      const left = (a, b) => (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0;
      while (out.length > 1 && !left(out.at(-2), out.at(-1))) out.pop();
      out.push(p);
    }
    return out.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

// Whether an ellipsoid stands between eye and point: with `rows` (axes divided by the half
// axes) it is the unit ball, and the ray eye + t d meets |eye + t d|^2 = 1 at a t in (0, 1).
// A point on the surface itself is seen. Called for every point of every strand: plain
// numbers, no arrays.
function ball_test([r, s, q], centre, view_eye) {
  const [ox, oy, oz] = add(view_eye, centre, -1);
  const ex = r[0] * ox + r[1] * oy + r[2] * oz;
  const ey = s[0] * ox + s[1] * oy + s[2] * oz;
  const ez = q[0] * ox + q[1] * oy + q[2] * oz;
  const c = ex * ex + ey * ey + ez * ez - 1;
  return (point) => {
    const x = point[0] - view_eye[0];
    const y = point[1] - view_eye[1];
    const z = point[2] - view_eye[2];
    const dx = r[0] * x + r[1] * y + r[2] * z;
    const dy = s[0] * x + s[1] * y + s[2] * z;
    const dz = q[0] * x + q[1] * y + q[2] * z;
    const b = ex * dx + ey * dy + ez * dz;
    const a = dx * dx + dy * dy + dz * dz;
    const root = b * b - a * c;
    return c > 0 && b < 0 && root > 0 && -b - Math.sqrt(root) < 0.999 * a;
  };
}

// Ball, ellipsoid: the unit ball in local components divided by the half axes.
function ellipsoid({ half_axes_m: half }, { centre, axes }, view) {
  const rows = axes.map((axis, i) => scaled(axis, 1 / half[i]));
  const world = (n) =>
    axes.reduce((sum, axis, i) => add(sum, axis, half[i] * n[i]), centre);
  const eye = rows.map((row) => dot(row, add(view.eye, centre, -1)));
  const edge = edge_of_unit_ball(eye);
  const meridians = [
    circle([0, 0, 0], [1, 0, 0], [0, 1, 0]),
    circle([0, 0, 0], [0, 1, 0], [0, 0, 1]),
    circle([0, 0, 0], [0, 0, 1], [1, 0, 0]),
  ];
  return {
    outline: edge?.map((n) => project(view, world(n))),
    // Only what lies on the eye's side of the edge.
    lines: meridians.map((line) =>
      [...line, line[0]].map((n) =>
        dot(n, eye) >= 1 ? project(view, world(n)) : undefined,
      ),
    ),
    hides: ball_test(rows, centre, view.eye),
  };
}

// Least distance between the pieces p..p+u and q..q+v, by the closest points of the two
// lines, kept on the pieces one after the other.
function piece_distance(p, u, q, v) {
  const w = add(p, q, -1);
  const [a, b, c, d, e] = [dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)];
  const keep = (s) => Math.max(0, Math.min(1, s));
  const parallel = a * c - b * b < 1e-12 * a * c;
  const t = keep(parallel ? 0 : (b * e - c * d) / (a * c - b * b));
  const s = keep((b * t + e) / c);
  const back = keep((b * s - d) / a);
  return Math.hypot(...add(add(w, u, back), v, -s));
}

// half_axes_m: radius, radius, half the distance between the centres of the caps, which lie
// on local z.
function capsule({ half_axes_m: [radius, , half] }, { centre, axes }, view) {
  const axis = axes[2];
  const ends = [add(centre, axis, half), add(centre, axis, -half)];
  const caps = ends.map((end) => {
    const edge = edge_of_unit_ball(scaled(add(view.eye, end, -1), 1 / radius));
    return edge?.map((n) => project(view, add(end, n, radius)));
  });
  const along = scaled(axis, 2 * half);
  const reach = 1 / (radius + half);
  const near = ball_test(
    axes.map((local) => scaled(local, reach)),
    centre,
    view.eye,
  );
  const [a, b] = across(axis);
  const rings = ends.map((end) =>
    circle(end, scaled(a, radius), scaled(b, radius)).map((point) =>
      dot(add(point, end, -1), add(view.eye, point, -1)) > 0
        ? project(view, point)
        : undefined,
    ),
  );
  return {
    outline: caps.includes(undefined) ? undefined : hull(caps.flat()),
    lines: rings.map((ring) => [...ring, ring[0]]),
    hides: (point) =>
      near(point) &&
      piece_distance(view.eye, add(point, view.eye, -1), ends[1], along) < 0.995 * radius,
  };
}

// The plane through the pose's centre with normal local z: a patch about the middle of the
// scene with a grid, see-through; it hides what lies on its other side.
function plane(_, { centre, axes: [a, b, normal] }, view, { middle, radius }) {
  const height = (point) => dot(add(point, centre, -1), normal);
  const foot = add(middle, normal, -height(middle));
  const at = (x, y) => project(view, add(add(foot, a, x), b, y));
  const size = 1.6 * radius;
  const step = size / 8;
  const ticks = Array.from({ length: 17 }, (_unused, k) => (k - 8) * step);
  return {
    flat: true,
    outline: [at(-size, -size), at(size, -size), at(size, size), at(-size, size)],
    lines: ticks.flatMap((t) => [
      [at(-size, t), at(size, t)],
      [at(t, -size), at(t, size)],
    ]),
    hides: (point) => height(point) < -1e-6 * radius !== height(view.eye) < 0,
  };
}

const makers = { plane, sphere: ellipsoid, ellipsoid, capsule };

// The bodies at `moment`, from the back to the front: those behind a plane, planes, the
// others, each by the distance of their centres. `scene` has the middle and radius (m) of
// what is shown.
export function bodies_at(bodies, moment, view, scene) {
  const seen = bodies.map((body) => {
    const pose = pose_at(body, moment);
    const { centre } = pose;
    const distance = Math.hypot(...add(centre, view.eye, -1));
    return { centre, distance, ...makers[body.shape](body, pose, view, scene) };
  });
  const planes = seen.filter(({ flat }) => flat);
  const group = ({ flat, centre }) =>
    flat ? 1 : planes.some((plane) => plane.hides(centre)) ? 2 : 0;
  return seen
    .filter(({ outline }) => outline !== undefined)
    .sort((p, q) => group(q) - group(p) || q.distance - p.distance);
}

// Draws one of them: a shaded face, faint lines that show how it turns.
export function draw_body(context, { outline, lines, flat }, { body }) {
  const trace = (points) => {
    let down = false;
    for (const point of points) {
      if (point === undefined) down = false;
      else if (down) context.lineTo(point.x, point.y);
      else context.moveTo(point.x, point.y);
      down = point !== undefined;
    }
  };
  context.beginPath();
  trace(outline);
  context.closePath();
  if (flat) {
    context.fillStyle = css(body.floor, body.floor_part);
  } else {
    const xs = outline.map((p) => p.x);
    const ys = outline.map((p) => p.y);
    const [left, right] = [Math.min(...xs), Math.max(...xs)];
    const [top, bottom] = [Math.min(...ys), Math.max(...ys)];
    const size = Math.max(right - left, bottom - top);
    const [x, y] = [left + 0.35 * (right - left), top + 0.28 * (bottom - top)];
    const gradient = context.createRadialGradient(x, y, 0, x, y, 0.85 * size);
    gradient.addColorStop(0, css(body.light));
    gradient.addColorStop(1, css(body.dark));
    context.fillStyle = gradient;
  }
  context.fill();
  context.strokeStyle = css(body.line, body.line_part);
  context.lineWidth = 1;
  context.beginPath();
  lines.forEach(trace);
  context.stroke();
}
