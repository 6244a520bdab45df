// SPDX-License-Identifier: Apache-2.0
// Pointers on the map: a drag pans, two fingers and the wheel enlarge, a touch chooses an object,
// and a drag from an object, or of the circle's rim, draws the circle.
const least_drag = 6;     // pixels; less is a touch
const touch_reach = 24, mouse_reach = 10, rim_reach = { touch: 22, mouse: 10 };
const twice = 400;        // milliseconds between two touches that belong together

// find(at, reach): the object there, or -1. circle(): {at, radius, index} in pixels, or null.
// orders: {choose(index, twice), size(index, pixels, at), pan(dx, dy), zoom(factor, at),
// grow(factor), hover(index), nothing(twice, at)}.
export function make_fingers(canvas, { find, circle, orders }) {
  const down = new Map();  // id -> [x, y] of pointers
  let mode = '', begun = null, held = -1, last_touch = { at: -1e9, index: -2 };

  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return /** @type {[number, number]} */ ([event.clientX - box.left, event.clientY - box.top]);
  };
  const away = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const kind = (event) => (event.pointerType === 'mouse' ? 'mouse' : 'touch');

  function is_on_rim(at, event) {
    const now = circle();
    return now && Math.abs(away(at, now.at) - now.radius) < rim_reach[kind(event)];
  }
  // A finger on a small screen pans from anywhere but the chosen object; a mouse is precise.
  function held_object(at, event) {
    const found = find(at, kind(event) === 'mouse' ? mouse_reach : touch_reach);
    return kind(event) === 'mouse' || found === circle()?.index ? found : -1;
  }

  canvas.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    const at = place(event);
    down.set(event.pointerId, at);
    if (down.size === 2) { mode = 'pinch'; return; }
    if (down.size > 2) return;
    begun = at;
    held = held_object(at, event);
    mode = is_on_rim(at, event) && held !== circle()?.index ? 'rim' : 'touch';
  });

  canvas.addEventListener('pointermove', (event) => {
    const at = place(event), before = down.get(event.pointerId);
    if (!before) {
      const found = find(at, mouse_reach);
      canvas.style.cursor = found >= 0 ? 'pointer' : is_on_rim(at, event) ? 'ew-resize' : '';
      return orders.hover(found);
    }
    down.set(event.pointerId, at);
    if (mode === 'pinch') {
      const other = [...down.entries()].find(([id]) => id !== event.pointerId)?.[1];
      if (!other) return;
      const factor = away(at, other) / Math.max(1, away(before, other));
      orders.pan((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
      orders.zoom(factor, [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2]);
    } else if (mode === 'touch') {
      if (away(at, begun) < least_drag) return;
      mode = held >= 0 ? 'draw' : 'pan';
      if (mode === 'pan') orders.pan(at[0] - begun[0], at[1] - begun[1]);
    } else if (mode === 'pan') orders.pan(at[0] - before[0], at[1] - before[1]);
    if (mode === 'draw') orders.size(held, null, at);
    if (mode === 'rim') orders.size(circle().index, away(at, circle().at), at);
  });

  for (const end of ['pointerup', 'pointercancel'])
    canvas.addEventListener(end, (/** @type {PointerEvent} */ event) => {
      if (!down.delete(event.pointerId)) return;
      if (mode === 'touch' && end === 'pointerup') {
        const found = find(begun, kind(event) === 'mouse' ? mouse_reach : touch_reach);
        const again = event.timeStamp - last_touch.at < twice && found === last_touch.index;
        last_touch = again ? { at: -1e9, index: -2 } : { at: event.timeStamp, index: found };
        if (found >= 0) orders.choose(found, again);
        else orders.nothing(again, begun);
      }
      mode = down.size ? 'pinch' : '';
    });
  canvas.addEventListener('pointerleave', () => orders.hover(-1));
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    const turned = event.deltaY || event.deltaX;  // Shift turns the wheel sideways
    const factor = Math.exp(-Math.max(-100, Math.min(100, turned)) / 400);
    if (event.shiftKey) orders.grow(factor);
    else orders.zoom(factor, place(event));
  }, { passive: false });
}
