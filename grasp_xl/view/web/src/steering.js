// Mouse, fingers and keys that turn, move and zoom the picture.

const TURN = Math.PI;
const KEY_TURN = Math.PI / 24;
const KEY_PAN = 0.05;
const KEY_ZOOM = 1.15;
const WHEEL_ZOOM = 0.0015;
const LINE = 30;
/** A pinch on a touchpad comes as a slow wheel with Ctrl. */
const PINCH = 6;
/** Pixels that a finger may stray in a tap. */
const TAP = 6;

const middle = (points) => ({
  x: points.reduce((sum, p) => sum + p.x, 0) / points.length,
  y: points.reduce((sum, p) => sum + p.y, 0) / points.length,
});
const spread = ([a, b]) => (b ? Math.hypot(a.x - b.x, a.y - b.y) : 0);

/**
 * Steer an eye by what is done to a canvas.
 * `pane(x, y)` gives { left, top, width, height } of the picture under a point of the canvas;
 * `changed()` follows a move, `tapped(x, y)` a tap, `pointed(x, y)` a hover, without numbers its
 * end.
 */
export function steer(canvas, eye, { pane, changed, tapped, pointed }) {
  const down = new Map();
  let strayed = 0;

  const spot = (event) => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  canvas.addEventListener("pointerdown", (event) => {
    if (down.size === 0) strayed = 0;
    down.set(event.pointerId, spot(event));
    try {
      canvas.setPointerCapture(event.pointerId);
    } catch {
      // a pointer that is gone already
    }
    canvas.focus({ preventScroll: true });
  });

  canvas.addEventListener("pointermove", (event) => {
    const now = spot(event);
    if (!down.has(event.pointerId)) {
      pointed(now.x, now.y);
      return;
    }
    const before = [...down.values()];
    const last = down.get(event.pointerId);
    strayed += Math.hypot(now.x - last.x, now.y - last.y);
    down.set(event.pointerId, now);
    if (strayed <= TAP) return;
    pointed();
    const after = [...down.values()];
    const [from, to] = [middle(before), middle(after)];
    const { height } = pane(to.x, to.y);
    const [dx, dy] = [(to.x - from.x) / height, (to.y - from.y) / height];
    const panning = after.length > 1 || event.shiftKey || event.buttons > 1;
    if (panning) eye.pan(-dx, dy);
    else eye.orbit(-dx * TURN, -dy * TURN);
    if (after.length > 1 && spread(before) > 0) eye.zoom(spread(after) / spread(before));
    changed();
  });

  const lift = (event) => {
    const was = down.get(event.pointerId);
    if (!down.delete(event.pointerId)) return;
    if (event.type === "pointerup" && strayed <= TAP && down.size === 0) tapped(was.x, was.y);
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "mouse") pointed();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const { x, y } = spot(event);
      const { left, top, width, height } = pane(x, y);
      const pixels = event.deltaY * (event.deltaMode ? LINE : 1) * (event.ctrlKey ? PINCH : 1);
      const right = (x - left - width / 2) / height;
      const up = (top + height / 2 - y) / height;
      eye.zoom(Math.exp(-pixels * WHEEL_ZOOM), right, up);
      changed();
    },
    { passive: false },
  );

  const keys = {
    ArrowLeft: (shift) => (shift ? eye.pan(-KEY_PAN, 0) : eye.orbit(-KEY_TURN, 0)),
    ArrowRight: (shift) => (shift ? eye.pan(KEY_PAN, 0) : eye.orbit(KEY_TURN, 0)),
    ArrowUp: (shift) => (shift ? eye.pan(0, KEY_PAN) : eye.orbit(0, -KEY_TURN)),
    ArrowDown: (shift) => (shift ? eye.pan(0, -KEY_PAN) : eye.orbit(0, KEY_TURN)),
    "+": () => eye.zoom(KEY_ZOOM),
    "=": () => eye.zoom(KEY_ZOOM),
    "-": () => eye.zoom(1 / KEY_ZOOM),
  };
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key](event.shiftKey);
    changed();
  });
}
