// Forces of contacts and supports on strands: an arrow from the place, as long as the
// force is large.
import { format_number } from '../../format.mjs';
import { add, project } from './camera.mjs';

const numbers = 6; // of a contact: place and force
const usual_reach = 0.16; // of the radius of the scene, of an arrow of the usual force
const most_reach = 3; // times that

const size = (force) => Math.hypot(...force);

// The contacts of one frame: {place, force}.
export function contacts_at({ contacts, frames }, moment) {
  const flat = contacts?.[Math.min(Math.floor(moment), frames - 1)] ?? [];
  return Array.from({ length: flat.length / numbers }, (_, i) => ({
    place: flat.slice(numbers * i, numbers * i + 3),
    force: flat.slice(numbers * i + 3, numbers * (i + 1)),
  }));
}

function trace_arrow(context, from, to) {
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const length = Math.hypot(dx, dy);
  if (!(length > 1)) return;
  const head = Math.min(7, 0.45 * length);
  const [ux, uy] = [dx / length, dy / length];
  context.moveTo(from.x, from.y);
  context.lineTo(to.x, to.y);
  for (const side of [-0.5, 0.5]) {
    context.moveTo(to.x, to.y);
    context.lineTo(
      to.x - head * (ux - side * uy),
      to.y - head * (uy + side * ux),
    );
  }
}

// `usual`: the force (N) of an arrow of the usual length; `radius`: of the scene, m.
export function draw_arrows(context, contacts, { view, usual, radius, theme }) {
  context.strokeStyle = context.fillStyle = theme.force;
  context.lineWidth = 1.5;
  context.lineCap = 'round';
  context.beginPath();
  for (const { place, force } of contacts) {
    const reach = Math.min(most_reach, size(force) / usual) * usual_reach * radius;
    const [from, to] = [
      project(view, place),
      project(view, add(place, force, reach / size(force))),
    ];
    if (from.depth > 0 && to.depth > 0) trace_arrow(context, from, to);
  }
  const [x, y] = [84, view.height - 62];
  const length = (usual_reach * radius * view.scale) / view.distance;
  trace_arrow(context, { x, y }, { x: x + length, y });
  context.stroke();
  context.font = '12px system-ui, sans-serif';
  context.textAlign = 'left';
  context.textBaseline = 'middle';
  context.fillText(`${format_number(usual * 1e6)} \u00b5N`, x, y - 14);
}
