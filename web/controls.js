// SPDX-License-Identifier: Apache-2.0
// Keys, pointer, touch and gamepad made into the two numbers the server wants: how fast to move,
// how far to turn.
import { make_pointers } from './pointers.js';

const walk_keys = {
  KeyW: [0, 1], KeyS: [0, -1], KeyA: [-1, 0], KeyD: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
};
const turn_keys = { ArrowLeft: 1, ArrowRight: -1, KeyQ: 1, KeyE: -1 };
const turn_speed = 1.5;  // radians a second

const pointer_interval = 200, least_pointer_step = 0.01;  // milliseconds; of the picture

// send({move, look, pointer, moved}) at most 60 times a second and only on change, where pointer is
// left out if it is nothing new and moved tells whether the rest is; fov() vertical radians of the
// picture; place(n) for the number keys: 1 to 9, 0 for the tenth, and with Shift ten more;
// tap(place in the picture, event) for a click or a tap that is no drag; pad() as of
// make_gamepad().
export function make_controls(canvas, stick, knob,
    { send, fov, speed, place, tap = null, pad = () => null }) {
  const down = new Set();
  let look = [0, 0], last_move = [0, 0, 0], stick_move = [0, 0], last_time = performance.now(),
      turning = 0;

  const busy = (target, kinds = 'input, select, textarea, button, a') =>
    target instanceof Element && target.closest(kinds);
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (/^Digit[0-9]$/.test(event.code) && !event.repeat && !busy(event.target, 'input'))
      place((Number(event.code[5]) + 9) % 10 + (event.shiftKey ? 10 : 0));
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
  let sent_pointed = [-1, -1], sent_at = 0, pulled = [0, 0];
  const pointers = make_pointers(canvas, {
    turn(x, y) {
      const per_pixel = fov() / Math.max(1, canvas.clientHeight);
      look[0] += x * per_pixel;
      look[1] += y * per_pixel;
    },
    pull(right, forward) { pulled[0] += right; pulled[1] += forward; },
    // A turn made before the tap is sent before it: a later turn would end the way that the tap
    // begins.
    tap(at, event) {
      if (look[0] !== 0 || look[1] !== 0) tell(last_move, true);
      tap?.(at, event);
    },
  });
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

  function tell(move, moved, rest = {}) {
    send({ move, look: look.map((v) => Math.round(v * 1e5) / 1e5), moved, ...rest });
    last_move = move;
    look = [0, 0];
  }
  function frame(now) {
    const dt = Math.min(0.1, (now - last_time) / 1000);
    last_time = now;
    let right = stick_move[0], forward = stick_move[1], turn = 0;
    for (const code of down) {
      if (walk_keys[code]) { right += walk_keys[code][0]; forward += walk_keys[code][1]; }
      if (turn_keys[code]) turn += turn_keys[code];
    }
    const stick_pad = pad();
    if (stick_pad) {
      right += stick_pad.right;
      forward += stick_pad.forward;
      look[0] += stick_pad.turn * turn_speed * dt;
      look[1] += stick_pad.tilt * turn_speed * 0.7 * dt;
    }
    if (step !== 0) { forward += step * 2; step *= 0.85; if (Math.abs(step) < 0.05) step = 0; }
    turning += (Math.sign(turn) - turning) * (1 - Math.exp(-dt / 0.07));
    if (Math.abs(turning) < 0.01) turning = 0;
    look[0] += turning * turn_speed * dt;
    const length = Math.hypot(right, forward), pace = speed() * (down.has('Shift') ? 1.8 : 1);
    const scale = length > 1 ? pace / length : pace;
    // Two fingers pull as fast as they go, the rest of it with the next frames.
    const pulls = pulled.map((v) => Math.max(-4, Math.min(4, v / 0.15)));
    pulled = pulled.map((v, i) => (Math.abs(v) < 0.005 ? 0 : v - pulls[i] * dt));
    const move = [right * scale + pulls[0], 0, forward * scale + pulls[1]]
        .map((v) => Math.round(v * 1000) / 1000);
    const moved = move.some((v, i) => v !== last_move[i]);
    const turned = look[0] !== 0 || look[1] !== 0;
    const pointed = pointers.at();
    const points = pointed && now - sent_at >= pointer_interval
        && pointed.some((v, i) => Math.abs(v - sent_pointed[i]) >= least_pointer_step);
    if (moved || turned || points) {
      tell(move, moved || turned, points ? { pointer: pointed } : {});
      if (points) { sent_pointed = pointed; sent_at = now; }
    }
    requestAnimationFrame(frame);
  }
  requestAnimationFrame(frame);
}
