// SPDX-License-Identifier: Apache-2.0
// Pointers on the picture: one drags it, a tap points at something, two pull the visitor along.
const tap_pixels = { mouse: 5, pen: 9, touch: 12 }, tap_milliseconds = 600;
const pull_metres = 5;  // way of the visitor when two fingers cross the picture's height

// Returns where a pointer is in the picture, 0 to 1 from its upper left; the canvas cuts off the
// margins that do not fit.
export function place_in_picture(canvas, event) {
  const box = canvas.getBoundingClientRect();
  const scale = Math.max(box.width / canvas.width, box.height / canvas.height);
  const x = (event.clientX - box.left - box.width / 2) / (canvas.width * scale) + 0.5,
      y = (event.clientY - box.top - box.height / 2) / (canvas.height * scale) + 0.5;
  return [x, y].map((v) => Math.round(Math.min(1, Math.max(0, v)) * 1000) / 1000);
}

// handlers: {turn(x, y) pixels dragged, pull(right, forward) metres, tap(place, event)}.
// at(): where the pointer is in the picture, null: nowhere yet.
export function make_pointers(canvas, { turn, pull, tap }) {
  const down = new Map();  // id -> {x, y}
  let pointed = null, began = null;  // began: {x, y, time} of a pointer that may become a tap

  const middle = () => {
    const all = [...down.values()];
    const x = all.reduce((sum, p) => sum + p.x, 0) / all.length,
        y = all.reduce((sum, p) => sum + p.y, 0) / all.length;
    return { x, y, spread: Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y) };
  };

  canvas.addEventListener('pointerdown', (event) => {
    pointed = place_in_picture(canvas, event);
    if (event.button > 0) return;
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    began = down.size === 1
        ? { x: event.clientX, y: event.clientY, time: performance.now() } : null;
    canvas.classList.add('dragging');
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener('pointermove', (event) => {
    pointed = place_in_picture(canvas, event);
    const last = down.get(event.pointerId);
    if (!last) return;
    const { clientX: x, clientY: y } = event;
    if (began) {
      // A small movement is no drag yet, and does not look round either.
      if (Math.hypot(x - began.x, y - began.y) <= (tap_pixels[event.pointerType] ?? 5)) return;
      began = null;
    }
    if (down.size === 2) {
      const before = middle();
      down.set(event.pointerId, { x, y });
      const now = middle(), metres = pull_metres / Math.max(1, canvas.clientHeight);
      pull((before.x - now.x) * metres,
          (now.y - before.y + now.spread - before.spread) * metres);
    } else {
      down.set(event.pointerId, { x, y });
      if (down.size === 1) turn(x - last.x, y - last.y);
    }
  });
  for (const end of ['pointerup', 'pointercancel'])
    canvas.addEventListener(end, (event) => {
      down.delete(event.pointerId);
      if (down.size === 0) canvas.classList.remove('dragging');
      if (began && end === 'pointerup' && performance.now() - began.time < tap_milliseconds)
        tap(place_in_picture(canvas, event), event);
      began = null;
    });
  return { at: () => pointed };
}
