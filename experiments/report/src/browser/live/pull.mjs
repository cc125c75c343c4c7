// A spring from the nearest point of the strand to the mouse, in the plane of the view.
import { add, project } from '../scenes/camera.mjs';

const reach = 16; // CSS pixels within which a point is taken

export const point_of = (positions, i) => [...positions.subarray(3 * i, 3 * i + 3)];
const distance = (a, b) => Math.hypot(...add(a, b, -1));

// The length of the line through the points `first` to `end`, the last one left out.
export function length_of(positions, first, end) {
  let length = 0;
  for (let i = first + 1; i < end; ++i)
    length += distance(point_of(positions, i), point_of(positions, i - 1));
  return length;
}

// The part of the strand's length up to each point of a line, from 0 to 1.
function parts(positions, { starts }, line) {
  const arc = [0];
  for (let i = starts[line] + 1; i < starts[line + 1]; ++i)
    arc.push(arc.at(-1) + distance(point_of(positions, i), point_of(positions, i - 1)));
  return arc.map((length) => length / (arc.at(-1) || 1));
}

// The strand of a line; none where strands branch, since a part of the length is then no place.
function strand_of({ strand_ids, starts }, line) {
  const ids = strand_ids ?? Array.from({ length: starts.length - 1 }, (_, i) => i);
  return ids.filter((id) => id === ids[line]).length === 1 ? ids[line] : undefined;
}

export class Pull {
  constructor(live, canvas) {
    this.live = live;
    this.canvas = canvas;
    canvas.addEventListener('pointerdown', (event) => this.#take(event));
    canvas.addEventListener('pointermove', (event) => this.#move(event));
    for (const name of ['pointerup', 'pointercancel'])
      canvas.addEventListener(name, () => this.#release());
  }

  #mouse(event) {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  #take(event) {
    const { live } = this;
    if (live.picture === undefined || event.button !== 0 || event.shiftKey) return;
    const mouse = this.#mouse(event);
    const view = live.picture.view();
    const positions = live.positions();
    let best = reach;
    let found;
    const { starts } = live.scene;
    for (let line = 0; line + 1 < starts.length; ++line)
      for (let i = starts[line]; i < starts[line + 1]; ++i) {
        const seen = project(view, point_of(positions, i));
        const away = Math.hypot(seen.x - mouse.x, seen.y - mouse.y);
        if (away <= best) [best, found] = [away, { i, line, depth: seen.depth }];
      }
    const strand = found && strand_of(live.scene, found.line);
    if (strand === undefined) return;
    event.stopImmediatePropagation();
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({ preventScroll: true });
    this.held = {
      ...found,
      strand,
      part: parts(positions, live.scene, found.line)[found.i - starts[found.line]],
      from: mouse,
      place: point_of(positions, found.i),
      target: point_of(positions, found.i),
    };
    this.#move(event);
  }

  #move(event) {
    const { held, live } = this;
    if (held === undefined) return;
    event.stopImmediatePropagation();
    const mouse = this.#mouse(event);
    const { right, up, scale } = live.picture.view();
    const metre = held.depth / scale;
    held.target = add(
      add(held.place, right, (mouse.x - held.from.x) * metre),
      up,
      (held.from.y - mouse.y) * metre,
    );
    live.send_last({
      do: 'pull',
      strand: held.strand,
      at: held.part,
      target: held.target,
      stiffness_n_m: Number(document.getElementById('live-stiffness').value),
    });
    live.changed();
  }

  #release() {
    if (this.held === undefined) return;
    this.held = undefined;
    this.live.send_last({ do: 'release' });
    this.live.changed();
  }

  draw(theme) {
    const { held, live, canvas } = this;
    if (held === undefined) return;
    const positions = live.positions();
    if (held.line + 1 >= live.scene.starts.length) return;
    const arc = parts(positions, live.scene, held.line);
    const nearest = arc.reduce(
      (best, part, i) =>
        Math.abs(part - held.part) < Math.abs(arc[best] - held.part) ? i : best,
      0,
    );
    const view = live.picture.view();
    const [from, to] = [
      point_of(positions, live.scene.starts[held.line] + nearest),
      held.target,
    ].map((point) => project(view, point));
    const context = canvas.getContext('2d');
    context.strokeStyle = theme.text;
    context.lineWidth = 1.5;
    context.setLineDash([5, 4]);
    context.beginPath();
    context.moveTo(from.x, from.y);
    context.lineTo(to.x, to.y);
    context.stroke();
    context.setLineDash([]);
    context.beginPath();
    context.arc(to.x, to.y, 5, 0, 2 * Math.PI);
    context.stroke();
  }
}
