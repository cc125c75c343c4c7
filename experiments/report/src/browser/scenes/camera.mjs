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

export class Camera {
  azimuth = named_views.home.azimuth; // degrees from +x to +y, of the eye about the target
  elevation = named_views.home.elevation; // degrees above the horizon
  zoom = 1; // 1: the scene fills the picture; the eye stays where it is
  shift = [0, 0, 0]; // m, of the target off the middle of the scene

  // The scene lies in the ball about `middle`, m.
  constructor(middle, radius) {
    this.middle = middle;
    this.radius = radius;
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
    const scale = (this.zoom * Math.min(width, height)) / 2 / Math.tan(half_angle);
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
