// Mouse, touch and keyboard of the player.

// Whether an element uses the key itself.
export function is_own_key(element, key) {
  if (element.matches('button:not([role="tab"])')) return key === ' ';
  if (element.matches('input')) return key !== ' ';
  return element.matches('select, [role="tab"], summary, a');
}

function keys(player, event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const { target, key } = event;
  const step = event.shiftKey ? 10 : 1;
  const actions = {
    ' ': () => player.play(!player.playing),
    ArrowRight: () => player.go_to(Math.floor(player.moment) + step),
    ArrowLeft: () => player.go_to(Math.floor(player.moment) - step),
    Home: () => player.go_to(0),
    End: () => player.go_to(player.scene.frames - 1),
    Escape: () => player.fill(''),
  };
  if (actions[key] === undefined || is_own_key(target, key)) return;
  event.preventDefault();
  actions[key]();
}

// The camera of `player.picture`; player.changed() is called when it has moved.
export function steer_camera(player, canvas) {
  const fingers = new Map(); // pointer id -> {x, y}

  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  const lift = (event) => fingers.delete(event.pointerId);
  canvas.addEventListener('pointerup', lift);
  canvas.addEventListener('pointercancel', lift);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());

  canvas.addEventListener('pointermove', (event) => {
    const before = fingers.get(event.pointerId);
    if (before === undefined) return;
    const { camera } = player.picture;
    const now = { x: event.clientX, y: event.clientY };
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    if (fingers.size === 2) {
      const [other] = [...fingers].filter(([id]) => id !== event.pointerId);
      const apart = (p) => Math.hypot(p.x - other[1].x, p.y - other[1].y);
      camera.magnify(apart(now) / Math.max(1, apart(before)));
      camera.move(dx / 2, dy / 2, player.picture.view());
    } else if (event.shiftKey || event.buttons & 2) {
      camera.move(dx, dy, player.picture.view());
    } else {
      camera.turn(dx, dy);
    }
    fingers.set(event.pointerId, now);
    player.changed();
  });

  canvas.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      player.picture.camera.magnify(Math.exp(-0.0015 * event.deltaY));
      player.changed();
    },
    { passive: false },
  );
}

export function steer(player, canvas) {
  steer_camera(player, canvas);
  document.addEventListener('keydown', (event) => {
    if (player.shown) keys(player, event);
  });
}
