// A camera that turns about a point of the scene; z is up.

export const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

const radians = Math.PI / 180;
// Half the opening angle of the view: wide enough for depth, small enough for true shapes.
const half_angle = 16 * radians;
const steepest = 89.9;

export const named_views = {
  home: { azimuth: -60, elevation: 15 },
  front: { azimuth: -90, elevation: 0 },
  side: { azimuth: 0, elevation: 0 },
  top: { azimuth: -90, elevation: steepest },
};

// What a scene reaches, as {rho, z} about the vertical through `middle` (m): the picture
// holds all of it from every azimuth, so that turning does not change its size.
export function profile_of(points, middle) {
  const slices = 24;
  const heights = points.map((point) => point[2] - middle[2]);
  const low = heights.reduce((a, b) => Math.min(a, b), 0);
  const high = heights.reduce((a, b) => Math.max(a, b), 0);
  const profile = new Map();
  points.forEach((point, i) => {
    const z = heights[i];
    const slice = Math.min(slices - 1, Math.floor((slices * (z - low)) / (high - low || 1)));
    const rho = Math.hypot(point[0] - middle[0], point[1] - middle[1]);
    const { rho: most = 0, low: least = z, high: top = z } = profile.get(slice) ?? {};
    profile.set(slice, {
      rho: Math.max(most, rho),
      low: Math.min(least, z),
      high: Math.max(top, z),
    });
  });
  return [...profile.values()].flatMap(({ rho, low: least, high: top }) => [
    { rho, z: least },
    { rho, z: top },
  ]);
}

const directions = Array.from({ length: 16 }, (_, k) => (Math.PI * k) / 8);
const filled = 0.92; // part of the picture's width or height

// Pixels for the tangent 1 of the angle off the middle, so that the profile turned to every
// azimuth just fits, seen from `distance` at the elevation with this cosine and sine.
function fit(profile, distance, cosine, sine, width, height) {
  let [wide, tall] = [1e-9, 1e-9];
  for (const { rho, z } of profile) {
    for (const direction of directions) {
      const away = rho * Math.cos(direction);
      const depth = distance + away * cosine - z * sine;
      wide = Math.max(wide, Math.abs(rho * Math.sin(direction)) / depth);
      tall = Math.max(tall, Math.abs(z * cosine + away * sine) / depth);
    }
  }
  return (filled / 2) * Math.min(width / wide, height / tall);
}

export class Camera {
  azimuth = named_views.home.azimuth; // degrees from +x to +y, of the eye about the target
  elevation = named_views.home.elevation; // degrees above the horizon
  zoom = 1; // 1: the scene fills the picture; the eye stays where it is
  shift = [0, 0, 0]; // m, of the target off the middle of the scene

  // The scene lies in the ball about `middle`, m; `profile`: what it fills of that.
  constructor(middle, radius, profile = [{ rho: radius, z: 0 }]) {
    this.middle = middle;
    this.radius = radius;
    this.profile = profile;
  }

  look(name) {
    Object.assign(this, named_views[name], { zoom: 1, shift: [0, 0, 0] });
  }

  turn(dx, dy) {
    this.azimuth = (((this.azimuth - 0.4 * dx) % 360) + 360) % 360;
    this.elevation = Math.max(-steepest, Math.min(steepest, this.elevation + 0.4 * dy));
  }

  magnify(factor) {
    this.zoom = Math.max(0.2, Math.min(50, this.zoom * factor));
  }

  // By pixels of a picture whose projection is `projection`.
  move(dx, dy, { right, up, distance, scale }) {
    const step = distance / scale;
    this.shift = add(add(this.shift, right, -dx * step), up, dy * step);
  }

  // 'azimuth,elevation,zoom,x,y,z', and back; a text that is none changes nothing.
  text() {
    const round = (value, digits) => Number(value.toFixed(digits));
    return [
      round(this.azimuth, 1),
      round(this.elevation, 1),
      round(this.zoom, 3),
      ...this.shift.map((value) => round(value, 4)),
    ].join(',');
  }
  read(text) {
    const numbers = text.split(',').map(Number);
    if (numbers.length < 3 || !numbers.every(Number.isFinite)) return;
    const [azimuth, elevation, zoom, ...shift] = numbers;
    this.azimuth = azimuth;
    this.elevation = Math.max(-steepest, Math.min(steepest, elevation));
    this.zoom = 1;
    this.magnify(zoom);
    this.shift = shift.length === 3 ? shift : [0, 0, 0];
  }

  // How points of the world fall on a picture of width x height pixels.
  projection(width, height) {
    const [a, e] = [this.azimuth * radians, this.elevation * radians];
    const forward = [
      -Math.cos(e) * Math.cos(a),
      -Math.cos(e) * Math.sin(a),
      -Math.sin(e),
    ];
    const right = [-Math.sin(a), Math.cos(a), 0];
    const up = cross(right, forward);
    const target = add(this.middle, this.shift);
    const distance = this.radius / Math.sin(half_angle);
    const eye = add(target, forward, -distance);
    const scale =
      this.zoom *
      fit(this.profile, distance, Math.cos(e), Math.sin(e), width, height);
    return { eye, forward, right, up, target, distance, scale, width, height };
  }
}

// {x, y} in pixels and the depth (m) of a point.
export function project({ eye, forward, right, up, scale, width, height }, point) {
  const from_eye = add(point, eye, -1);
  const depth = dot(from_eye, forward);
  const factor = scale / depth;
  return {
    x: width / 2 + factor * dot(from_eye, right),
    y: height / 2 - factor * dot(from_eye, up),
    depth,
  };
}
