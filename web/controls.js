// SPDX-License-Identifier: Apache-2.0
// Keys, pointer and touch made into the two numbers the server wants: how fast to move, how far to
// turn.
const walk_keys = {
  KeyW: [0, 1], KeyS: [0, -1], KeyA: [-1, 0], KeyD: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
};
const turn_keys = { ArrowLeft: 1, ArrowRight: -1, KeyQ: 1, KeyE: -1 };
const turn_speed = 1.5;  // radians a second

const pointer_interval = 200, least_pointer_step = 0.01;  // milliseconds; of the picture

// Where a pointer is in the picture, 0 to 1 from its upper left; the canvas cuts what does not fit.
function place_in_picture(canvas, event) {
  const box = canvas.getBoundingClientRect();
  const scale = Math.max(box.width / canvas.width, box.height / canvas.height);
  const x = (event.clientX - box.left - box.width / 2) / (canvas.width * scale) + 0.5,
      y = (event.clientY - box.top - box.height / 2) / (canvas.height * scale) + 0.5;
  return [x, y].map((v) => Math.round(Math.min(1, Math.max(0, v)) * 1000) / 1000);
}

// send({move, look, pointer, moved}) at most 60 times a second and only on change, where pointer is
// left out if it is nothing new and moved tells whether the rest is; fov() vertical radians of the
// picture; place(n) for the number keys.
export function make_controls(canvas, stick, knob, { send, fov, speed, place }) {
  const down = new Set();
  let look = [0, 0], last_move = [0, 0, 0], stick_move = [0, 0], last_time = performance.now(),
      turning = 0;

  const busy = (target) => target instanceof Element
      && target.closest('input, select, textarea, button, a');
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (/^Digit[1-9]$/.test(event.code) && !event.repeat) place(Number(event.code[5]) - 1);
    if (!(event.code in walk_keys) && !(event.code in turn_keys)) return;
    if (busy(event.target) && event.code.startsWith('Arrow')) return;
    event.preventDefault();
    down.add(event.code);
    if (event.shiftKey) down.add('Shift');
  });
  addEventListener('keyup', (event) => {
    down.delete(event.code);
    if (event.key === 'Shift') down.delete('Shift');
  });
  addEventListener('blur', () => { down.clear(); stick_move = [0, 0]; });

  // Dragging takes hold of the picture: what is under the pointer stays under it.
  const pointers = new Map();
  let pointed = null, sent_pointed = [-1, -1], sent_at = 0;
  for (const kind of ['pointerdown', 'pointermove'])
    canvas.addEventListener(kind, (event) => { pointed = place_in_picture(canvas, event); });
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    canvas.classList.add('dragging');
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const per_pixel = fov() / Math.max(1, canvas.clientHeight);
    look[0] += (event.clientX - before[0]) * per_pixel;
    look[1] += (event.clientY - before[1]) * per_pixel;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const end of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(end, (event) => {
      pointers.delete(event.pointerId);
      if (pointers.size === 0) canvas.classList.remove('dragging');
    });
  }
  // The wheel takes a step.
  let step = 0;
  canvas.addEventListener('wheel',
      (event) => { step = -Math.sign(event.deltaY); event.preventDefault(); }, { passive: false });

  // The stick on touch screens.
  const pull = (event) => {
    const box = stick.getBoundingClientRect(), radius = box.width / 2;
    let x = (event.clientX - box.left - radius) / radius,
        y = (event.clientY - box.top - radius) / radius;
    const length = Math.hypot(x, y);
    if (length > 1) { x /= length; y /= length; }
    knob.style.transform = `translate(${x * radius * 0.6}px, ${y * radius * 0.6}px)`;
    stick_move = length < 0.15 ? [0, 0] : [x, -y];
  };
  stick.addEventListener('pointerdown',
      (event) => { stick.setPointerCapture(event.pointerId); pull(event); });
  stick.addEventListener('pointermove',
      (event) => { if (stick.hasPointerCapture(event.pointerId)) pull(event); });
  for (const end of ['pointerup', 'pointercancel'])
    stick.addEventListener(end, () => { stick_move = [0, 0]; knob.style.transform = ''; });

  function frame(now) {
    const dt = Math.min(0.1, (now - last_time) / 1000);
    last_time = now;
    let right = stick_move[0], forward = stick_move[1], turn = 0;
    for (const code of down) {
      if (walk_keys[code]) { right += walk_keys[code][0]; forward += walk_keys[code][1]; }
      if (turn_keys[code]) turn += turn_keys[code];
    }
    if (step !== 0) { forward += step * 2; step *= 0.85; if (Math.abs(step) < 0.05) step = 0; }
    turning += (Math.sign(turn) - turning) * (1 - Math.exp(-dt / 0.07));
    if (Math.abs(turning) < 0.01) turning = 0;
    look[0] += turning * turn_speed * dt;
    const length = Math.hypot(right, forward), pace = speed() * (down.has('Shift') ? 1.8 : 1);
    const scale = length > 1 ? pace / length : pace;
    const move = [right * scale, 0, forward * scale].map((v) => Math.round(v * 1000) / 1000);
    const moved = move.some((v, i) => v !== last_move[i]);
    const turned = look[0] !== 0 || look[1] !== 0;
    const points = pointed && now - sent_at >= pointer_interval
        && pointed.some((v, i) => Math.abs(v - sent_pointed[i]) >= least_pointer_step);
    if (moved || turned || points) {
      send({
        move, look: look.map((v) => Math.round(v * 1e5) / 1e5), moved: moved || turned,
        ...(points && { pointer: pointed }),
      });
      if (points) { sent_pointed = pointed; sent_at = now; }
      last_move = move;
      look = [0, 0];
    }
    requestAnimationFrame(frame);
  }
  requestAnimationFrame(frame);
}
